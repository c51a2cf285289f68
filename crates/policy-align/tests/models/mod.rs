//! Models of the toy system, one for each learner, small enough to be read many times.

#![allow(dead_code, reason = "every test that has this module uses a part of it")]

use align::{Bandwidth, LwprRegressor, PolicyAlign};
use constraints::Unconstrained;
use demo_gen::{RollOut, ToySystem, demonstrations};
use gp::{AutoGp, DirectGp, FrontEnd, Rows, SlopeGp};
use motion::Demonstrations;
use nalgebra::{DMatrix, DVector};
use policy_align::{
    DataSummary, Decision, FileSummary, Finding, Learnt, LeftOut, MadeBy, Model, StateChannel, Subject, Trust,
    TrustNumbers, Verdict,
};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Movements of the toy system.
pub(crate) fn toy(n_trajectories: usize, n_samples: usize) -> Demonstrations {
    let system = ToySystem { n_trajectories, n_samples, ..ToySystem::default() };
    let recordings = system.record(&mut ChaCha8Rng::seed_from_u64(7)).unwrap();
    demonstrations(&recordings).unwrap()
}

/// Unconstrained movements down the same bowl.
pub(crate) fn free(n_trajectories: usize, n_samples: usize) -> Demonstrations {
    let roll_out = RollOut { n_samples, ..RollOut::default() };
    let potential = ToySystem::default().potential;
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let recordings: Vec<_> = (0..n_trajectories)
        .map(|_| {
            let start = DVector::from_fn(2, |_, _| rng.random_range(-2.0..2.0));
            roll_out.record(&potential, &Unconstrained { dim: 2 }, start.as_view()).unwrap()
        })
        .collect();
    demonstrations(&recordings).unwrap()
}

pub(crate) fn rows(demonstrations: &Demonstrations) -> Rows {
    FrontEnd::Velocities.rows(demonstrations).unwrap()
}

/// Few rows: these tests need a model, not a good one.
fn slope_gp() -> SlopeGp {
    SlopeGp { max_rows: 200, hyper_rows: 80, ..SlopeGp::default() }
}

fn direct_gp() -> DirectGp {
    DirectGp { max_rows: 200, hyper_rows: 80, ..DirectGp::default() }
}

pub(crate) fn slope(demonstrations: &Demonstrations) -> Model {
    let fit = slope_gp().fit(&rows(demonstrations), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
    model(Learnt::Slope(Box::new(fit)), demonstrations)
}

pub(crate) fn direct(demonstrations: &Demonstrations) -> Model {
    let fit = direct_gp().fit(&rows(demonstrations), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
    model(Learnt::Direct(Box::new(fit)), demonstrations)
}

pub(crate) fn auto(demonstrations: &Demonstrations) -> Model {
    let learner = AutoGp { slope: slope_gp(), ..AutoGp::default() };
    let fit = learner.fit(&rows(demonstrations), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
    model(Learnt::Auto(Box::new(fit)), demonstrations)
}

pub(crate) fn policy_align(demonstrations: &Demonstrations) -> Model {
    let aligned = PolicyAlign { bandwidth: Bandwidth::Medium, ..PolicyAlign::default() }.align(demonstrations).unwrap();
    let learnt = aligned.learn(&LwprRegressor::default(), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
    model(Learnt::PolicyAlign(Box::new(learnt)), demonstrations)
}

/// One model for each learner, with its name.
pub(crate) fn one_of_each(demonstrations: &Demonstrations) -> [(&'static str, Model); 4] {
    [
        ("auto", auto(demonstrations)),
        ("slope", slope(demonstrations)),
        ("direct", direct(demonstrations)),
        ("policy-align", policy_align(demonstrations)),
    ]
}

/// A model that contains the given policy.
pub(crate) fn model(learnt: Learnt, demonstrations: &Demonstrations) -> Model {
    let channel = |axis: usize| {
        let mut values: Vec<f64> = demonstrations
            .trajectories()
            .iter()
            .flat_map(|t| t.states().row(axis).iter().copied().collect::<Vec<_>>())
            .collect();
        values.sort_by(f64::total_cmp);
        StateChannel {
            name: ["x", "y", "z"][axis].to_owned(),
            unit: (axis == 0).then(|| "m".to_owned()),
            scale: 1.0,
            low: values[0],
            high: values[values.len() - 1],
            median: values[values.len() / 2],
        }
    };
    let velocities = demonstrations
        .trajectories()
        .iter()
        .flat_map(|t| t.velocities().unwrap().column_iter().map(|u| u.norm()).collect::<Vec<_>>());
    let mut speeds: Vec<f64> = velocities.collect();
    speeds.sort_by(f64::total_cmp);
    Model {
        made_by: MadeBy { program: "policy-align 0.1.0".to_owned(), time: "2026-11-22T00:12:05Z".to_owned() },
        context: vec![],
        chosen_context: nalgebra::DVector::zeros(0),
        predicted: vec![],
        state: (0..demonstrations.dim()).map(channel).collect(),
        time_step: demonstrations.trajectories()[0].time_step(),
        data: DataSummary {
            files: vec![FileSummary { name: "toy.csv".to_owned(), sha256: policy_align::sha256(b"toy"), bytes: 3 }],
            episodes: demonstrations.n_trajectories(),
            samples: demonstrations.n_samples(),
            longest: 39.0,
            speed: speeds[speeds.len() / 2],
            left_out: vec![LeftOut { episode: "17".to_owned(), why: "not connected".to_owned() }],
        },
        decisions: vec![Decision {
            what: Subject::Integration,
            value: "velocity".to_owned(),
            why: "recorded; they agree with the steps".to_owned(),
            flag: "--integration".to_owned(),
        }],
        seed: 1,
        trust: Trust {
            verdict: Verdict::Doubtful,
            findings: vec![Finding::doubt(
                "held-out movements are predicted poorly (error 0.2)",
                "record more movements",
            )],
            numbers: TrustNumbers {
                episodes: demonstrations.n_trajectories(),
                reading: gp::Hypothesis::Constrained,
                held_out_error: 0.2,
                episode_errors: vec![(0, 0.1), (2, 0.4)],
                held_out_error_direct: 0.6,
                direct_error: 0.5,
                gap: 0.4,
                expected_error: 0.1,
                ambiguity: 0.01,
                slope_r_squared: 0.9,
                z_squared: 1.1,
                direction_coverage: 0.8,
                unseen_direction: vec![0.6, 0.8],
                least_known: 0.01,
                least_known_direction: vec![1.0, 0.0],
                rotation_share: 0.0,
                rotation_t: None,
                model: gp::ModelKind::Potential,
                halves: Some(0.05),
                unknown: 0.02,
                leaving: 0.0,
                step_noise: 0.001,
                grouping: gp::Grouping::Trajectories,
                aligned: None,
            },
        },
        learnt,
    }
}

/// States in and around the data of the toy system, (2, `count`).
pub(crate) fn states(count: usize) -> DMatrix<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    DMatrix::from_fn(2, count, |_, _| rng.random_range(-2.5..2.5))
}
