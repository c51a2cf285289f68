//! Noise of positions by third differences.

use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::collection::vec;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use smoothing::{PositionNoise, VelocityNoise};

/// The literal formulas: the median of all sorted differences; the mean of all steps.
fn literal(demonstrations: &Demonstrations) -> (Vec<f64>, f64) {
    let mut steps = Vec::new();
    let mut differences = vec![Vec::new(); demonstrations.dim()];
    for trajectory in demonstrations.trajectories() {
        let x = trajectory.states();
        for i in 0..x.ncols() - 1 {
            steps.push((x.column(i + 1) - x.column(i)).norm_squared());
        }
        for i in 0..x.ncols().saturating_sub(3) {
            for (j, all) in differences.iter_mut().enumerate() {
                all.push((x[(j, i + 3)] - 3.0 * x[(j, i + 2)] + 3.0 * x[(j, i + 1)] - x[(j, i)]).abs());
            }
        }
    }
    let deviations: Vec<f64> = differences
        .iter_mut()
        .map(|all| {
            all.sort_by(f64::total_cmp);
            let (n, middle) = (all.len(), all.len() / 2);
            let median = if n % 2 == 1 { all[middle] } else { f64::midpoint(all[middle - 1], all[middle]) };
            1.4826 * median / 20f64.sqrt()
        })
        .collect();
    let noise: f64 = deviations.iter().map(|deviation| deviation * deviation).sum();
    let share = 2.0 * noise / (steps.iter().sum::<f64>() / steps.len() as f64);
    (deviations, share)
}

fn movements() -> impl Strategy<Value = Vec<DMatrix<f64>>> {
    (1..4usize, vec(2..30usize, 1..4)).prop_flat_map(|(dim, mut lengths)| {
        lengths.push(53);
        let total: usize = lengths.iter().sum();
        vec(-1.0..1.0f64, dim * total).prop_map(move |numbers| {
            let mut from = 0;
            lengths
                .iter()
                .map(|&n| {
                    from += n * dim;
                    DMatrix::from_column_slice(dim, n, &numbers[from - n * dim..from])
                })
                .collect()
        })
    })
}

proptest! {
    #[test]
    fn the_estimate_is_the_formula(movements in movements()) {
        let demonstrations = Demonstrations::from_states(movements, 1.0).unwrap();
        let noise = PositionNoise::of(&demonstrations).unwrap();
        let (deviations, share) = literal(&demonstrations);
        for (ours, theirs) in noise.deviations.iter().zip(deviations) {
            prop_assert!((ours - theirs).abs() <= 1e-12 * theirs);
        }
        prop_assert!((noise.step_share - share).abs() <= 1e-12 * share);
    }

    /// Adding a parabola to every movement changes no estimate; estimates scale with the units.
    #[test]
    fn parabolas_are_no_noise(movements in movements(), factors in vec(-1.0..1.0f64, 3), unit in 0.01..100.0f64) {
        let curved = movements.iter().map(|x| {
            DMatrix::from_fn(x.nrows(), x.ncols(), |j, i| {
                let t = i as f64 / 10.0;
                unit * (x[(j, i)] + factors[0] + factors[1] * t + factors[2] * t * t)
            })
        });
        let curved = Demonstrations::from_states(curved.collect::<Vec<_>>(), 1.0).unwrap();
        let plain = Demonstrations::from_states(movements, 1.0).unwrap();
        let (curved, plain) = (PositionNoise::of(&curved).unwrap(), PositionNoise::of(&plain).unwrap());
        prop_assert!((curved.deviations - unit * &plain.deviations).amax() <= 1e-11 * unit * plain.deviations.amax());
    }
}

/// Smooth movements whose direction jumps every 20 samples, with known noise per dimension: it is found within 15 %.
#[test]
fn noise_is_found_beside_movement_and_switches() {
    let truth = DVector::from_vec(vec![0.002, 0.03]);
    for seed in 0..5 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let movements = (0..40).map(|k| {
            DMatrix::from_fn(2, 40, |j, i| {
                let t = i as f64 / 40.0;
                let path = f64::from(k).sin() + (2.0 * t + j as f64).cos() + if i < 20 { 0.0 } else { t - 0.5 };
                path + truth[j] * Distribution::<f64>::sample(&StandardNormal, &mut rng)
            })
        });
        let demonstrations = Demonstrations::from_states(movements.collect::<Vec<_>>(), 0.1).unwrap();
        let noise = PositionNoise::of(&demonstrations).unwrap();
        for j in 0..2 {
            let ratio = noise.deviations[j] / truth[j];
            assert!((ratio - 1.0).abs() < 0.15, "seed {seed}, dimension {j}: {ratio}");
        }
        assert!((0.3..1.05).contains(&noise.step_share), "{}", noise.step_share);
    }
}

/// Uneven stamps are not noise: an unevenly sampled parabola is exact, and white noise on it is estimated correctly.
#[test]
fn uneven_stamps_are_no_noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
    let times: Vec<f64> = (0..2000).map(|i| 0.1 * (f64::from(i) + 0.2 * draw().clamp(-2.0, 2.0))).collect();
    let of = |noise: &mut dyn FnMut() -> f64| {
        let states = DMatrix::from_fn(1, times.len(), |_, i| 3.0 * times[i] - 0.2 * times[i].powi(2) + noise());
        let trajectory = Trajectory::new(states, 0.1).unwrap().with_times(times.clone()).unwrap();
        PositionNoise::of(&Demonstrations::new(vec![trajectory]).unwrap()).unwrap().deviations[0]
    };
    assert!(of(&mut || 0.0) < 1e-9);
    let seen = of(&mut || 0.01 * draw());
    assert!((seen / 0.01 - 1.0).abs() < 0.05, "{seen}");
}

proptest! {
    /// White noise of known size is found on velocities that hardly change direction; without velocities there is no estimate.
    #[test]
    fn noise_of_velocities_is_found(seed in any::<u64>(), deviation in 0.01..1.0f64, dim in 1..4usize) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let states = DMatrix::zeros(dim, 800);
        let bare = Trajectory::new(states, 0.1).unwrap();
        let velocities = DMatrix::from_fn(dim, 800, |axis, at| {
            let noise: f64 = StandardNormal.sample(&mut rng);
            (0.001 * at as f64 + axis as f64).sin() + deviation * noise
        });
        let power = velocities.norm_squared() / 800.0;
        prop_assert_eq!(VelocityNoise::of(&Demonstrations::new(vec![bare.clone()]).unwrap()), None);
        let found = VelocityNoise::of(&Demonstrations::new(vec![bare.with_velocities(velocities).unwrap()]).unwrap()).unwrap();
        let expected = dim as f64 * deviation * deviation;
        prop_assert!((0.7..1.4).contains(&(found.variance / expected)), "{} for {expected}", found.variance);
        prop_assert!((found.share - found.variance / power).abs() < 1e-12 * found.share);
        prop_assert!(found.white && !found.is_negligible());
    }
}

proptest! {
    /// Noise of a thousandth of the velocities counts. Movement alone, as seen by third differences, does not count if a revolution has
    /// at least ten samples; with fewer it looks like noise.
    #[test]
    fn movement_is_not_white(
        seed in any::<u64>(),
        deviation in 1.5e-3..0.03f64,
        samples_a_turn in 10.0..100.0f64,
        dim in 1..4usize,
        uneven in 0.0..0.3f64,
    ) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
        let times: Vec<f64> = (0..800).map(|at| 0.1 * (f64::from(at) + uneven * draw().clamp(-1.5, 1.5))).collect();
        let clean = DMatrix::from_fn(dim, 800, |axis, at| {
            2f64.sqrt() * (std::f64::consts::TAU * 10.0 * times[at] / samples_a_turn + axis as f64).sin()
        });
        let noisy = clean.map(|value| value + deviation * draw());
        let found = |velocities| {
            let bare = Trajectory::new(DMatrix::zeros(dim, 800), 0.1).unwrap().with_times(times.clone()).unwrap();
            VelocityNoise::of(&Demonstrations::new(vec![bare.with_velocities(velocities).unwrap()]).unwrap()).unwrap()
        };
        let (clean, noisy) = (found(clean), found(noisy));
        prop_assert!(!clean.white, "{clean:?}");
        let expected = dim as f64 * deviation * deviation;
        // With fast rotation, the estimate exceeds the noise.
        prop_assert!(noisy.variance > 0.7 * expected, "{noisy:?} for {expected}");
        if noisy.variance < 1.3 * expected {
            prop_assert!(noisy.white && !noisy.is_negligible(), "{noisy:?}");
        }
    }
}
