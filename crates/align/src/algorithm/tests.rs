//! Alignment with and without H gives the same result.

use super::*;
use demo_gen::tasks::CyclesWithTask;
use demo_gen::{
    Grasp, HandInPlane, Recording, Redraw, ThreeLinkArm, ToyPotential, ToySystem, UpperBody, demonstrations,
};
use nalgebra::DMatrix;
use proptest::collection::vec;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Aligns with and without H, and compares: all bits of σ², groups, λ₂; offsets up to the error that λ₂ allows.
fn both(learner: &PolicyAlign, demonstrations: &Demonstrations) {
    let dense = learner.align_with(&|_, _| false, demonstrations).unwrap();
    let sparse = learner.align_with(&|_, _| true, demonstrations).unwrap();
    assert!(dense.objective().is_some() && sparse.objective().is_none());
    assert_eq!(dense.sigma_squared().to_bits(), sparse.sigma_squared().to_bits());
    assert_eq!(dense.kept(), sparse.kept());
    assert_eq!(dense.groups(), sparse.groups());
    let (Some(lambda_2), Some(found)) = (dense.lambda_2(), sparse.lambda_2()) else {
        return assert_eq!(dense.lambda_2(), sparse.lambda_2());
    };
    assert!((found - lambda_2).abs() <= 1e-4 * lambda_2, "{found:e} {lambda_2:e}");
    let size = dense.potentials.iter().flatten().fold(0.0_f64, |size, value| size.max(value.abs()));
    let miss = (dense.offsets() - sparse.offsets()).amax();
    assert!(miss <= 1e-13 * (size + dense.offsets().amax()), "{miss:e} at {lambda_2:e}");
}

#[test]
fn sparse_alignment_matches_dense_on_toy_systems() {
    for (n_trajectories, n_samples) in [(40, 40), (100, 100)] {
        for potential in [ToyPotential::parabola(), ToyPotential::sinusoidal()] {
            for seed in 0..50 {
                let toy = ToySystem {
                    n_trajectories,
                    n_samples,
                    potential: potential.clone(),
                    redraw: Redraw::Every(20),
                    ..ToySystem::default()
                };
                let recordings = toy.record(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
                both(&PolicyAlign::default(), &demonstrations(&recordings).unwrap());
            }
        }
    }
}

/// Runs two data sets of an experiment, or `SETS`; `record` makes one.
fn sets(record: impl Fn(&mut ChaCha8Rng) -> Vec<Recording>) {
    for seed in 0..std::env::var("SETS").map_or(2, |sets| sets.parse().expect("a number of data sets")) {
        let recordings = record(&mut ChaCha8Rng::seed_from_u64(seed));
        both(&PolicyAlign::default(), &demonstrations(&recordings).unwrap());
    }
}

fn upper_body() -> UpperBody {
    let urdf = include_str!("../../../../robots/asimo_upper_body.urdf");
    let srdf = include_str!("../../../../robots/asimo_upper_body.srdf");
    UpperBody::new(urdf, srdf).unwrap()
}

#[test]
fn sparse_alignment_matches_dense_on_grasps() {
    let grasp = Grasp::new(upper_body());
    sets(|rng| grasp.record(rng).unwrap());
}

#[test]
fn sparse_alignment_matches_dense_on_22_joint_bodies() {
    let body = HandInPlane::new(upper_body());
    sets(|rng| body.record(rng).unwrap());
}

#[test]
fn sparse_alignment_matches_dense_on_three_link_arms() {
    let arm = ThreeLinkArm::new(include_str!("../../../../robots/planar_three_link.urdf")).unwrap();
    sets(|rng| arm.record(rng).unwrap());
}

#[test]
fn sparse_alignment_matches_dense_on_cycles_with_a_task() {
    sets(|rng| CyclesWithTask::default().record(rng).unwrap());
}

#[test]
fn sparse_alignment_matches_dense_on_many_movements() {
    let toy = ToySystem { n_trajectories: 500, n_samples: 60, ..ToySystem::default() };
    let recordings = toy.record(&mut ChaCha8Rng::seed_from_u64(3)).unwrap();
    both(&PolicyAlign::default(), &demonstrations(&recordings).unwrap());
}

#[test]
fn sparse_alignment_splits_a_long_chain() {
    // Neighbours are linked by 1e4 thresholds or more, but λ₂ is smaller by (π / 760)².
    let mut x = 0.0;
    let movements = (0..760).map(|k| {
        x += 1.0 + 0.01 * (f64::from(k) * 0.7).sin();
        DMatrix::from_row_slice(1, 2, &[x, x])
    });
    let demonstrations = Demonstrations::from_states(movements.collect::<Vec<_>>(), 1.0).unwrap();
    let bandwidth = Bandwidth::Fixed(0.1);
    let learner = PolicyAlign { bandwidth, eigenvalue_threshold: 6e-7, ..PolicyAlign::default() };
    both(&learner, &demonstrations);
    assert_eq!(learner.align(&demonstrations).unwrap().kept().len(), 380);
}

#[test]
fn results_are_bitwise_equal_for_any_thread_count() {
    let toy = ToySystem { n_trajectories: 400, n_samples: 50, ..ToySystem::default() };
    let demonstrations = demonstrations(&toy.record(&mut ChaCha8Rng::seed_from_u64(7)).unwrap()).unwrap();
    let aligned = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| PolicyAlign::default().align(&demonstrations).unwrap())
    };
    let one = aligned(1);
    assert!(one.objective().is_none() && one.kept().len() > 300);
    assert_eq!(one, aligned(2));
    assert_eq!(one, aligned(5));
}

#[test]
fn sparse_alignment_names_touching_pairs() {
    // Two of three movements meet at a sample, and so do two others.
    let at = |x: f64| DMatrix::from_row_slice(2, 3, &[x, x + 1.0, x + 2.0, 0.0, x, 0.5]);
    let movements = [at(0.0), at(0.0), at(3.0), at(7.0), at(7.0)];
    let demonstrations = Demonstrations::from_states(movements, 1.0).unwrap();
    let error = |sparse| PolicyAlign::default().align_with(&|_, _| sparse, &demonstrations).unwrap_err();
    let AlignError::ZeroBandwidth { pairs, usable: Some(_) } = error(true) else { panic!("{}", error(true)) };
    assert_eq!(pairs, [(0, 1), (3, 4)]);
    assert_eq!(error(true), error(false));
    let single = Demonstrations::from_states([at(0.0)], 1.0).unwrap();
    assert_eq!(PolicyAlign::default().align_with(&|_, _| true, &single), Err(AlignError::SingleTrajectory));
}

#[test]
fn too_many_samples_for_the_memory_are_refused() {
    let toy = ToySystem { n_trajectories: MANY, n_samples: 20, ..ToySystem::default() };
    let demonstrations = demonstrations(&toy.record(&mut ChaCha8Rng::seed_from_u64(1)).unwrap()).unwrap();
    let error = PolicyAlign { memory_limit: 10_000, ..PolicyAlign::default() }.align(&demonstrations).unwrap_err();
    let AlignError::Memory { needed, limit: 10_000 } = error else { panic!("{error}") };
    // States, places and boxes alone take 16 + 8 + 4 bytes per sample.
    assert!((28 * 20 * MANY as u64..1_000_000).contains(&needed), "{needed}");
}

proptest! {
    #[test]
    fn sparse_alignment_matches_dense_on_random_movements(
        dim in 1usize..5, lengths in vec(2usize..30, 2..40), seed in any::<u64>(), exponent in -3.0..0.5_f64, narrow in any::<bool>(),
    ) {
        use rand::RngExt as _;
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let movements: Vec<DMatrix<f64>> = lengths.iter().map(|&n| {
            DMatrix::from_fn(dim, n, |_, _| rng.random_range(-1.0..1.0))
        }).collect();
        let bandwidth = if narrow { Bandwidth::Narrow } else { Bandwidth::Fixed(10.0_f64.powf(exponent)) };
        let learner = PolicyAlign { bandwidth, ..PolicyAlign::default() };
        both(&learner, &Demonstrations::from_states(movements, 1.0).unwrap());
    }
}
