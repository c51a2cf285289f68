//! Section 4.4: a planar arm under constraints that always hide the same direction.

use align::{DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::{ThreeLinkArm, n_leaving_limits};
use gp::FrontEnd;
use lwpr::{LwprParams, MetricAdaptation};
use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use super::beside::{Beside, BesideTrial, DATA_SETS};
use super::contest::{Contest, Contestant};
use super::exam::{TESTED_ON, examine};
use super::gaussians::Gaussians;
use super::pupil::Pupil;
use super::settings::{SILENT, Setting};
use super::{Experiment, Measures, Row, Setup, Trial};
use crate::measure::{Measure, RowOf};
use crate::paper::{explanations, paper_table};

/// The system whose random stream is used.
pub const ARM_SYSTEM: u32 = 440;

/// What its rows of other learners are named after.
const CASE: &str = "arm";

/// The experiment.
pub(crate) fn three_link() -> anyhow::Result<Experiment> {
    let beside = beside(1500);
    let contest =
        |measure| {
            Contest::of(CASE, measure, &beside.contestants())
                .with(Contestant::PolicyAlign, "policy_align", measure)
                .with(Contestant::Naive, "naive", measure)
        };
    Ok(Experiment {
        id: "three_link",
        section: "4.4",
        title: "The three-link arm, pathological constraints",
        data_sets: 50,
        remark: "Unit links, starts uniform in [-1, 1]^3, δt = 0.5 s, plain Euler, narrow bandwidth. Regression with fixed diagonal \
                 metrics, 10 passes: D = 20 for PolicyAlign, 50 for the naive baseline. The printed errors of the naive baseline are held against \
                 its errors on held-out samples of all movements, since it discards none.",
        reservations: &[],
        decisions: "three-link.md",
        contests_remark: None,
        another_reading_of: None,
        contests: [Measure::Nupe, Measure::Ncpe].map(contest).into(),
        setups: vec![
            printed(arm()?, regressor(), naive())?,
            Setup {
                id: "beside".to_owned(),
                rows: beside.rows(CASE),
                system: ARM_SYSTEM,
                data_sets: Some(DATA_SETS),
                cost: beside.cost(),
                trial: Box::new(BesideTrial { scene: arm()?, algorithms: vec![PolicyAlign::default()], beside }),
            },
        ],
        paper: paper_table(include_str!("../paper/three_link.toml"))?,
        explanations: explanations("three_link", include_str!("../paper/three_link-explained.toml"))?,
    })
}

/// Who learns beside PolicyAlign and the naive learner.
pub(super) fn beside(max_rows: usize) -> Beside {
    Beside { naive: None, constraint_consistent: None, gaussians: Gaussians::new(FrontEnd::Map, max_rows) }
}

/// The arm of Section 4.4.
///
/// # Errors
/// If the robot's file is damaged.
pub fn arm() -> anyhow::Result<ThreeLinkArm> {
    Ok(ThreeLinkArm::new(include_str!("../../../robots/planar_three_link.urdf"))?)
}

/// Learns the aligned potential.
pub(super) fn regressor() -> LwprRegressor {
    LwprRegressor { params: params(20.0), ..LwprRegressor::default() }
}

fn naive() -> DirectPolicyLearning {
    DirectPolicyLearning { params: params(50.0), ..DirectPolicyLearning::default() }
}

/// The printed rows.
fn printed(arm: ThreeLinkArm, regressor: LwprRegressor, naive: DirectPolicyLearning) -> anyhow::Result<Setup> {
    let rows = [("policy_align", RowOf::Learner), ("naive", RowOf::Baseline)];
    // In the order of the rows.
    let pupils = vec![Pupil::PolicyAlign(regressor), Pupil::other(naive)?];
    Ok(Setup {
        id: "three_link".to_owned(),
        rows: rows.map(|(id, of)| Row { id: id.to_owned(), of, tested_on: TESTED_ON }).into(),
        system: ARM_SYSTEM,
        data_sets: None,
        cost: 2_000_000,
        trial: Box::new(ArmTrial { arm, algorithm: PolicyAlign::default(), pupils }),
    })
}

/// What is fitted.
pub(super) fn settings() -> Vec<Setting> {
    let setting = |name, paper, used, with| Setting { experiment: "three_link", name, paper, used, with };
    vec![
        setting("D of PolicyAlign's regression", SILENT, 20.0, |init_d| {
            let regressor = LwprRegressor { params: params(init_d), ..regressor() };
            Ok(vec![printed(arm()?, regressor, naive())?])
        }),
        setting("passes of PolicyAlign's regression", SILENT, 10.0, |passes| {
            let regressor = LwprRegressor { passes: passes.round() as usize, ..regressor() };
            Ok(vec![printed(arm()?, regressor, naive())?])
        }),
        setting("passes of the naive regression", SILENT, 10.0, |passes| {
            let naive = DirectPolicyLearning { passes: passes.round() as usize, ..naive() };
            Ok(vec![printed(arm()?, regressor(), naive)?])
        }),
        setting("D of the naive regression", SILENT, 50.0, |init_d| {
            let naive = DirectPolicyLearning { params: params(init_d), ..naive() };
            Ok(vec![printed(arm()?, regressor(), naive)?])
        }),
        setting("starts within ±, rad", SILENT, 1.0, |range| {
            Ok(vec![printed(ThreeLinkArm { start_range: range, ..arm()? }, regressor(), naive())?])
        }),
        setting("δt, s", SILENT, 0.5, |time_step| {
            let mut arm = arm()?;
            arm.roll_out.time_step = time_step;
            Ok(vec![printed(arm, regressor(), naive())?])
        }),
    ]
}

fn params(init_d: f64) -> LwprParams {
    let norm_in = Some(DVector::repeat(3, 1.0));
    LwprParams { init_d, norm_in, adaptation: MetricAdaptation::Fixed, ..LwprParams::default() }
}

#[derive(Serialize)]
struct ArmTrial {
    arm: ThreeLinkArm,
    algorithm: PolicyAlign,
    pupils: Vec<Pupil>,
}

impl Trial for ArmTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.arm.record(rng)?;
        let mut rows = examine(&recordings, &self.algorithm, &self.pupils, rng)?.rows()?;
        let leaving = n_leaving_limits(&self.arm.robot, &recordings)?;
        rows[0].insert(Measure::BeyondLimits, 100.0 * leaving as f64 / recordings.len() as f64);
        Ok(rows)
    }
}
