//! Noise affects the observations, not the truth.

use demo_gen::{DemoGenError, Recording, ToySystem, with_position_noise};
use motion::{MotionError, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn recordings(n_trajectories: usize, seed: u64) -> Vec<Recording> {
    let system = ToySystem { n_trajectories, n_samples: 25, ..ToySystem::default() };
    system.record(&mut ChaCha8Rng::seed_from_u64(seed)).expect("a valid toy system")
}

fn noisy(clean: &[Recording], share: f64, seed: u64) -> Vec<Recording> {
    with_position_noise(clean, share, &mut ChaCha8Rng::seed_from_u64(seed)).expect("a valid share")
}

/// All values of one dimension, of all trajectories.
fn row(recordings: &[Recording], dimension: usize, of: fn(&Recording) -> DMatrix<f64>) -> DVector<f64> {
    let values =
        recordings.iter().flat_map(|recording| of(recording).row(dimension).iter().copied().collect::<Vec<_>>());
    DVector::from_vec(values.collect())
}

fn noise_of(recording: &Recording) -> DMatrix<f64> {
    recording.observed.states() - &recording.truth.states
}

proptest! {
    #[test]
    fn only_positions_are_touched(share in 0.001..1.0f64, seeds in any::<(u64, u64)>(), n_trajectories in 1..5usize) {
        let clean = recordings(n_trajectories, seeds.0);
        let seen = noisy(&clean, share, seeds.1);
        prop_assert_eq!(&seen, &noisy(&clean, share, seeds.1));
        prop_assert_eq!(&clean, &noisy(&clean, 0.0, seeds.1));
        prop_assert_eq!(&seen, &noisy(&seen, share, seeds.1), "noise does not add up");
        let double = noisy(&clean, 2.0 * share, seeds.1);
        for ((clean, seen), double) in clean.iter().zip(&seen).zip(&double) {
            prop_assert_eq!(&seen.truth, &clean.truth);
            prop_assert_eq!(seen.observed.velocities(), clean.observed.velocities());
            prop_assert_eq!(seen.observed.time_step(), clean.observed.time_step());
            prop_assert!(noise_of(seen).amin() > 0.0);
            prop_assert!((noise_of(double) - 2.0 * noise_of(seen)).amax() < 1e-13);
        }
    }

    #[test]
    fn noise_is_proportional_to_each_dimensions_spread(share in 0.01..1.0f64, seed in any::<u64>(), stretch in 0.1..10.0f64) {
        let mut clean = recordings(200, seed);
        for recording in &mut clean {
            // Changes the unit of the second dimension.
            recording.truth.states.row_mut(1).scale_mut(stretch);
        }
        let seen = noisy(&clean, share, seed);
        for dimension in 0..2 {
            let noise = row(&seen, dimension, noise_of);
            let spread = row(&clean, dimension, |recording| recording.truth.states.clone()).variance().sqrt();
            // For 5000 values the standard errors are 1 % of the deviation and 1.4 % of the mean; six of them are
            // allowed.
            prop_assert!((noise.variance().sqrt() / (share * spread) - 1.0).abs() < 0.06);
            prop_assert!(noise.mean().abs() < 0.085 * share * spread);
        }
    }
}

#[test]
fn a_recording_without_velocities_stays_without() {
    let mut clean = recordings(2, 1);
    clean[1].observed = Trajectory::new(clean[1].truth.states.clone(), 0.5).unwrap();
    let seen = noisy(&clean, 0.1, 2);
    assert!(seen[0].observed.velocities().is_some());
    assert_eq!((seen[1].observed.velocities(), seen[1].observed.time_step()), (None, 0.5));
}

#[test]
fn bad_noise_is_refused() {
    let clean = recordings(2, 1);
    let mut unlike = recordings(3, 1);
    unlike[2].truth.states = DMatrix::zeros(3, 25);
    let cases = [
        (&clean[..], -0.1, DemoGenError::NoiseShare { share: -0.1 }),
        (&clean[..], f64::INFINITY, DemoGenError::NoiseShare { share: f64::INFINITY }),
        (&[][..], 0.1, DemoGenError::NoTrajectory),
        (&unlike[..], 0.1, MotionError::Dimensions { trajectory: 2, found: 3, expected: 2 }.into()),
    ];
    for (recordings, share, expected) in cases {
        let found = with_position_noise(recordings, share, &mut ChaCha8Rng::seed_from_u64(1)).unwrap_err();
        assert_eq!(found, expected);
    }
    assert!(with_position_noise(&clean, f64::NAN, &mut ChaCha8Rng::seed_from_u64(1)).is_err());
}
