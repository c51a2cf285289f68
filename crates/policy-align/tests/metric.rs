//! A robot's mass matrix as the metric of constraints: tried if a URDF is given, used if the movements support it.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::sync::atomic::AtomicBool;

use motion::{Channel, Episode, Recordings, Source, Times};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use policy_align::{FitError, FitOptions, Model, PrepareOptions, Progress, Subject, Verdict, fit, prepare};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Two rods of one metre with one kilogram at the end of each.
fn urdf(mass: &str) -> String {
    format!(
        r#"<robot name="arm"><link name="base"/>
        <link name="upper"><inertial><origin xyz="1 0 0"/><mass value="{mass}"/></inertial></link>
        <link name="lower"><inertial><origin xyz="1 0 0"/><mass value="{mass}"/></inertial></link>
        <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
        <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
        </robot>"#
    )
}

fn mass(q: &Vector2<f64>) -> Matrix2<f64> {
    let bent = q.y.cos();
    Matrix2::new(3.0 + 2.0 * bent, 1.0 + bent, 1.0 + bent, 1.0)
}

fn policy(q: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-q.x.sin() - 0.3 * (q.x - q.y).sin(), -0.5 * q.y + 0.3 * (q.x - q.y).sin())
}

/// Movements along one line each, under constraints that are orthogonal in `metric`.
fn recordings(metric: impl Fn(&Vector2<f64>) -> Matrix2<f64>) -> Recordings {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let episodes = (0..30).map(|number| {
        let mut q = Vector2::from_fn(|_, _| rng.random_range(-1.5..1.5f64));
        let angle = rng.random_range(0.0..std::f64::consts::PI);
        let along = Vector2::new(angle.cos(), angle.sin());
        let (mut states, mut velocities) = (vec![], vec![]);
        for _ in 0..25 {
            let weighed = metric(&q) * along;
            let u = along * (weighed.dot(&policy(&q)) / weighed.dot(&along));
            states.extend_from_slice(q.as_slice());
            velocities.extend_from_slice(u.as_slice());
            q += u * 0.05;
        }
        let matrix = |numbers| DMatrix::from_vec(2, 25, numbers);
        Episode {
            name: number.to_string(),
            source: Source::default(),
            times: Times::Even { step: 0.05, len: 25 },
            positions: matrix(states),
            velocities: Some(matrix(velocities)),
            constraint: None,
            context: DVector::zeros(0),
        }
    });
    let state = ["shoulder", "elbow"].map(|name| Channel { name: name.to_owned(), unit: None }).to_vec();
    Recordings { state, episodes: episodes.collect(), findings: vec![] }
}

fn learnt(recordings: &Recordings, robot: Option<String>) -> Result<Model, FitError> {
    let prepared = prepare(recordings, &PrepareOptions::default()).unwrap();
    let never = AtomicBool::new(false);
    fit(
        &prepared,
        &FitOptions { robot, ..FitOptions::default() },
        &mut Progress { cancelled: &never, report: &mut |_| () },
    )
}

fn error(model: &Model) -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let (mut apart, mut all) = (0.0, 0.0);
    for _ in 0..100 {
        let q = Vector2::from_fn(|_, _| rng.random_range(-1.0..1.0f64));
        let learnt = model.learnt.policy().action(DVector::from_column_slice(q.as_slice()).as_view());
        apart += (Vector2::new(learnt[0], learnt[1]) - policy(&q)).norm_squared();
        all += policy(&q).norm_squared();
    }
    apart / all
}

#[test]
fn the_mass_matrix_is_taken_where_it_explains_the_movements() {
    let oblique = recordings(mass);
    let (with, without) = (learnt(&oblique, Some(urdf("1"))).unwrap(), learnt(&oblique, None).unwrap());
    assert!(error(&with) < 1e-3 && error(&without) > 0.05, "{} {}", error(&with), error(&without));
    let verdicts = (with.trust.verdict, without.trust.verdict);
    assert!(verdicts.0 < Verdict::DoNotUse && verdicts.1 == Verdict::DoNotUse, "{verdicts:?}");
    assert!(
        with.decisions
            .iter()
            .any(|decision| decision.what == Subject::Metric && decision.value == "mass matrix of arm")
    );
    let plain = recordings(|_| Matrix2::identity());
    let [with, without] = [Some(urdf("1")), None].map(|robot| learnt(&plain, robot).unwrap().to_json().unwrap());
    assert_eq!(with, without);
}

#[test]
fn robots_that_cannot_be_used_are_refused() {
    let oblique = recordings(mass);
    let reason = |robot: String| match learnt(&oblique, Some(robot)) {
        Ok(_) => panic!("a robot was taken"),
        Err(error) => error.to_string(),
    };
    // With or without masses, constraints on its last link are tried, unless an unrecorded joint moves it.
    let wrist = r#"<link name="hand"/><joint name="wrist" type="continuous"><parent link="lower"/><child link="hand"/></joint></robot>"#;
    assert!(reason(urdf("0").replace("</robot>", wrist)).ends_with("; give each link <inertial>"));
    let [with, without] = [Some(urdf("0")), None].map(|robot| learnt(&oblique, robot).unwrap().to_json().unwrap());
    assert_eq!(with, without);
    assert!(reason(urdf("-1")).contains("negative"));
    assert!(reason(urdf("1").replace("elbow", "knee")).contains("elbow"));
}
