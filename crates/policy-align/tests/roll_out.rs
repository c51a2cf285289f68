//! Roll-outs: their paths, their constraints, and their ends.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod models;

use std::f64::consts::TAU;

use cpu_time::ThreadTime;
use demo_gen::RollOut as Teacher;
use models::{model, rows, slope, toy};
use motion::Policy as _;
use nalgebra::{DMatrix, DVector, dmatrix, dvector};
use policy_align::{ConstraintSet, JointLimits, Learnt, Model, Path, RollOut, RollOutError, Stop};
use proptest::prelude::*;
use rand::SeedableRng as _;

const TIP: &str = r#"<robot name="arm"><link name="base"/><link name="upper"/><link name="fore"/><link name="hand"/>
  <joint name="x" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-1.2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="y" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="fixed"><parent link="fore"/><child link="hand"/><origin xyz="1 0 0"/></joint></robot>"#;

fn channels() -> Vec<String> {
    vec!["x".to_owned(), "y".to_owned()]
}

fn constraints(text: &str) -> ConstraintSet {
    ConstraintSet::from_toml(text, &channels(), std::path::Path::new(".")).unwrap()
}

/// A policy for roll-outs, learnt once.
fn toy_model() -> Model {
    static MODEL: std::sync::OnceLock<Model> = std::sync::OnceLock::new();
    MODEL.get_or_init(|| slope(&toy(20, 40))).clone()
}

fn follow(roll_out: &RollOut, start: &DVector<f64>) -> Path {
    roll_out.follow(&toy_model(), start).unwrap()
}

fn last(path: &Path) -> DVector<f64> {
    path.states.column(path.states.ncols() - 1).into_owned()
}

#[test]
fn roll_out_rests_at_the_minimum_of_the_potential() {
    let path = follow(&RollOut { seconds: Some(400.0), ..RollOut::default() }, &dvector![1.5, 1.0]);
    assert_eq!(path.stop, Stop::AtRest);
    assert!(last(&path).norm() < 0.1, "{}", last(&path));
    assert_eq!((path.times.len(), path.states.shape()), (path.states.ncols(), path.velocities.shape()));
    assert_eq!(path.times[3], 3.0 * toy_model().time_step);
    assert_eq!(path.broken_by, None);
}

/// The state of rest does not depend on the sampling of the path.
#[test]
fn rest_does_not_depend_on_the_step() {
    let model = toy_model();
    let usual = follow(&RollOut { seconds: Some(400.0), ..RollOut::default() }, &dvector![1.5, 1.0]);
    let end = |path: &Path| path.times[path.times.len() - 1];
    for share in [0.1, 0.5, 2.0, 5.0] {
        let step = share * model.time_step;
        let path =
            follow(&RollOut { seconds: Some(400.0), step: Some(step), ..RollOut::default() }, &dvector![1.5, 1.0]);
        assert_eq!(path.stop, Stop::AtRest);
        let most = model.time_step + 2.0 * step;
        assert!((end(&path) - end(&usual)).abs() <= most, "{share}: {} s, {} s", end(&path), end(&usual));
    }
}

#[test]
fn roll_out_agrees_with_small_midpoint_steps() {
    let (model, start) = (toy_model(), dvector![-1.2, 0.8]);
    let path = RollOut { seconds: Some(20.0), ..RollOut::default() }.follow(&model, &start).unwrap();
    let (policy, mut x) = (model.policy(), start);
    for _ in 0..20_000 {
        let middle = &x + policy.action(x.as_view()) * 0.0005;
        x += policy.action(middle.as_view()) * 0.001;
    }
    assert!((last(&path) - &x).norm() < 1e-3, "{} {x}", last(&path));
}

#[test]
fn roll_out_agrees_with_the_teachers_under_a_constraint() {
    let model = toy_model();
    let constraint = constraints::LinearConstraint::new(nalgebra::dmatrix![1.0, 0.5]).unwrap();
    let teacher = Teacher { time_step: 0.01, n_samples: 1001, ..Teacher::default() };
    let start = dvector![-1.0, 1.0];
    let taught = teacher.follow(&model.policy(), &constraint, start.as_view()).unwrap();
    let set = constraints("[[constraint]]\nnormal = [1, 0.5]");
    let path = RollOut { constraints: set, seconds: Some(10.0), ..RollOut::default() }.follow(&model, &start).unwrap();
    assert!((last(&path) - taught.state(1000)).norm() < 5e-3);
    let (broken_by, _) = path.broken_by.unwrap();
    assert!(broken_by < 1e-13, "{broken_by}");
}

#[test]
fn constraints_hold_at_their_times_only() {
    let set = constraints("[[constraint]]\nnormal = [[2, 0], [0, 1]]\nfrom = 2.5\nuntil = 7.25\n");
    assert_eq!(set.ends(), Some(7.25));
    assert_eq!(
        constraints("[[constraint]]\nnormal = [1, 0]\n[[constraint]]\nnormal = [0, 1]\nuntil = 1\n").ends(),
        None
    );
    assert_eq!(ConstraintSet::default().ends(), None);
    let path = follow(
        &RollOut { constraints: set, seconds: Some(20.0), step: Some(0.5), ..RollOut::default() },
        &dvector![1.0, 1.0],
    );
    let moved = |from: usize, to: usize| (path.states.column(to) - path.states.column(from)).norm();
    assert!(moved(0, 5) > 0.01 && moved(15, 40) > 0.01);
    assert_eq!(moved(5, 14), 0.0);
    assert!(path.stop == Stop::Time && path.broken_by == Some((0.0, 0)), "{:?} {:?}", path.stop, path.broken_by);
}

#[test]
fn rows_and_functions_act_like_constraint_files() {
    let start = dvector![1.5, 1.0];
    let of = |constraints| follow(&RollOut { constraints, seconds: Some(12.0), ..RollOut::default() }, &start);
    let file = of(constraints("[[constraint]]\nnormal = [1, 0.5]"));
    assert_eq!(of(ConstraintSet::normal(dmatrix![1.0, 0.5], 2).unwrap()), file);
    // Under a function, a roll-out never ends at rest, so its path may be longer.
    let begins_as = |path: &Path, other: &Path| {
        assert!(path.states.ncols() >= other.states.ncols() && other.states.ncols() > 5);
        assert_eq!(path.states.columns(0, other.states.ncols()), other.states);
    };
    begins_as(&of(ConstraintSet::function(|_, _| Ok(dmatrix![1.0, 0.5]))), &file);
    let free = of(ConstraintSet::default());
    begins_as(&of(ConstraintSet::function(|_, _| Ok(DMatrix::zeros(0, 2)))), &free);
}

#[test]
fn a_rail_that_turns_is_followed_at_every_moment() {
    let normal = |t: f64| dvector![(0.9 * t).cos(), (0.9 * t).sin()];
    let turning = ConstraintSet::function(move |_, t| Ok(DMatrix::from_row_slice(1, 2, normal(t).as_slice())));
    let path = follow(&RollOut { constraints: turning, seconds: Some(6.0), ..RollOut::default() }, &dvector![1.5, 1.0]);
    assert_eq!(path.stop, Stop::Time);
    assert!(path.times.iter().zip(path.velocities.column_iter()).all(|(&t, u)| normal(t).dot(&u).abs() < 1e-12));
    // Small steps of Euler's method, with the rail at each moment.
    let (policy, step) = (toy_model(), 1e-4);
    let mut x = dvector![1.5, 1.0];
    for k in 0..60_000 {
        let (u, a) = (policy.policy().action(x.as_view()), normal((f64::from(k) + 0.5) * step));
        x += (&u - &a * a.dot(&u)) * step;
    }
    assert!((last(&path) - &x).norm() < 1e-3, "{} {x}", last(&path));
}

#[test]
fn constraints_that_fit_no_state_are_refused() {
    for (rows, words) in [
        (dmatrix![1.0, 0.0, 0.0], "3 numbers"),
        (dmatrix![0.0, 0.0], "no direction"),
        (dmatrix![1.0, f64::NAN], "not finite"),
        (DMatrix::zeros(0, 2), "no direction"),
    ] {
        let said = ConstraintSet::normal(rows.clone(), 2).unwrap_err();
        assert!(said.contains(words), "{said}");
        let function = ConstraintSet::function(move |_, _| Ok(rows.clone()));
        let result = RollOut { constraints: function, ..RollOut::default() }.follow(&toy_model(), &dvector![1.5, 1.0]);
        if words != "no direction" {
            assert!(matches!(result, Err(RollOutError::Constraint { constraint: 1, .. })), "{result:?}");
        }
    }
    let silent = ConstraintSet::function(|_, _| Err("nobody knows".to_owned()));
    let error = RollOut { constraints: silent, ..RollOut::default() }.follow(&toy_model(), &dvector![1.5, 1.0]);
    assert!(error.unwrap_err().to_string().contains("nobody knows"));
}

#[test]
fn roll_out_passes_around_a_ball() {
    let set = constraints("[[constraint]]\npoint = [0.5, 0.55]\nradius = 0.3\n");
    let free = follow(&RollOut::default(), &dvector![1.3, 1.25]);
    let distance =
        |path: &Path| path.states.column_iter().map(|x| (x - dvector![0.5, 0.55]).norm()).fold(f64::INFINITY, f64::min);
    assert!(distance(&free) < 0.2, "the free movement goes through it: {}", distance(&free));
    let path = follow(&RollOut { constraints: set, seconds: Some(400.0), ..RollOut::default() }, &dvector![1.3, 1.25]);
    assert!(distance(&path) >= 0.3 && distance(&path) < 0.32, "{}", distance(&path));
    assert_eq!(path.broken_by, Some((0.0, 0)));
    assert!(last(&path).norm() < 0.15, "it goes on behind it: {}", last(&path));
}

#[test]
fn a_hand_stays_in_its_plane_and_out_of_a_ball() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.urdf"), TIP).unwrap();
    let file = folder.path().join("plane.toml");
    std::fs::write(&file, "[[constraint]]\nrobot = \"arm.urdf\"\nlink = \"hand\"\nplane = [0, 1, 0]\n").unwrap();
    let set = ConstraintSet::load(&file, &channels()).unwrap();
    let path = follow(&RollOut { constraints: set, ..RollOut::default() }, &dvector![1.2, 0.7]);
    let tip = |q: nalgebra::DVectorView<'_, f64>| (q[0].cos() + (q[0] + q[1]).cos(), q[0].sin() + (q[0] + q[1]).sin());
    let heights: Vec<f64> = path.states.column_iter().map(|q| tip(q).1).collect();
    let drift = heights.iter().map(|height| (height - heights[0]).abs()).fold(0.0, f64::max);
    assert!(drift < 1e-3 && (path.broken_by.unwrap().0 - drift).abs() < 1e-12, "{drift} {:?}", path.broken_by);
    assert!((last(&path) - dvector![1.2, 0.7]).norm() > 0.2);

    std::fs::write(&file, "[[constraint]]\nrobot = \"arm.urdf\"\nlink = \"hand\"\npoint = [1.6, 1, 0]\nradius = 0.3\n")
        .unwrap();
    let set = ConstraintSet::load(&file, &channels()).unwrap();
    let distance = |path: &Path| {
        let distances = path.states.column_iter().map(|q| (tip(q).0 - 1.6).hypot(tip(q).1 - 1.0));
        distances.fold(f64::INFINITY, f64::min)
    };
    assert!(distance(&follow(&RollOut::default(), &dvector![1.2, 0.7])) < 0.28);
    let path = follow(&RollOut { constraints: set, ..RollOut::default() }, &dvector![1.2, 0.7]);
    assert!(distance(&path) >= 0.3, "{}", distance(&path));
}

#[test]
fn limits_and_the_edge_of_the_data_stop_a_roll_out() {
    let limits = Some(JointLimits::from_urdf(TIP, &channels()).unwrap());
    let path = follow(&RollOut { limits: limits.clone(), ..RollOut::default() }, &dvector![-1.1, 0.1]);
    assert!(path.stop != Stop::Limit("x".to_owned()));
    let error = RollOut { limits, ..RollOut::default() }.follow(&toy_model(), &dvector![-1.3, 0.1]).unwrap_err();
    assert_eq!(error, RollOutError::StartBeyondLimit { joint: "x".to_owned() });
    assert!(JointLimits::from_urdf(TIP, &["a".to_owned()]).unwrap_err().contains("x, y"));

    // A policy that leaves the data: always to the right.
    let to_the_right = motion::Demonstrations::new(
        (0..12)
            .map(|k| {
                let y = f64::from(k) / 6.0 - 1.0;
                let states =
                    nalgebra::DMatrix::from_fn(2, 30, |row, i| if row == 0 { i as f64 / 15.0 - 1.0 } else { y });
                let velocities = nalgebra::DMatrix::from_fn(2, 30, |row, _| if row == 0 { 1.0 / 15.0 } else { 0.0 });
                motion::Trajectory::new(states, 1.0).unwrap().with_velocities(velocities).unwrap()
            })
            .collect(),
    )
    .unwrap();
    let fit =
        gp::DirectGp::default().fit(&rows(&to_the_right), &mut rand_chacha::ChaCha8Rng::seed_from_u64(1)).unwrap();
    let model = model(Learnt::Direct(Box::new(fit)), &to_the_right);
    let roll_out = RollOut { seconds: Some(1000.0), ..RollOut::default() };
    let path = roll_out.follow(&model, &dvector![0.0, 0.0]).unwrap();
    assert_eq!(path.stop, Stop::LeftTheData);
    assert!(last(&path)[0] > 0.9 && last(&path)[0] < 10.0, "{}", last(&path));
    let limits = Some(JointLimits::from_urdf(&TIP.replace("upper=\"2\"", "upper=\"0.5\""), &channels()).unwrap());
    let path = RollOut { limits, ..roll_out }.follow(&model, &dvector![0.0, 0.0]).unwrap();
    assert_eq!(path.stop, Stop::Limit("x".to_owned()));
    assert!(last(&path)[0] <= 0.5 && last(&path)[0] > 0.4);
}

#[test]
fn invalid_roll_outs_are_refused() {
    let (model, good) = (toy_model(), dvector![1.0, 1.0]);
    let refused = |roll_out: RollOut, start: &DVector<f64>| roll_out.follow(&model, start).unwrap_err();
    let error = refused(RollOut::default(), &dvector![1.0]);
    assert_eq!(error.to_string(), "the start has 1 number, the state 2: x, y");
    assert!(matches!(refused(RollOut::default(), &dvector![1.0, f64::NAN]), RollOutError::StartNotFinite { .. }));
    let outside = refused(RollOut::default(), &dvector![80.0, 80.0]);
    assert!(matches!(outside, RollOutError::Unsupported { .. }));
    let remedy = outside.remedy();
    assert!(remedy.starts_with("start near a demonstration, within x -") && remedy.contains(", y -"), "{remedy}");
    let ball = constraints("[[constraint]]\npoint = [1, 1.1]\nradius = 0.3");
    let error = refused(RollOut { constraints: ball, ..RollOut::default() }, &good);
    assert_eq!(error.to_string(), "the start breaks constraint 1 by 2.000e-1");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refused(RollOut { seconds: Some(bad), ..RollOut::default() }, &good);
        assert!(matches!(error, RollOutError::NotPositive { name: "seconds", .. }));
    }
    let error = refused(RollOut { step: Some(1e-300), ..RollOut::default() }, &good);
    assert!(matches!(error, RollOutError::TooLong { .. }));
    for error in [error, RollOutError::Start { found: 1, expected: 2, names: vec![] }] {
        assert!(!error.remedy().is_empty());
    }
}

/// The toy model with every weight multiplied by a factor.
fn stronger(factor: f64) -> Model {
    let mut model = toy_model();
    let mut learnt = serde_json::to_value(&model.learnt).unwrap();
    for weight in learnt.pointer_mut("/slope/slope_gp/weights").unwrap().as_array_mut().unwrap() {
        *weight = (weight.as_f64().unwrap() * factor).into();
    }
    model.learnt = serde_json::from_value(learnt).unwrap();
    model
}

/// Processor time of this thread in seconds.
fn cost(work: impl FnOnce()) -> f64 {
    let started = ThreadTime::now();
    work();
    started.elapsed().as_secs_f64()
}

#[test]
fn actions_that_are_not_finite_or_huge_are_errors() {
    let follow = |factor: f64| RollOut::default().follow(&stronger(factor), &dvector![1.0, 1.0]).unwrap_err();
    let error = follow(1e300);
    assert!(matches!(error, RollOutError::NotFinite { .. }), "{error}");
    assert_eq!(error.to_string(), "the action is not finite at 0.000 s, in state 1, 1");
    for factor in [1e12, 1e30, 1e100] {
        let error = follow(factor);
        assert!(matches!(error, RollOutError::TooManySteps { .. } | RollOutError::NotFinite { .. }), "{error}");
        let remedy = error.remedy();
        assert!(remedy.contains("fit again"), "{error} {remedy}");
    }
}

#[test]
fn too_many_integration_steps_are_refused() {
    let roll_out = RollOut { seconds: Some(1e300), step: Some(1e299), ..RollOut::default() };
    let mut error = None;
    let seconds = cost(|| error = roll_out.follow(&toy_model(), &dvector![1.5, 1.0]).err());
    let error = error.unwrap();
    assert!(matches!(error, RollOutError::TooManySteps { limit: 200_000, .. }), "{error}");
    let said = "more than 200000 steps of integration are needed: 0 s of 1.00e300 s were reached";
    assert_eq!(error.to_string(), said);
    assert!(error.remedy().starts_with("fewer seconds"));
    assert!(seconds < 10.0, "{seconds} s");
}

#[test]
fn a_small_ball_far_away_costs_little() {
    let of = |text: &str| {
        let roll_out = RollOut { constraints: constraints(text), seconds: Some(40.0), ..RollOut::default() };
        let seconds = || cost(|| drop(roll_out.follow(&toy_model(), &dvector![1.5, 1.0]).unwrap()));
        (0..3).map(|_| seconds()).fold(f64::INFINITY, f64::min)
    };
    let [usual, tiny] = ["0.2", "1e-12"].map(|r| of(&format!("[[constraint]]\npoint = [-2, -2]\nradius = {r}\n")));
    assert!(tiny < 25.0 * usual, "{} times", tiny / usual);
}

#[test]
fn the_cost_of_many_constraints_in_turn_is_that_of_each() {
    let of = |count: usize| {
        let one = |at: usize| {
            let from = 40.0 * at as f64 / count as f64;
            format!("[[constraint]]\nnormal = [1, 0.5]\nfrom = {from}\nuntil = {}\n", from + 20.0 / count as f64)
        };
        let set = constraints(&(0..count).map(one).collect::<String>());
        let roll_out = RollOut { constraints: set, seconds: Some(40.0), ..RollOut::default() };
        cost(|| {
            let path = roll_out.follow(&toy_model(), &dvector![1.5, 1.0]).unwrap();
            assert_eq!((path.stop, path.broken_by.unwrap().0 < 1.0), (Stop::Time, true));
        })
    };
    let ratio = of(20_000) / of(2_000);
    assert!(ratio < 25.0, "ten times the constraints, {ratio} times the time");
}

#[test]
fn faults_of_constraint_files_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.urdf"), TIP).unwrap();
    let said = |text: &str| ConstraintSet::from_toml(text, &channels(), folder.path()).unwrap_err().to_string();
    for (text, expected) in [
        ("[[constraint]\n", "line 1"),
        ("[[constraint]]\nnormal = [1, 0]\nform = 1", "line 3: unknown field `form`"),
        ("[[constraint]]\nfrom = 1", "constraint 1: give `normal`"),
        ("[[constraint]]\nnormal = [1, 0, 0]", "constraint 1: `normal` has 3 numbers: it needs 2"),
        ("[[constraint]]\nnormal = [[1, 0], [0, 0]]", "constraint 1: `normal` has no direction"),
        ("[[constraint]]\nnormal = [1, 0]\n[[constraint]]\npoint = [1, nan]\nradius = 1", "constraint 2: `point`"),
        ("[[constraint]]\npoint = [1, 0]\nradius = 0", "constraint 1: `radius` is 0"),
        ("[[constraint]]\nnormal = [1, 0]\nfrom = 2\nuntil = 1", "constraint 1: it holds from 2 s until 1 s"),
        ("[[constraint]]\nrobot = \"arm.urdf\"\nplane = [1, 0, 0]", "constraint 1: `robot` and `link` belong together"),
        ("[[constraint]]\nrobot = \"no.urdf\"\nlink = \"hand\"\nplane = [1, 0, 0]", "no.urdf: "),
        ("[[constraint]]\nrobot = \"arm.urdf\"\nlink = \"foot\"\nplane = [1, 0, 0]", "constraint 1: "),
        (
            "[[constraint]]\nrobot = \"arm.urdf\"\nlink = \"hand\"\nplane = [1, 0]",
            "constraint 1: `plane` has 2 numbers",
        ),
    ] {
        let said = said(text);
        assert!(said.contains(expected) && !said.contains('\n'), "{said}");
    }
    let one = ["x".to_owned()];
    let text = "[[constraint]]\nrobot = \"arm.urdf\"\nlink = \"hand\"\nplane = [1, 0, 0]";
    let said = ConstraintSet::from_toml(text, &one, folder.path()).unwrap_err().to_string();
    assert!(said.contains("joint 'y' moves the link but is not a channel of the state"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn constraints_act_at_right_angles_in_the_learners_units(
        angle in 0.0..TAU, scale_x in 0.2..5.0, scale_y in 0.2..5.0, x in -1.0..1.0, y in -1.0..1.0,
    ) {
        // The same movement in other units.
        let plain = toy_model();
        let mut model = plain.clone();
        for (channel, scale) in model.state.iter_mut().zip([scale_x, scale_y]) {
            (channel.scale, channel.low, channel.high, channel.median) =
                (scale, channel.low / scale, channel.high / scale, channel.median / scale);
        }
        let (a, b) = (angle.cos(), angle.sin());
        let of = |a: f64, b: f64| constraints(&format!("[[constraint]]\nnormal = [{a:?}, {b:?}]"));
        let roll_out = |constraints| RollOut { constraints, seconds: Some(20.0), ..RollOut::default() };
        let path = roll_out(of(a, b)).follow(&plain, &dvector![x, y]).unwrap();
        let other = roll_out(of(a * scale_x, b * scale_y)).follow(&model, &dvector![x / scale_x, y / scale_y]).unwrap();
        prop_assert_eq!(&path.stop, &other.stop);
        let back = DVector::from_fn(2, |k, _| last(&other)[k] * [scale_x, scale_y][k]);
        prop_assert!((last(&path) - back).norm() < 1e-9);
    }
}
