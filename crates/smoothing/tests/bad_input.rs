//! Invalid input is refused, case by case.

use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use smoothing::{AxisScale, Fusion, NoiseVariance, PositionNoise, SavitzkyGolay, Smoother, SmoothingError, StepRule};

fn wave(scale: f64) -> DMatrix<f64> {
    DMatrix::from_fn(2, 30, |j, i| scale * (0.2 * i as f64 + j as f64).sin())
}

fn demonstrations(states: DMatrix<f64>) -> Demonstrations {
    Demonstrations::from_states([states], 0.1).unwrap()
}

fn with_velocities(states: DMatrix<f64>, velocities: DMatrix<f64>) -> Demonstrations {
    Demonstrations::new(vec![Trajectory::new(states, 0.1).unwrap().with_velocities(velocities).unwrap()]).unwrap()
}

fn refuses(smoother: &Smoother, field: &str) {
    match smoother.smooth(&demonstrations(wave(1.0))) {
        Err(SmoothingError::Parameter { name, .. }) => assert_eq!(name, field),
        other => panic!("{field}: {other:?}"),
    }
}

#[test]
fn parameters_of_the_smoother() {
    let plain = Smoother::default();
    let empty = Smoother { degrees: vec![], ..plain.clone() };
    assert_eq!(empty.smooth(&demonstrations(wave(1.0))).unwrap_err(), SmoothingError::NoDegrees);
    for degrees in [vec![2, 3], vec![1, 8]] {
        refuses(&Smoother { degrees, ..plain.clone() }, "degrees");
    }
    for longest_window in [0, 1, 2] {
        refuses(&Smoother { longest_window, ..plain.clone() }, "longest_window");
    }
    for switch_probability in [0.0, 1.0, -0.1, f64::NAN] {
        refuses(&Smoother { switch_probability, ..plain.clone() }, "switch_probability");
    }
    for noise in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        refuses(&Smoother { noise: NoiseVariance::Given(noise), ..plain.clone() }, "noise");
    }
    for scale in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        refuses(
            &Smoother { axis_scale: AxisScale::Given(DVector::from_vec(vec![1.0, scale])), ..plain.clone() },
            "axis_scale",
        );
    }
    let three = Smoother { axis_scale: AxisScale::Given(DVector::from_element(3, 1.0)), ..plain };
    let error = three.smooth(&demonstrations(wave(1.0))).unwrap_err();
    assert_eq!(error, SmoothingError::AxisScales { found: 3, expected: 2 });
}

#[test]
fn movements_that_do_not_move_or_overflow() {
    let smooth = |states| Smoother::default().smooth(&demonstrations(states));
    assert_eq!(smooth(DMatrix::from_element(2, 30, 0.1)).unwrap_err(), SmoothingError::NoMotion);
    assert_eq!(smooth(wave(1e200)).unwrap_err(), SmoothingError::Overflow);
    let noise = |states| PositionNoise::of(&demonstrations(states));
    assert_eq!(noise(DMatrix::from_element(2, 60, 0.1)).unwrap_err(), SmoothingError::NoMotion);
    let long = |scale| DMatrix::from_fn(2, 60, |j, i| scale * (0.2 * i as f64 + j as f64).sin());
    assert_eq!(noise(long(1e200)).unwrap_err(), SmoothingError::Overflow);
    assert_eq!(noise(wave(1.0)).unwrap_err(), SmoothingError::TooFewDifferences { found: 27, needed: 50 });
    let fuse = |states: DMatrix<f64>| Fusion::default().fuse(&with_velocities(states.clone(), states));
    assert_eq!(fuse(wave(1e200)).unwrap_err(), SmoothingError::Overflow);
}

#[test]
fn fusion_needs_velocities() {
    let without = Trajectory::new(wave(1.0), 1.0).unwrap();
    let with = without.clone().with_velocities(wave(1.0)).unwrap();
    let error = Fusion::default().fuse(&Demonstrations::new(vec![with, without]).unwrap()).unwrap_err();
    assert_eq!(error, SmoothingError::NoVelocities { trajectory: 1 });
}

#[test]
fn parameters_of_fusion_and_filter() {
    let recorded = with_velocities(wave(1.0), wave(1.0));
    let refuses = |fusion: Fusion, field: &str| match fusion.fuse(&recorded) {
        Err(SmoothingError::Parameter { name, .. }) => assert_eq!(name, field),
        other => panic!("{field}: {other:?}"),
    };
    refuses(Fusion { rules: vec![], ..Fusion::default() }, "rules");
    refuses(Fusion { log10_ratios: vec![], ..Fusion::default() }, "log10_ratios");
    refuses(Fusion { log10_ratios: vec![f64::NAN], rules: vec![StepRule::Euler] }, "log10_ratios");
    refuses(Fusion { log10_ratios: vec![-1.0, 301.0], ..Fusion::default() }, "log10_ratios");
    for (window, degree) in [(4, 2), (0, 0), (3, 3), (1, 2)] {
        match (SavitzkyGolay { window, degree }).smooth(&recorded) {
            Err(SmoothingError::Parameter { name, .. }) => assert_eq!(name, "window"),
            other => panic!("{other:?}"),
        }
    }
}

/// The shortest possible movements are accepted.
#[test]
fn two_samples() {
    let states = DMatrix::from_row_slice(1, 2, &[0.0, 1.0]);
    let recorded = with_velocities(states.clone(), DMatrix::from_element(1, 2, 10.0));
    let exact = Smoother { noise: NoiseVariance::Given(1e-12), ..Smoother::default() };
    let smoothed = exact.smooth(&recorded).unwrap();
    assert!((smoothed.movements[0].velocities[0] - 10.0).abs() < 1e-6, "{smoothed:?}");
    assert!(Smoother::default().smooth(&recorded).unwrap().movements[0].velocities[0] > 0.0);
    let fused = Fusion::default().fuse(&recorded).unwrap();
    assert!((&fused.movements[0].states - &states).amax() < 1e-12, "{fused:?}");
    let filtered = SavitzkyGolay::default().smooth(&recorded).unwrap();
    assert!((filtered.trajectories()[0].states() - states).amax() < 1e-14);
}
