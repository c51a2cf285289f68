//! Invalid movements are refused, with the place of the fault.

use motion::{Demonstrations, MotionError, Series, Trajectory};
use nalgebra::DMatrix;

fn states(dim: usize, n_samples: usize) -> DMatrix<f64> {
    DMatrix::from_fn(dim, n_samples, |i, j| (i * 7 + j) as f64)
}

fn with(mut values: DMatrix<f64>, dimension: usize, sample: usize, value: f64) -> DMatrix<f64> {
    values[(dimension, sample)] = value;
    values
}

fn not_finite(series: Series, sample: usize, dimension: usize, value: f64) -> MotionError {
    MotionError::NotFinite { series, sample, dimension, value }
}

#[test]
fn a_trajectory() {
    for (states, time_step, expected) in [
        (states(2, 5), 0.0, MotionError::TimeStep { time_step: 0.0 }),
        (states(2, 5), -0.1, MotionError::TimeStep { time_step: -0.1 }),
        (states(2, 5), f64::INFINITY, MotionError::TimeStep { time_step: f64::INFINITY }),
        (states(0, 5), 0.1, MotionError::NoDimension),
        (states(2, 1), 0.1, MotionError::TooShort { samples: 1 }),
        (states(2, 0), 0.1, MotionError::TooShort { samples: 0 }),
        (with(states(3, 5), 2, 4, f64::INFINITY), 0.1, not_finite(Series::States, 4, 2, f64::INFINITY)),
        (with(states(3, 5), 1, 0, f64::NEG_INFINITY), 0.1, not_finite(Series::States, 0, 1, f64::NEG_INFINITY)),
    ] {
        assert_eq!(Trajectory::new(states, time_step), Err(expected));
    }
}

/// NaN differs from itself, so the fields are compared.
#[test]
fn nan() {
    assert!(matches!(
        Trajectory::new(with(states(3, 5), 1, 3, f64::NAN), 0.1),
        Err(MotionError::NotFinite { series: Series::States, sample: 3, dimension: 1, value }) if value.is_nan()
    ));
    assert!(matches!(
        Trajectory::new(states(3, 5), f64::NAN),
        Err(MotionError::TimeStep { time_step }) if time_step.is_nan()
    ));
}

#[test]
fn recorded_velocities() {
    let trajectory = Trajectory::new(states(2, 5), 0.1).unwrap();
    for (velocities, expected) in [
        (states(2, 4), MotionError::VelocityShape { states: (2, 5), velocities: (2, 4) }),
        (states(3, 5), MotionError::VelocityShape { states: (2, 5), velocities: (3, 5) }),
        (with(states(2, 5), 0, 2, f64::INFINITY), not_finite(Series::Velocities, 2, 0, f64::INFINITY)),
    ] {
        assert_eq!(trajectory.clone().with_velocities(velocities), Err(expected));
    }
}

#[test]
fn several_trajectories() {
    let trajectory = |dim| Trajectory::new(states(dim, 4), 0.1).unwrap();
    assert_eq!(Demonstrations::new(vec![]), Err(MotionError::Empty));
    assert_eq!(
        Demonstrations::new(vec![trajectory(2), trajectory(2), trajectory(3)]),
        Err(MotionError::Dimensions { trajectory: 2, found: 3, expected: 2 })
    );
    let fault = MotionError::TooShort { samples: 1 };
    assert_eq!(
        Demonstrations::from_states([states(2, 4), states(2, 1)], 0.1),
        Err(MotionError::InTrajectory { trajectory: 1, source: Box::new(fault) })
    );
}

#[test]
fn messages_name_fault_place_and_remedy() {
    let error = Demonstrations::from_states([states(2, 4), with(states(2, 4), 1, 3, f64::INFINITY)], 0.1);
    let message = error.unwrap_err().to_string();
    for part in ["trajectory 1", "states", "sample 3", "dimension 1", "inf", "drop or interpolate"] {
        assert!(message.contains(part), "{part:?} is missing in {message:?}");
    }
}
