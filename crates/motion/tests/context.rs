//! A movement keeps its context when its states change.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use motion::{Demonstrations, MotionError, Trajectory, is_called_context};
use nalgebra::{DMatrix, DVector, dvector};

fn movement() -> Trajectory {
    Trajectory::new(DMatrix::from_fn(2, 4, |axis, i| (axis + i) as f64), 0.1).unwrap()
}

#[test]
fn context_is_kept_when_states_change() {
    let with =
        movement().with_velocities(DMatrix::repeat(2, 4, 1.0)).unwrap().with_context(dvector![3.0, -1.0, 2.0]).unwrap();
    assert_eq!(with.state_in_context(1), dvector![1.0, 2.0, 3.0, -1.0, 2.0]);
    assert_eq!(with.dim(), 2);
    assert_eq!(with.with_states(DMatrix::zeros(2, 4)).unwrap().context(), with.context());
    assert_eq!(with.scaled(&dvector![2.0, 5.0]).unwrap().context(), with.context());
    assert_eq!(movement().context().len(), 0);
    assert_eq!(movement().state_in_context(1), dvector![1.0, 2.0]);
}

#[test]
fn contexts_must_be_finite_and_of_equal_length() {
    let wrong = movement().with_context(dvector![1.0, f64::INFINITY]).unwrap_err();
    assert_eq!(wrong, MotionError::ContextNotFinite { number: 1, value: f64::INFINITY });
    assert!(!wrong.to_string().contains("sample"), "{wrong}");
    let alike = |p: usize| movement().with_context(DVector::zeros(p)).unwrap();
    let wrong = Demonstrations::new(vec![alike(2), alike(2), alike(1)]).unwrap_err();
    assert_eq!(wrong, MotionError::ContextDimensions { trajectory: 2, found: 1, expected: 2 });
    assert_eq!(Demonstrations::new(vec![alike(2), alike(2)]).unwrap().context_dim(), 2);
}

#[test]
fn names_of_goals_and_loads_are_known() {
    for name in [
        "goal_x",
        "Goal[0]",
        "target.position.x",
        "goal1",
        "observation.environment_state_1",
        "load (kg)",
        "object y",
        "mass",
    ] {
        assert!(is_called_context(name), "{name}");
    }
    for name in ["x", "q1", "joint_goalie", "observation.state_0", "loaded", "z", "subject"] {
        assert!(!is_called_context(name), "{name}");
    }
}
