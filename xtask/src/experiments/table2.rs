//! Table 2 (Section 4.2): grasping a ball through a wall with a gap, and how policies carry over to other constraints.

use std::collections::BTreeMap;

use align::{DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::Grasp;
use gp::FrontEnd;
use lwpr::{LwprParams, MetricAdaptation};
use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use super::beside::{Beside, DATA_SETS};
use super::contest::{Contest, Contestant};
use super::exam::examine;
use super::gaussians::Gaussians;
use super::pupil::Pupil;
use super::{Experiment, Measures, Row, Setup, Trial};
use crate::measure::Measure;
use crate::paper::{explanations, paper_table};
use crate::robots::upper_body;

/// The system that data sets are drawn for.
pub(crate) const GRASP_SYSTEM: u32 = 420;

/// Typical spread of a palm's coordinates, metres: the divisor of all inputs of the regressions.
const SPREAD: f64 = 0.3;

/// The experiment.
pub(crate) fn table2() -> anyhow::Result<Experiment> {
    let rows = CASES.into_iter().chain(["alignment"]).map(Row::of_learner).collect();
    let beside = grasp_beside();
    let contest = |(case, [measure, _]): (&str, [Measure; 2])| Contest {
        case: case.to_owned(),
        ..Contest::of(CASE, measure, &beside.contestants())
            .with(Contestant::PolicyAlign, case, Measure::PolicyAlign)
            .with(Contestant::Naive, case, Measure::Naive)
    };
    // In the order of [`MEASURES`].
    let pupils = vec![Pupil::PolicyAlign(grasp_regressor()), Pupil::other(grasp_naive())?];
    let trial = GraspTrial { grasp: grasp()?, algorithm: PolicyAlign::default(), pupils };
    Ok(Experiment {
        id: "table2",
        section: "4.2",
        title: "Table 2: grasping a ball",
        data_sets: 50,
        remark: "Fitted, because the paper does not give them: the robot's posture, ball (x = .7), wall (x = .35, felt from .09 m before it), \
                 half-width of the unseen obstacle (.13), no gap narrower than .17 m, regressions. δt = .5 s, plain Euler, narrow \
                 bandwidth. Fixed diagonal metrics, inputs divided by .3 m: PolicyAlign D = 22, 10 passes; naive D = 10, 4 passes. The printed errors of \
                 the naive learner are held against its errors on held-out samples of all movements.",
        decisions: "table2.md",
        another_reading_of: None,
        contests: CASES.into_iter().zip(ERRORS).map(contest).collect(),
        setups: vec![
            Setup {
                id: "grasp".to_owned(),
                rows,
                system: GRASP_SYSTEM,
                data_sets: None,
                cost: 2_000_000,
                trial: Box::new(trial),
            },
            Setup {
                id: "beside".to_owned(),
                rows: beside.rows(CASE),
                system: GRASP_SYSTEM,
                data_sets: Some(DATA_SETS),
                cost: beside.cost(),
                trial: Box::new(GraspBeside { grasp: grasp()?, algorithm: PolicyAlign::default(), beside }),
            },
        ],
        paper: paper_table(include_str!("../../paper/table2.toml"))?,
        explanations: explanations(include_str!("../../paper/table2-explained.toml"))?,
    })
}

/// The rows of the printed table.
const CASES: [&str; 3] = ["training", "unseen_barrier", "unconstrained"];

/// What rows of other learners are named after.
const CASE: &str = "grasp";

/// Who learns beside PolicyAlign and the naive learner.
pub(crate) fn grasp_beside() -> Beside {
    Beside { naive: None, constraint_consistent: None, gaussians: Gaussians::new(FrontEnd::Map, 1000) }
}

/// What is demonstrated.
pub(crate) fn grasp() -> anyhow::Result<Grasp> {
    Ok(Grasp::new(upper_body()?))
}

/// The regression on aligned potentials.
pub(crate) fn grasp_regressor() -> LwprRegressor {
    LwprRegressor { params: params(22.0), passes: 10, ..LwprRegressor::default() }
}

/// The naive learner.
pub(crate) fn grasp_naive() -> DirectPolicyLearning {
    DirectPolicyLearning { params: params(10.0), passes: 4, ..DirectPolicyLearning::default() }
}

fn params(init_d: f64) -> LwprParams {
    let norm_in = Some(DVector::repeat(6, SPREAD));
    LwprParams { init_d, norm_in, adaptation: MetricAdaptation::Fixed, ..LwprParams::default() }
}

/// Where the table has each learner's errors: on samples of kept movements, and of all.
const MEASURES: [[Measure; 2]; 2] =
    [[Measure::PolicyAlign, Measure::PolicyAlignAll], [Measure::Naive, Measure::NaiveAll]];

/// The errors of the rows, in the same two ways.
const ERRORS: [[Measure; 2]; 3] = [
    [Measure::Ncpe, Measure::NcpeAll],
    [Measure::NcpeUnseen, Measure::NcpeUnseenAll],
    [Measure::Nupe, Measure::NupeAll],
];

/// The learners beside.
#[derive(Serialize)]
struct GraspBeside {
    grasp: Grasp,
    algorithm: PolicyAlign,
    beside: Beside,
}

impl Trial for GraspBeside {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.grasp.record(rng)?;
        let obstacle = self.grasp.scene.central_obstacle()?;
        let sat = self.beside.sit(&recordings, std::slice::from_ref(&self.algorithm), rng)?;
        let mut rows = sat.rows()?;
        for (row, learnt) in rows.iter_mut().zip(sat.learnt()) {
            row.insert(Measure::NcpeUnseen, sat.judges(0)[0].policy_under(&learnt, &obstacle)?);
        }
        Ok(rows)
    }
}

/// All rows: they are measured on the same data sets.
#[derive(Serialize)]
struct GraspTrial {
    grasp: Grasp,
    algorithm: PolicyAlign,
    pupils: Vec<Pupil>,
}

impl Trial for GraspTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.grasp.record(rng)?;
        let obstacle = self.grasp.scene.central_obstacle()?;
        let exam = examine(&recordings, &self.algorithm, &self.pupils, rng)?;
        let mut of_learners = exam.rows()?;
        for (errors, learnt) in of_learners.iter_mut().zip(exam.learnt()) {
            errors.extend(
                [Measure::NcpeUnseen, Measure::NcpeUnseenAll].into_iter().zip(exam.unseen(&learnt, &obstacle)?),
            );
        }
        // A row of the table is one kind of error, of all learners.
        let row = |errors: [Measure; 2]| {
            let of_learner = |(measures, found): ([Measure; 2], &BTreeMap<Measure, f64>)| {
                measures.into_iter().zip(errors.map(|error| found[&error]))
            };
            MEASURES.into_iter().zip(&of_learners).flat_map(of_learner).collect()
        };
        let mut rows: Measures = ERRORS.map(row).into();
        let alignment = [Measure::AlignmentNmse, Measure::PotentialNmse, Measure::Disc, Measure::Unsupported];
        rows.push(BTreeMap::from(alignment.map(|measure| (measure, of_learners[0][&measure]))));
        Ok(rows)
    }
}
