//! What cannot be smoothed is refused, case by case.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use motion::{Demonstrations, MotionError, Series, Trajectory};
use nalgebra::{DMatrix, DVector};
use smoothing::{
    AxisScale, Fusion, NoiseVariance, PositionNoise, SavitzkyGolay, Smoother, SmoothingError, Stamped, StepRule,
};

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
    for degrees in [vec![], vec![2, 3], vec![1, 8]] {
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
fn stamps() {
    let error = Stamped::new(vec![0.0, 1.0], wave(1.0)).unwrap_err();
    assert_eq!(error, SmoothingError::Motion(MotionError::StampCount { times: 2, samples: 30 }));
    for (bad, sample) in [(2.0, 3), (f64::NAN, 3), (1.0, 3), (f64::INFINITY, 3)] {
        let mut times: Vec<f64> = (0..30).map(f64::from).collect();
        times[3] = bad;
        match Stamped::new(times, wave(1.0)).unwrap_err() {
            SmoothingError::Motion(MotionError::StampOrder { sample: found, time }) => {
                assert_eq!(found, sample);
                assert!(time == bad || time.is_nan() && bad.is_nan());
            }
            other => panic!("{other:?}"),
        }
    }
    let mut states = wave(1.0);
    states[(1, 7)] = f64::NAN;
    match Stamped::new((0..30).map(f64::from).collect(), states).unwrap_err() {
        SmoothingError::Motion(MotionError::NotFinite { series, sample, dimension, .. }) => {
            assert_eq!((series, sample, dimension), (Series::States, 7, 1));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn sets_of_movements() {
    let times = |n: usize| (0..n).map(|i| i as f64).collect::<Vec<_>>();
    let two = Stamped::new(times(30), wave(1.0)).unwrap();
    let three = Stamped::new(times(4), DMatrix::from_fn(3, 4, |j, i| (i * i + j) as f64)).unwrap();
    let (smoother, fusion) = (Smoother::default(), Fusion::default());
    assert_eq!(smoother.smooth_stamped(&[]).unwrap_err(), MotionError::Empty.into());
    assert_eq!(fusion.fuse_stamped(&[]).unwrap_err(), MotionError::Empty.into());
    let differ = SmoothingError::Motion(MotionError::Dimensions { trajectory: 1, found: 3, expected: 2 });
    assert_eq!(smoother.smooth_stamped(&[two.clone(), three.clone()]).unwrap_err(), differ);
    assert_eq!(fusion.fuse_stamped(&[two.clone(), three]).unwrap_err(), differ);
    let with = two.clone().with_velocities(wave(1.0)).unwrap();
    assert_eq!(fusion.fuse_stamped(&[with, two]).unwrap_err(), SmoothingError::NoVelocities { trajectory: 1 });
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

/// The shortest movements that there are go through.
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
