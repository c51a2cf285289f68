//! Movements with a time stamp for every sample.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use motion::{MotionError, Trajectory};
use nalgebra::DMatrix;
use proptest::prelude::*;

fn movement(states: &[f64], time_step: f64) -> Trajectory {
    Trajectory::new(DMatrix::from_row_slice(1, states.len(), states), time_step).unwrap()
}

proptest! {
    /// Even stamps, starting at any time, change no bit.
    #[test]
    fn even_stamps_change_nothing(
        states in prop::collection::vec(-3.0..3.0f64, 2..40), time_step in 1e-3..10.0f64, from in -5.0..5.0f64,
    ) {
        let even = movement(&states, time_step);
        let times = (0..states.len()).map(|i| from + time_step * i as f64).collect();
        let stamped = even.clone().with_times(times).unwrap();
        prop_assert_eq!(&stamped, &even);
        prop_assert_eq!(stamped.step_velocities(), (even.states().columns(1, states.len() - 1) - even.states().columns(0, states.len() - 1)) / time_step);
        prop_assert_eq!(stamped.times(), None);
        prop_assert_eq!(stamped.seconds(0, 1), time_step);
    }

    /// Stamps far from 0 are recognised as even, although the step between the first two has lost digits.
    #[test]
    fn even_stamps_are_recognised(count in 2usize..2000, milliseconds in 1u32..1000, from in -1e5..1e5f64) {
        let step = f64::from(milliseconds) / 1000.0;
        let times = (0..count).map(|i| from + step * i as f64).collect();
        let stamped = Trajectory::stamped(times, DMatrix::from_fn(1, count, |_, i| i as f64)).unwrap();
        prop_assert_eq!(stamped.times(), None);
        prop_assert!((stamped.time_step() / step - 1.0).abs() < 1e-6);
    }

    #[test]
    fn every_step_has_its_own_time(
        (states, gaps) in (3usize..40).prop_flat_map(|n| (
            prop::collection::vec(-3.0..3.0f64, n), prop::collection::vec(0.01..2.0f64, n - 1),
        )),
        from in -5.0..5.0f64, time_step in 3.0..4.0f64,
    ) {
        let mut times = vec![from];
        for gap in &gaps {
            times.push(times[times.len() - 1] + gap);
        }
        let stamped = movement(&states, time_step).with_times(times.clone()).unwrap();
        let velocities = stamped.step_velocities();
        for i in 0..gaps.len() {
            let seconds = times[i + 1] - times[i];
            prop_assert_eq!(stamped.seconds(i, i + 1), seconds);
            prop_assert_eq!(velocities[(0, i)], (states[i + 1] - states[i]) / seconds);
        }
        prop_assert_eq!(stamped.seconds(0, gaps.len()), times[gaps.len()] - from);
        prop_assert_eq!(stamped.times(), Some(&times[..]));
        let shorter = gaps.iter().filter(|&&gap| gap < stamped.time_step() * (1.0 - 1e-9)).count();
        prop_assert_eq!(shorter, gaps.len() / 2);
        let with_velocities = stamped.clone().with_velocities(stamped.states().clone()).unwrap();
        prop_assert_eq!(with_velocities.times(), Some(&times[..]));
    }
}

#[test]
fn invalid_stamps_are_refused() {
    let movement = movement(&[0.0, 1.0, 3.0], 0.1);
    let refused = |times: &[f64]| movement.clone().with_times(times.to_vec()).unwrap_err();
    assert_eq!(refused(&[0.0, 1.0]), MotionError::StampCount { times: 2, samples: 3 });
    assert_eq!(refused(&[0.0, 1.0, 1.0]), MotionError::StampOrder { sample: 2, time: 1.0 });
    assert_eq!(refused(&[0.0, -1.0, 1.0]), MotionError::StampOrder { sample: 1, time: -1.0 });
    assert_eq!(refused(&[f64::NEG_INFINITY, 0.0, 1.0]), MotionError::StampOrder { sample: 0, time: f64::NEG_INFINITY });
    assert!(matches!(refused(&[0.0, f64::NAN, 1.0]), MotionError::StampOrder { sample: 1, .. }));
}
