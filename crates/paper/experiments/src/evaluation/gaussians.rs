//! The Gaussian processes of an experiment: training, errors, and their own estimates.

use std::collections::BTreeMap;

use gp::{AutoFit, AutoGp, FrontEnd, Hypothesis, ModelKind, PushTest, SlopeFit, SlopeGp, Trend};
use motion::{Demonstrations, LearntPolicy, SampleIndex};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::judge::Judge;
use crate::evaluation::protocol::errors;
use crate::measure::Measure;

/// The slope GP and the direct GP with their defaults, from at most `max_rows` rows.
#[derive(Serialize)]
pub struct Gaussians {
    /// The recorded quantities.
    pub(crate) front_end: FrontEnd,
    /// Number of rows for learning.
    pub(crate) max_rows: usize,
    /// Number of rows for the choice of amplitudes.
    pub(crate) hyper_rows: usize,
    /// Whether constraints may push.
    #[serde(skip_serializing_if = "is_none")]
    pub(crate) push_test: PushTest,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // serde requires a reference
fn is_none(push_test: &PushTest) -> bool {
    *push_test == PushTest::AssumeNone
}

/// Number of rows for the choice of amplitudes in experiments. The evidence of more rows takes most of the time of a fit and
/// changes little.
const HYPER_ROWS: usize = 250;

impl Gaussians {
    pub(crate) fn new(front_end: FrontEnd, max_rows: usize) -> Self {
        Gaussians { front_end, max_rows, hyper_rows: HYPER_ROWS.min(max_rows), push_test: PushTest::AssumeNone }
    }

    /// Work of fits to `max_rows` rows, in the unit of [`Setup::cost`](crate::Setup::cost).
    pub(crate) fn cost(max_rows: usize) -> u64 {
        // Measured on the paper's data sets: 1000 rows take about a second. The data sets of `beyond` take two to four times
        // as long.
        55 * (max_rows as u64).pow(2)
    }

    /// Fits both and selects the one that the data support. The fits are the same as those of each alone.
    ///
    /// # Errors
    /// If the demonstrations do not suffice for learning.
    pub fn both(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut ChaCha8Rng,
    ) -> anyhow::Result<AutoFit> {
        let learner = AutoGp { slope: self.slope_gp(Trend::Quadratic), ..AutoGp::default() };
        Ok(learner.fit(&self.front_end.rows_without(demonstrations, held_out)?, rng)?)
    }

    /// Fits the slope GP alone. Without a trend its families contain no quadratic potential, which shows the error if the
    /// class does not contain the truth.
    pub(crate) fn slope(
        &self,
        trend: Trend,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut ChaCha8Rng,
    ) -> anyhow::Result<SlopeFit> {
        Ok(self.slope_gp(trend).fit(&self.front_end.rows_without(demonstrations, held_out)?, rng)?)
    }

    fn slope_gp(&self, trend: Trend) -> SlopeGp {
        let &Gaussians { max_rows, hyper_rows, push_test, .. } = self;
        SlopeGp { trend, max_rows, hyper_rows, push_test, ..SlopeGp::default() }
    }
}

/// Rows of the slope GP, the direct GP and the choice between them: errors and their own estimates.
pub(crate) fn rows(judge: &Judge<'_>, both: &AutoFit) -> anyhow::Result<[BTreeMap<Measure, f64>; 3]> {
    let [slope, direct, either]: [&dyn LearntPolicy; 3] = [both.slope(), both.direct(), both];
    let [mut slope, mut direct, mut either] = [errors(judge, slope)?, errors(judge, direct)?, errors(judge, either)?];
    slope.extend(own_expectations(both.slope()));
    direct.insert(Measure::ExpectedNupe, 1.0 - both.direct().r_squared());
    either.insert(Measure::ExpectedNupe, both.expected_nupe());
    either.extend(reading_of(both));
    Ok([slope, direct, either])
}

/// The slope GP's estimates of its error and model.
pub(crate) fn own_expectations(fit: &SlopeFit) -> BTreeMap<Measure, f64> {
    let report = fit.report();
    BTreeMap::from([
        (Measure::ExpectedNupe, report.expected_nupe),
        (Measure::Rotation, percent(report.model == ModelKind::Helmholtz)),
    ])
}

/// The reading of the data.
pub(crate) fn reading_of(both: &AutoFit) -> BTreeMap<Measure, f64> {
    let readings = [
        (Measure::ReadFree, Hypothesis::Free),
        (Measure::ReadConstrained, Hypothesis::Constrained),
        (Measure::ReadAmbiguous, Hypothesis::Ambiguous),
        (Measure::ReadUnexplained, Hypothesis::Unexplained),
    ];
    readings.into_iter().map(|(measure, reading)| (measure, percent(both.reading() == reading))).collect()
}

/// 100 or 0 for one data set, so that means are shares of the data sets.
fn percent(is_so: bool) -> f64 {
    if is_so { 100.0 } else { 0.0 }
}
