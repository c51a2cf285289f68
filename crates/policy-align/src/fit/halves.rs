//! Split-half agreement: do halves of the movements, or of a single one, give the same policy?

use std::borrow::Cow;

use gp::{AutoFit, CurlTest, DirectGp, GpError, Grouping, ModelKind, PushTest, Rows, SlopeGp};
use motion::{Policy, SampleIndex, spread};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::actions::states;

/// How halves are chosen and learnt.
#[derive(Debug, Clone, Copy)]
pub(super) struct Halves<'a> {
    /// The largest number of rows of the whole fit.
    pub(super) max_rows: usize,
    /// The random seed.
    pub(super) seed: u64,
    /// For each movement, the recording that it is a part of; later movements are whole recordings.
    pub(super) recordings: &'a [usize],
}

impl Halves<'_> {
    /// Whether a movement is in the second half: parts of a recording, which one constraint may have guided, are in the same.
    fn is_second(self, trajectory: usize) -> bool {
        self.recordings.get(trajectory).copied().unwrap_or(trajectory) % 2 == 1
    }
}

/// Σ‖π̂_even − π̂_odd‖² over Σ‖π̂ − mean π̂‖² at the rows' states. The two slope policies are learnt from every other recording and from
/// the rest, or from both halves of a single movement. `None` if the halves have too few data.
///
/// With many movements the expected error is at most a quarter of this, if each half has twice the error of the whole and the two errors
/// are independent. With one or two movements, the expected error is all of it. Errors that both halves share go undetected.
pub(super) fn of_slope(readings: &AutoFit, rows: &Rows, by: Halves<'_>) -> Option<f64> {
    let report = readings.slope().report();
    let curl_test = if report.model == ModelKind::Potential { CurlTest::AssumePotential } else { CurlTest::Fit };
    let gp = SlopeGp {
        families: vec![report.family],
        max_rows: by.max_rows / 2,
        hyper_rows: by.max_rows / 4,
        curl_test,
        push_test: if report.push.is_some() || report.task_space.is_some() {
            PushTest::Fit
        } else {
            PushTest::AssumeNone
        },
        ..SlopeGp::default()
    };
    let learn = |rows: &Rows| gp.fit(rows, &mut ChaCha8Rng::seed_from_u64(by.seed));
    // Stretches are found on samples; everything else uses their means.
    let with_spaces = |spaces| rows.clone().with_task_spaces(spaces).map(Cow::Owned);
    let learnt_from = match report.task_space {
        Some(space) => with_spaces(vec![rows.task_spaces()[space].clone()]).ok()?,
        None if report.push.is_none() => return of_means((readings, readings.slope()), rows, by, &learn),
        None if rows.task_spaces().is_empty() => Cow::Borrowed(rows),
        None => with_spaces(Vec::new()).ok()?,
    };
    let halves = halves(readings, &learnt_from, by);
    drop(learnt_from);
    disagreement(readings.slope(), rows, &halves, &learn)
}

/// As [`of_slope`], for direct policies; from free rows if the whole fit is.
pub(super) fn of_direct(readings: &AutoFit, rows: &Rows, by: Halves<'_>) -> Option<f64> {
    let gp = DirectGp {
        families: vec![readings.direct_of_free_rows().family()],
        max_rows: by.max_rows / 2,
        hyper_rows: by.max_rows / 4,
        ..DirectGp::default()
    };
    let learn = |rows: &Rows| gp.fit(&readings.free_rows(rows), &mut ChaCha8Rng::seed_from_u64(by.seed));
    of_means((readings, readings.direct_of_free_rows()), rows, by, &learn)
}

/// Number of samples of the movement if there is only one.
fn only_movement(readings: &AutoFit, rows: &Rows) -> Option<usize> {
    let (first, last) = (rows.indices().first()?, rows.indices().last()?);
    let alone = readings.numbers().grouping == Grouping::BlocksOfTime && first.trajectory == last.trajectory;
    alone.then_some(last.sample + 1)
}

/// Disagreement of policies that are learnt from means.
fn of_means<P: Policy + Send>(
    (readings, whole): (&AutoFit, &dyn Policy),
    rows: &Rows,
    by: Halves<'_>,
    learn: &(dyn Fn(&Rows) -> Result<P, GpError> + Sync),
) -> Option<f64> {
    let trajectory = |index: Option<&SampleIndex>| index.map(|index| index.trajectory);
    let halves = if trajectory(rows.indices().first()) == trajectory(rows.indices().last()) {
        halves(readings, &rows.averaged(), by)
    } else {
        // Each mean is of one movement. All means at once would take as much memory again as the rows.
        [false, true].map(|odd| rows.without(|trajectory, _| by.is_second(trajectory) != odd).averaged().into_owned())
    };
    disagreement(whole, rows, &halves, learn)
}

/// Every other recording and the rest, or both halves of a single movement.
fn halves(readings: &AutoFit, rows: &Rows, by: Halves<'_>) -> [Rows; 2] {
    let middle = only_movement(readings, rows).map(|samples| samples / 2);
    let is_odd =
        |trajectory: usize, sample: usize| middle.map_or_else(|| by.is_second(trajectory), |middle| sample >= middle);
    [false, true].map(|odd| rows.without(|trajectory, sample| is_odd(trajectory, sample) != odd))
}

fn disagreement<P: Policy + Send>(
    whole: &dyn Policy,
    rows: &Rows,
    [even, odd]: &[Rows; 2],
    learn: &(dyn Fn(&Rows) -> Result<P, GpError> + Sync),
) -> Option<f64> {
    let (even, odd) = rayon::join(|| learn(even), || learn(odd));
    let states = states(rows);
    let apart = (even.ok()?.actions(states.as_view()) - odd.ok()?.actions(states.as_view())).norm_squared();
    let disagreement = apart / spread(&whole.actions(states.as_view()));
    disagreement.is_finite().then_some(disagreement)
}
