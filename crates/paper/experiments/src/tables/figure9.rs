//! Fig. 9 (d), (e) (Section 4.4): how the errors on the three-link arm grow along and away from the line where its
//! movements end.

use std::collections::BTreeMap;

use align::PolicyAlign;
use demo_gen::ThreeLinkArm;
use nalgebra::{DVectorView, Vector3};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::baselines::Baselines;
use crate::evaluation::judge::Judge;
use crate::evaluation::protocol::{Protocol, errors};
use crate::evaluation::recipe::Recipe;
use crate::measure::{Measure, RowOf};
use crate::tables::three_link::{ARM_SYSTEM, arm, baselines, protocol};
use crate::{Experiment, Measures, Row, Setup, Trial};

/// Bounds on the distance, in tenths of a radian.
pub const TENTHS: std::ops::RangeInclusive<u32> = 1..=10;

/// Fewer test samples give no value, because the variance in the denominator of the error would be due to chance.
const FEWEST_SAMPLES: usize = 10;

/// Description of the test samples.
const TESTED_ON: &str = "held-out samples of the movements that alignment keeps, of these the ones in the distance";

/// The experiment.
pub(crate) fn figure9() -> anyhow::Result<Experiment> {
    let rows = cases().into_iter().map(|id| Row { id, of: RowOf::Learner, tested_on: TESTED_ON }).collect();
    let trial = DistanceTrial { arm: arm()?, protocol: protocol(&Recipe::default()) };
    let (baselines, cases) = (baselines(ROWS), cases());
    let comparisons = cases.iter().map(|case| baselines.comparison(case, Measure::Nupe)).collect();
    let (arm, algorithm) = (arm()?, PolicyAlign::default());
    let of_baselines = |baselines| DistanceBaselines { arm, algorithm, baselines };
    let mut of_baselines = baselines.setup(("beside", ARM_SYSTEM), &cases, of_baselines);
    of_baselines.rows.iter_mut().for_each(|row| row.tested_on = TESTED_ON);
    Ok(Experiment {
        id: "figure9",
        section: "4.4",
        title: "Figure 9: error along and around the line where movements end",
        data_sets: 50,
        remark: "Data sets, learner and test samples of the three-link arm; of the samples only those nearer than c radians to the posture \
                 along the line (rows d-c), or nearer than c to the line (rows r-c). The variances in (A1)–(A3) are of \
                 these samples too. A data set with fewer than 10 of them has no value there.",
        decisions: "figure9.md",
        comparisons,
        setups: vec![Setup::new("distances", ARM_SYSTEM, 2_600_000, rows, trial), of_baselines],
        ..Experiment::default()
    })
}

/// Number of rows from which the Gaussian processes learn. The arm's table, which uses all rows, shows the same errors.
const ROWS: usize = 500;

/// The cases, in the order of the rows.
fn cases() -> Vec<String> {
    bounds().map(|(distance, tenths)| distance.row(tenths)).collect()
}

/// The two components of the distance between a posture and the target of the policy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distance {
    /// d = |q·l|.
    Along,
    /// r = ‖q − (q·l) l‖.
    Around,
}

impl Distance {
    /// Both, in the order of the rows.
    pub const BOTH: [Distance; 2] = [Distance::Along, Distance::Around];

    /// Its letter in the paper.
    pub(crate) fn letter(self) -> &'static str {
        match self {
            Distance::Along => "d",
            Distance::Around => "r",
        }
    }

    /// The id of the row for samples within this many tenths.
    pub fn row(self, tenths: u32) -> String {
        format!("{}-{}.{}", self.letter(), tenths / 10, tenths % 10)
    }

    /// The distance of a posture, in radians.
    pub(crate) fn of(self, posture: DVectorView<'_, f64>) -> f64 {
        let along = posture.fixed_rows::<3>(0).dot(&line());
        match self {
            Distance::Along => along.abs(),
            Distance::Around => (posture.fixed_rows::<3>(0) - along * line()).norm(),
        }
    }
}

/// The direction l of the line through 0 where movements end. At the stretched posture the hand is 3, 2 and 1 links away
/// from the joints, so that every active constraint there blocks q₁, q₂, q₃ along (3, 2, 1).
pub fn line() -> Vector3<f64> {
    Vector3::new(3.0, 2.0, 1.0).normalize()
}

#[derive(Serialize)]
struct DistanceTrial {
    arm: ThreeLinkArm,
    protocol: Protocol,
}

impl Trial for DistanceTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.arm.record(rng)?;
        let evaluation = self.protocol.evaluate(&recordings, rng)?;
        let judges: Vec<_> = bounds().map(|bound| within(evaluation.judge(), bound)).collect();
        let row = |learnt, judge: &Option<Judge<'_>>| match judge {
            Some(judge) => evaluation.errors(judge, learnt),
            None => Ok(BTreeMap::new()),
        };
        let rows = evaluation.learnt().flat_map(|learnt| judges.iter().map(move |judge| row(learnt, judge)));
        rows.collect()
    }
}

/// The same for the baselines.
#[derive(Serialize)]
struct DistanceBaselines {
    arm: ThreeLinkArm,
    algorithm: PolicyAlign,
    #[serde(rename = "beside")]
    baselines: Baselines,
}

impl Trial for DistanceBaselines {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.arm.record(rng)?;
        let trained = self.baselines.train(&recordings, std::slice::from_ref(&self.algorithm), rng)?;
        let mut rows = Vec::new();
        for bound in bounds() {
            let judge = within(&trained.judges(0)[0], bound);
            for learnt in trained.learnt() {
                rows.push(judge.as_ref().map_or(Ok(BTreeMap::new()), |judge| errors(judge, learnt))?);
            }
        }
        Ok(rows)
    }
}

/// Distances and their bounds in tenths, in the order of the rows.
fn bounds() -> impl Iterator<Item = (Distance, u32)> {
    Distance::BOTH.into_iter().flat_map(|distance| TENTHS.map(move |tenths| (distance, tenths)))
}

/// The test at the samples within a bound; `None` if there are too few.
fn within<'a>(judge: &Judge<'a>, (distance, tenths): (Distance, u32)) -> Option<Judge<'a>> {
    let judge = judge.among(|state| distance.of(state) < f64::from(tenths) / 10.0);
    (judge.n_samples() >= FEWEST_SAMPLES).then_some(judge)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::dvector;

    #[test]
    fn distances_are_the_two_parts_of_a_posture() {
        let posture = dvector![0.7, -0.2, 0.4];
        let [along, around] = Distance::BOTH.map(|distance| distance.of(posture.as_view()));
        assert!((along.hypot(around) - posture.norm()).abs() < 1e-15);
        assert!((along - 2.1 / 14.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn movements_end_on_the_line_and_not_at_its_middle() {
        let arm = ThreeLinkArm { n_trajectories: 40, ..arm().unwrap() };
        let recordings = arm.record(&mut crate::seed::generator(1, ARM_SYSTEM, 0)).unwrap();
        let median = |distance: Distance, sample: usize| {
            let distance_of = |recording: &demo_gen::Recording| distance.of(recording.truth.states.column(sample));
            let mut distances: Vec<f64> = recordings.iter().map(distance_of).collect();
            distances.sort_by(f64::total_cmp);
            distances[20]
        };
        let [start, end] = [0, 99].map(|sample| Distance::BOTH.map(|distance| median(distance, sample)));
        assert!(start.iter().all(|&distance| distance > 0.4), "{start:?}");
        assert!(end[0] > 0.3 && end[1] < 0.05, "{end:?}");
    }
}
