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
use super::settings::{SILENT, Setting};
use super::{Experiment, Measures, Row, Setup, Trial};
use crate::measure::Measure;
use crate::paper::{explanations, paper_table};
use crate::robots::upper_body;

/// The system that data sets are drawn for.
pub const GRASP_SYSTEM: u32 = 420;

/// Typical spread of a palm's coordinates, metres: the divisor of all inputs of the regressions.
const SPREAD: f64 = 0.3;

/// The experiment.
pub(crate) fn table2() -> anyhow::Result<Experiment> {
    let beside = grasp_beside();
    let contest = |(case, [measure, _]): (&str, [Measure; 2])| Contest {
        case: case.to_owned(),
        ..Contest::of(CASE, measure, &beside.contestants())
            .with(Contestant::PolicyAlign, case, Measure::PolicyAlign)
            .with(Contestant::Naive, case, Measure::Naive)
    };
    Ok(Experiment {
        id: "table2",
        section: "4.2",
        title: "Table 2: grasping a ball",
        data_sets: 50,
        remark: "Fitted, because the paper does not give them: the robot's posture, starts (palms before x = 0.26 m), ball (x = 0.7 m), wall (x = 0.35 m, felt from 0.09 m before it), \
                 half-width of the unseen obstacle (0.13 m), no gap narrower than 0.17 m, regressions. δt = 0.5 s, plain Euler, narrow \
                 bandwidth. Fixed diagonal metrics, inputs divided by 0.3 m: PolicyAlign D = 22, 10 passes; naive D = 10, 4 passes. The printed errors of \
                 the naive learner are held against its errors on held-out samples of all movements, since it discards none. The clip at 0.17 m widens 21 % of the gaps, and decides \
                 which cells agree (docs/leverage.md); the unseen obstacle stops the expert, too, in half of the movements (from 0.06 m down it \
                 stops none, and the naive error no longer agrees); movements last 50 s, the printed ones 2 s.",
        reservations: &[
            "PolicyAlign's three errors are less than half of the printed ones, also under the training constraint, where the naive learner errs less in \
             the paper and more here.",
        ],
        decisions: "table2.md",
        contests_remark: None,
        another_reading_of: None,
        contests: CASES.into_iter().zip(ERRORS).map(contest).collect(),
        setups: vec![
            printed(grasp()?, grasp_regressor(), grasp_naive())?,
            Setup {
                id: "beside".to_owned(),
                rows: beside.rows(CASE),
                system: GRASP_SYSTEM,
                data_sets: Some(DATA_SETS),
                cost: beside.cost(),
                trial: Box::new(GraspBeside { grasp: grasp()?, algorithm: PolicyAlign::default(), beside }),
            },
        ],
        paper: paper_table(include_str!("../paper/table2.toml"))?,
        explanations: explanations("table2", include_str!("../paper/table2-explained.toml"))?,
    })
}

/// The printed rows.
fn printed(grasp: Grasp, regressor: LwprRegressor, naive: DirectPolicyLearning) -> anyhow::Result<Setup> {
    // In the order of [`MEASURES`].
    let pupils = vec![Pupil::PolicyAlign(regressor), Pupil::other(naive)?];
    Ok(Setup {
        id: "grasp".to_owned(),
        rows: CASES.into_iter().chain(["alignment"]).map(Row::of_learner).collect(),
        system: GRASP_SYSTEM,
        data_sets: None,
        cost: 2_000_000,
        trial: Box::new(GraspTrial { grasp, algorithm: PolicyAlign::default(), pupils }),
    })
}

/// The printed rows in another scene.
fn staged(change: impl Fn(&mut Grasp)) -> anyhow::Result<Vec<Setup>> {
    let mut grasp = grasp()?;
    change(&mut grasp);
    Ok(vec![printed(grasp, grasp_regressor(), grasp_naive())?])
}

/// What is fitted.
pub(super) fn settings() -> Vec<Setting> {
    let setting = |name, paper, used, with| Setting { experiment: "table2", name, paper, used, with };
    vec![
        setting("narrowest gap, m", "gaps from N(0.25, 0.1²)", 0.17, |least| staged(|grasp| grasp.gap_least = least)),
        setting("ball, m in front of the robot", SILENT, 0.7, |x| staged(|grasp| grasp.scene.ball.x = x)),
        setting("start palms at most this far in front, m", SILENT, 0.26, |x| staged(|grasp| grasp.start_depth = x)),
        setting("wall, m in front of the robot", SILENT, 0.35, |wall| staged(|grasp| grasp.scene.wall = wall)),
        setting("influence of the wall, m", SILENT, 0.09, |metres| staged(|grasp| grasp.scene.wall_influence = metres)),
        setting("half-width of the unseen obstacle, m", SILENT, 0.13, |half_width| {
            staged(|grasp| grasp.scene.obstacle_half_width = half_width)
        }),
        setting("δt, s", "2 s at 50 Hz", 0.5, |time_step| staged(|grasp| grasp.roll_out.time_step = time_step)),
        setting("D of PolicyAlign's regression", SILENT, 22.0, |init_d| {
            let regressor = LwprRegressor { params: params(init_d), ..grasp_regressor() };
            Ok(vec![printed(grasp()?, regressor, grasp_naive())?])
        }),
        setting("passes of PolicyAlign's regression", SILENT, 10.0, |passes| {
            let regressor = LwprRegressor { passes: passes.round() as usize, ..grasp_regressor() };
            Ok(vec![printed(grasp()?, regressor, grasp_naive())?])
        }),
        setting("D of the naive regression", SILENT, 10.0, |init_d| {
            let naive = DirectPolicyLearning { params: params(init_d), ..grasp_naive() };
            Ok(vec![printed(grasp()?, grasp_regressor(), naive)?])
        }),
        setting("passes of the naive regression", SILENT, 4.0, |passes| {
            let naive = DirectPolicyLearning { passes: passes.round() as usize, ..grasp_naive() };
            Ok(vec![printed(grasp()?, grasp_regressor(), naive)?])
        }),
    ]
}

/// The rows of the printed table.
const CASES: [&str; 3] = ["training", "unseen_barrier", "unconstrained"];

/// What rows of other learners are named after.
const CASE: &str = "grasp";

/// Who learns beside PolicyAlign and the naive learner.
pub fn grasp_beside() -> Beside {
    Beside { naive: None, constraint_consistent: None, gaussians: Gaussians::new(FrontEnd::Map, 1000) }
}

/// What is demonstrated.
///
/// # Errors
/// If the robot's files are damaged.
pub fn grasp() -> anyhow::Result<Grasp> {
    Ok(Grasp::new(upper_body()?))
}

/// The regression on aligned potentials.
pub fn grasp_regressor() -> LwprRegressor {
    LwprRegressor { params: params(22.0), passes: 10, ..LwprRegressor::default() }
}

/// The naive learner.
pub fn grasp_naive() -> DirectPolicyLearning {
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

#[cfg(test)]
mod tests {
    use motion::NegativeGradient;

    use super::*;
    use crate::quotable;
    use crate::seed::generator;

    /// Numbers in the remark that no record has: they follow from the set-up.
    #[test]
    fn the_remark_is_as_the_scene_is() {
        let remark = table2().unwrap().remark;
        for setting in quotable().filter(|setting| setting.experiment == "table2") {
            assert!(remark.contains(&setting.used.to_string()), "{} is not told", setting.name);
        }
        let grasp = grasp().unwrap();
        let mut rng = generator(1, GRASP_SYSTEM, 0);
        let starts: Vec<_> = (0..grasp.n_trajectories).map(|_| grasp.start(&mut rng).unwrap()).collect();
        // Of a normal distribution 21.2 % lie below 0.8 standard deviations under its mean.
        let below = (grasp.gap_mean - grasp.gap_least) / grasp.gap_deviation;
        assert!((below - 0.8).abs() < 1e-12 && remark.contains("widens 21 % of the gaps"));
        let widened = starts.iter().filter(|start| start.gap <= grasp.gap_least).count();
        assert!((10..=35).contains(&widened), "{widened}");

        let (expert, target) = (NegativeGradient(grasp.scene.potential()), grasp.scene.target());
        let stopped = |half_width: f64| {
            let mut scene = grasp.scene.clone();
            scene.obstacle_half_width = half_width;
            let obstacle = scene.central_obstacle().unwrap();
            let far = |start: &&demo_gen::GraspStart| {
                let trajectory = grasp.roll_out.follow(&expert, &obstacle, start.palms.as_view()).unwrap();
                let off = trajectory.state(trajectory.n_samples() - 1) - &target;
                off.fixed_rows::<3>(0).norm().max(off.fixed_rows::<3>(3).norm()) > 0.2
            };
            starts.iter().filter(far).count()
        };
        assert!(remark.contains("in half of the movements (from 0.06 m down it stops none"));
        let (used, narrow) = (stopped(grasp.scene.obstacle_half_width), stopped(0.06));
        assert!((45..=60).contains(&used) && narrow == 0, "{used} {narrow}");
        let seconds = grasp.roll_out.time_step * grasp.roll_out.n_samples as f64;
        assert!(remark.contains(&format!("movements last {seconds} s, the printed ones 2 s")));
    }
}
