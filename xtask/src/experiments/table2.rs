//! Table 2 (Section 4.2): grasping a ball through a wall with a gap, and how policies carry over to other constraints.

use std::collections::BTreeMap;

use align::{DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::Grasp;
use lwpr::{LwprParams, MetricAdaptation};
use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;

use super::exam::examine;
use super::{Experiment, Measures, Row, Setup, Trial};
use crate::learners::Learner;
use crate::measure::{Measure, RowOf};
use crate::paper::{explanations, paper_table};
use crate::robots::upper_body;

/// The system that data sets are drawn for.
pub(crate) const GRASP_SYSTEM: u32 = 420;

/// Typical spread of a palm's coordinates, metres: the divisor of all inputs of the regressions.
const SPREAD: f64 = 0.3;

/// The experiment.
pub(crate) fn table2() -> anyhow::Result<Experiment> {
    let row = |id: &str| Row { id: id.to_owned(), of: RowOf::Learner };
    let rows = ["training", "unseen_barrier", "unconstrained", "alignment"].map(row).into();
    // In the order of [`MEASURES`].
    let learners: Vec<Box<dyn Learner>> = vec![Box::new(grasp_regressor()), Box::new(grasp_naive())];
    let trial = GraspTrial { grasp: grasp()?, algorithm: PolicyAlign::default(), learners };
    Ok(Experiment {
        id: "table2",
        section: "4.2",
        title: "Table 2: grasping a ball",
        data_sets: 50,
        remark: "Fitted, because the paper does not give them: the robot's posture, ball (x = .7), wall (x = .35, felt from .09 m before it), \
                 half-width of the unseen obstacle (.13), no gap narrower than .17 m, regressions. δt = .5 s, plain Euler, narrow \
                 bandwidth. Fixed diagonal metrics, inputs divided by .3 m: PolicyAlign D = 22, 10 passes; naive D = 10, 4 passes.",
        decisions: "table2.md",
        another_reading_of: None,
        setups: vec![Setup {
            id: "grasp".to_owned(),
            rows,
            system: GRASP_SYSTEM,
            cost: 2_000_000,
            trial: Box::new(trial),
        }],
        paper: paper_table(include_str!("../../paper/table2.toml"))?,
        explanations: explanations(include_str!("../../paper/table2-explained.toml"))?,
    })
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

/// Where the table has each learner's errors.
const MEASURES: [Measure; 2] = [Measure::PolicyAlign, Measure::Naive];

/// All rows: they are measured on the same data sets.
#[derive(Debug)]
struct GraspTrial {
    grasp: Grasp,
    algorithm: PolicyAlign,
    learners: Vec<Box<dyn Learner>>,
}

impl Trial for GraspTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.grasp.record(rng)?;
        let obstacle = self.grasp.scene.central_obstacle()?;
        let exam = examine(&recordings, &self.algorithm, &self.learners, Some(&obstacle), rng)?;
        // A row of the table is one kind of error, of all learners.
        let row = |error| MEASURES.into_iter().zip(&exam).map(|(learner, errors)| (learner, errors[&error])).collect();
        let mut rows: Measures = [Measure::Ncpe, Measure::NcpeUnseen, Measure::Nupe].map(row).into();
        let alignment = [Measure::AlignmentNmse, Measure::PotentialNmse, Measure::Disc, Measure::Unsupported];
        rows.push(BTreeMap::from(alignment.map(|measure| (measure, exam[0][&measure]))));
        Ok(rows)
    }
}
