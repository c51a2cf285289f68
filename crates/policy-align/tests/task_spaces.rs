//! `fit --robot` with constraints on a robot's tool: the policy is learnt in the tool's task space.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::sync::atomic::AtomicBool;

use demo_gen::tasks::{Contact, Wiping};
use motion::{Channel, Episode, Recordings, Source, Times};
use nalgebra::{DMatrix, DVector};
use policy_align::{FitOptions, Model, PrepareOptions, Progress, Subject, fit, prepare};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const ARM: &str = include_str!("../../../robots/seven_joint_arm.urdf");
/// Number of test movements, which are not in the training set.
const FRESH: usize = 10;

/// A fit with a planar arm, which rotates about one axis only, so that no orientation can be held while it moves. Joints are in this
/// unit.
fn in_a_plane(unit: &str, radians: f64) -> Model {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let episode = |number: usize| {
        let mut draw = || rng.random_range(-1.0..1.0);
        let (start, rail) = (DVector::from_fn(3, |_, _| draw()), DVector::from_fn(3, |_, _| draw()).normalize());
        let along = &rail * rail.dot(&start);
        let left = |i: usize| (-0.1 * i as f64).exp();
        let noise = DMatrix::from_fn(3, 30, |_, _| 0.05 * draw());
        Episode {
            name: number.to_string(),
            source: Source::default(),
            times: Times::Even { step: 0.1, len: 30 },
            positions: DMatrix::from_fn(3, 30, |k, i| start[k] - along[k] * (1.0 - left(i))) / radians,
            velocities: Some((DMatrix::from_fn(3, 30, |k, i| -along[k] * left(i)) + noise) / radians),
            constraint: None,
            context: DVector::zeros(0),
        }
    };
    let state = ["shoulder", "elbow", "wrist"]
        .map(|name| Channel { name: name.to_owned(), unit: Some(unit.to_owned()) })
        .to_vec();
    let recordings = Recordings { state, episodes: (0..12).map(episode).collect(), findings: vec![] };
    let prepared = prepare(recordings, &PrepareOptions::default()).unwrap();
    let robot = Some(include_str!("../../../robots/planar_three_link.urdf").to_owned());
    let options = FitOptions { robot, max_rows: 100, ..FitOptions::default() };
    let never = AtomicBool::new(false);
    fit(&prepared, &options, &mut Progress { cancelled: &never, report: &mut |_| () }).unwrap()
}

#[test]
fn joints_in_degrees_are_those_in_radians() {
    let [radians, degrees] = [in_a_plane("rad", 1.0), in_a_plane("deg", 1f64.to_radians())];
    let [a, b] = [&radians, &degrees].map(|model| model.trust.numbers.expected_error);
    assert!(a > 1e-3, "task spaces were not tried: {:?}", radians.trust.numbers);
    assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
}

#[test]
fn constraints_of_a_tool_are_learnt_from() {
    let mut system = Wiping::new(ARM, Contact::Height).unwrap();
    system.n_trajectories = 40 + FRESH;
    system.roll_out.n_samples = 60;
    let mut shown = system.record(&mut ChaCha8Rng::seed_from_u64(4)).unwrap();
    let fresh = shown.split_off(40);
    let step = system.roll_out.time_step;
    let episodes = shown.iter().enumerate().map(|(number, of)| Episode {
        name: number.to_string(),
        source: Source::default(),
        times: Times::Even { step, len: of.truth.states.ncols() },
        positions: of.truth.states.clone(),
        velocities: of.observed.velocities().cloned(),
        constraint: None,
        context: DVector::zeros(0),
    });
    let names = system.robot().joints().iter().map(|joint| Channel { name: joint.name().to_owned(), unit: None });
    let recordings = Recordings { state: names.collect(), episodes: episodes.collect(), findings: vec![] };
    let prepared = prepare(&recordings, &PrepareOptions::default()).unwrap();
    let learnt = |robot: Option<String>| {
        let never = AtomicBool::new(false);
        let options = FitOptions { robot, ..FitOptions::default() };
        fit(&prepared, &options, &mut Progress { cancelled: &never, report: &mut |_| () }).unwrap()
    };
    let error = |model: &Model| {
        let (mut apart, mut all) = (0.0, 0.0);
        for of in &fresh {
            for (state, action) in of.truth.states.column_iter().zip(of.truth.actions.column_iter()) {
                apart += (model.learnt.policy().action(state) - action).norm_squared();
                all += action.norm_squared();
            }
        }
        apart / all
    };
    let space = |model: &Model| {
        let found = model.decisions.iter().find(|decision| decision.what == Subject::TaskSpace);
        found.map(|decision| decision.value.clone())
    };
    let (with, without) = (learnt(Some(ARM.to_owned())), learnt(None));
    assert!(error(&with) < 0.01 && error(&with) < error(&without) / 5.0, "{} {}", error(&with), error(&without));
    assert!(space(&with).is_some_and(|space| space.ends_with("of tool")), "{:?}", with.decisions);
    assert_eq!(space(&without), None);
    let read = Model::from_json(with.to_json().unwrap().as_bytes()).unwrap();
    assert_eq!(read.to_json().unwrap(), with.to_json().unwrap());
}
