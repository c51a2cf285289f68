//! Held-out samples: their number, their movements, and reproducibility with a seed.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use motion::{Demonstrations, MotionError, SampleIndex, SampleSet};
use nalgebra::DMatrix;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn demonstrations(lengths: &[usize]) -> Demonstrations {
    Demonstrations::from_states(lengths.iter().map(|&n| DMatrix::zeros(1, n)), 1.0).unwrap()
}

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn share(count: usize, fraction: f64) -> usize {
    ((count as f64 * fraction).floor() as usize).max(1)
}

proptest! {
    #[test]
    fn a_share_of_the_samples_of_some_trajectories(
        lengths in prop::collection::vec(2usize..9, 1..7), named in prop::collection::vec(any::<prop::sample::Index>(), 1..9),
        fraction in 0.001..0.999f64, seed in any::<u64>(),
    ) {
        let demonstrations = demonstrations(&lengths);
        let named: Vec<usize> = named.iter().map(|index| index.index(lengths.len())).collect();
        let all = demonstrations.samples_of(&named);
        let expected = (0..lengths.len()).filter(|trajectory| named.contains(trajectory));
        let expected = expected.flat_map(|trajectory| (0..lengths[trajectory]).map(move |sample| SampleIndex { trajectory, sample }));
        prop_assert_eq!(&all, &expected.collect::<Vec<_>>());

        let held_out = demonstrations.hold_out_samples(&named, fraction, &mut rng(seed)).unwrap();
        prop_assert_eq!(held_out.len(), share(all.len(), fraction));
        prop_assert!(held_out.windows(2).all(|pair| pair[0] < pair[1]) && held_out.iter().all(|at| all.contains(at)));
        prop_assert_eq!(&held_out, &demonstrations.hold_out_samples(&named, fraction, &mut rng(seed)).unwrap());

        let backwards: Vec<_> = held_out.iter().rev().chain(&held_out[..1]).copied().collect();
        let set = SampleSet::of(&backwards);
        prop_assert!(all.iter().all(|&at| set.contains(at) == held_out.contains(&at)));
    }

    #[test]
    fn a_share_of_whole_movements(
        lengths in prop::collection::vec(2usize..9, 1..12), fraction in 0.001..0.999f64, seed in any::<u64>(),
    ) {
        let demonstrations = demonstrations(&lengths);
        let held_out = demonstrations.hold_out_trajectories(fraction, &mut rng(seed)).unwrap();
        let mut trajectories: Vec<usize> = held_out.iter().map(|at| at.trajectory).collect();
        trajectories.dedup();
        prop_assert_eq!(trajectories.len(), share(lengths.len(), fraction));
        prop_assert_eq!(held_out, demonstrations.samples_of(&trajectories));
    }
}

#[test]
fn another_seed_holds_out_others() {
    let demonstrations = demonstrations(&[50; 40]);
    let of = |seed| demonstrations.hold_out_samples(&[3, 7], 0.3, &mut rng(seed)).unwrap();
    assert_ne!(of(1), of(2));
    let of = |seed| demonstrations.hold_out_trajectories(0.3, &mut rng(seed)).unwrap();
    assert_ne!(of(1), of(2));
}

#[test]
fn shares_out_of_range_and_nothing_at_all_are_refused() {
    let demonstrations = demonstrations(&[3, 4]);
    for fraction in [0.0, 1.0, -0.1, 1.5, f64::INFINITY] {
        let expected = MotionError::Fraction { fraction };
        assert_eq!(demonstrations.hold_out_samples(&[0], fraction, &mut rng(1)), Err(expected.clone()));
        assert_eq!(demonstrations.hold_out_trajectories(fraction, &mut rng(1)), Err(expected));
    }
    assert!(matches!(
        demonstrations.hold_out_trajectories(f64::NAN, &mut rng(1)),
        Err(MotionError::Fraction { fraction }) if fraction.is_nan()
    ));
    assert_eq!(demonstrations.hold_out_samples(&[], 0.5, &mut rng(1)), Err(MotionError::Empty));
}
