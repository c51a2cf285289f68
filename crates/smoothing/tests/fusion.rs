//! Compares fusion with a dense least-squares solution, and checks its estimates.

use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::collection::vec;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use smoothing::{Fused, Fusion, StepRule};

/// Steps by the printed formulas.
fn steps(rule: StepRule, times: &[f64], v: &DMatrix<f64>) -> DMatrix<f64> {
    let n = v.ncols();
    DMatrix::from_fn(v.nrows(), n - 1, |j, i| {
        let v = |i: usize| v[(j, i)];
        let mean = match rule {
            StepRule::Euler => v(i),
            StepRule::Cubic if n > 2 && i == 0 => (5.0 * v(0) + 8.0 * v(1) - v(2)) / 12.0,
            StepRule::Cubic if n > 2 && i == n - 2 => (5.0 * v(n - 1) + 8.0 * v(n - 2) - v(n - 3)) / 12.0,
            StepRule::Cubic if n > 2 => (-v(i - 1) + 13.0 * v(i) + 13.0 * v(i + 1) - v(i + 2)) / 24.0,
            StepRule::Trapezoid | StepRule::Cubic => f64::midpoint(v(i), v(i + 1)),
        };
        mean * (times[i + 1] - times[i])
    })
}

/// The most likely states given all positions, their variances in units of ρ, and the log likelihood of the observed
/// steps (the first position alone contains no information), all by dense matrices.
fn literal(y: &DMatrix<f64>, steps: &DMatrix<f64>, ratio: f64) -> (DMatrix<f64>, DVector<f64>, f64, f64) {
    let n = y.ncols();
    let mut information = DMatrix::identity(n, n);
    let mut toward = y.clone();
    for i in 0..n - 1 {
        for (a, b, sign) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)] {
            information[(a, b)] += sign / ratio;
        }
        let step = steps.column(i) / ratio;
        toward.column_mut(i).axpy(-1.0, &step, 1.0);
        toward.column_mut(i + 1).axpy(1.0, &step, 1.0);
    }
    let covariance = information.try_inverse().unwrap();
    // y_i − y_1 − Σ Δ: noise of both positions and of all steps between.
    let seen = DMatrix::from_fn(n - 1, n - 1, |a, b| 1.0 + f64::from(u8::from(a == b)) + ratio * (a.min(b) + 1) as f64);
    let beyond = DMatrix::from_fn(y.nrows(), n - 1, |j, i| {
        y[(j, i + 1)] - y[(j, 0)] - (0..=i).map(|k| steps[(j, k)]).sum::<f64>()
    });
    let squares = (&beyond * seen.clone().try_inverse().unwrap() * beyond.transpose()).trace();
    let log_determinant = y.nrows() as f64 * seen.lu().determinant().ln();
    (toward * &covariance, covariance.diagonal(), squares, log_determinant)
}

#[derive(Debug)]
struct Case {
    times: Vec<f64>,
    positions: DMatrix<f64>,
    velocities: DMatrix<f64>,
}

fn case() -> impl Strategy<Value = Case> {
    (1..4usize, 2..9usize).prop_flat_map(|(dim, n)| {
        (vec(0.1..2.0f64, n), vec(-1.0..1.0f64, dim * n), vec(-1.0..1.0f64, dim * n)).prop_map(move |(gaps, x, v)| {
            Case {
                times: gaps
                    .iter()
                    .scan(1.0, |t, gap| {
                        Some({
                            *t += gap;
                            *t
                        })
                    })
                    .collect(),
                positions: DMatrix::from_vec(dim, n, x),
                velocities: DMatrix::from_vec(dim, n, v),
            }
        })
    })
}

fn rules() -> impl Strategy<Value = StepRule> {
    prop_oneof![Just(StepRule::Euler), Just(StepRule::Trapezoid), Just(StepRule::Cubic)]
}

impl Case {
    fn stamped(&self) -> Trajectory {
        Trajectory::stamped(self.times.clone(), self.positions.clone())
            .unwrap()
            .with_velocities(self.velocities.clone())
            .unwrap()
    }
}

proptest! {
    /// The filter with its backward pass equals the dense solution; ρ is the mean squared innovation.
    #[test]
    fn the_filter_is_least_squares(case in case(), rule in rules(), log10_ratio in -3.0..2.0f64) {
        let fusion = Fusion { rules: vec![rule], log10_ratios: vec![log10_ratio] };
        let fused = fusion.fuse(&Demonstrations::new(vec![case.stamped()]).unwrap()).unwrap();
        let steps = steps(rule, &case.times, &case.velocities);
        let (states, variances, squares, _) = literal(&case.positions, &steps, 10f64.powf(log10_ratio));
        let rho = squares / steps.len() as f64;
        prop_assert!((fused.noise_variance - rho).abs() <= 1e-9 * rho);
        prop_assert!((&fused.movements[0].states - states).amax() < 1e-9);
        prop_assert!((&fused.movements[0].variance - variances * rho).amax() <= 1e-9 * rho);
    }

    /// Among all rules and ratios, the one with the highest profile likelihood over all movements together is used.
    #[test]
    fn the_likeliest_rule_and_ratio_are_taken(cases in (1..3usize).prop_flat_map(|k| vec(case(), k))) {
        let dim = cases[0].positions.nrows();
        prop_assume!(cases.iter().all(|case| case.positions.nrows() == dim));
        let fusion = Fusion { log10_ratios: vec![-3.0, -1.5, 0.0, 1.0], ..Fusion::default() };
        let fused = fusion.fuse(&Demonstrations::new(cases.iter().map(Case::stamped).collect()).unwrap()).unwrap();
        let likelihood = |rule: StepRule, log10: f64| {
            let (mut squares, mut logs, mut count) = (0.0, 0.0, 0.0);
            for case in &cases {
                let steps = steps(rule, &case.times, &case.velocities);
                let (_, _, square, log) = literal(&case.positions, &steps, 10f64.powf(log10));
                (squares, logs, count) = (squares + square, logs + log, count + steps.len() as f64);
            }
            -0.5 * (logs + count * (squares / count).ln() + count)
        };
        let ours = likelihood(fused.rule, fused.log10_ratio);
        for &rule in &fusion.rules {
            for &log10 in &fusion.log10_ratios {
                prop_assert!(likelihood(rule, log10) <= ours + 1e-9 * ours.abs());
            }
        }
    }
}

/// A circle traversed at unit speed: `n` samples, `step` seconds apart, by exact or Euler steps, with noise.
fn circle(n: usize, step: f64, euler: bool, noise: f64, seed: u64) -> (Demonstrations, DMatrix<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let angle = |i: usize| i as f64 * step;
    let velocities = DMatrix::from_fn(2, n, |j, i| if j == 0 { -angle(i).sin() } else { angle(i).cos() });
    let mut truth = DMatrix::from_fn(2, n, |j, i| if j == 0 { angle(i).cos() } else { angle(i).sin() });
    if euler {
        for i in 1..n {
            let next = truth.column(i - 1) + velocities.column(i - 1) * step;
            truth.set_column(i, &next);
        }
    }
    let noisy = truth.map(|x| x + noise * Distribution::<f64>::sample(&StandardNormal, &mut rng));
    let trajectory = Trajectory::new(noisy, step).unwrap().with_velocities(velocities).unwrap();
    (Demonstrations::new(vec![trajectory]).unwrap(), truth)
}

fn error(fused: &Fused, truth: &DMatrix<f64>) -> f64 {
    ((&fused.movements[0].states - truth).norm_squared() / truth.len() as f64).sqrt()
}

#[test]
fn the_rule_that_made_the_movement_is_found_and_noise_falls() {
    for seed in 0..5 {
        for (euler, rule) in [(true, StepRule::Euler), (false, StepRule::Cubic)] {
            let (demonstrations, truth) = circle(100, 0.2, euler, 0.01, seed);
            let fused = Fusion::default().fuse(&demonstrations).unwrap();
            assert_eq!(fused.rule, rule);
            let deviation = fused.noise_variance.sqrt();
            assert!((deviation / 0.01 - 1.0).abs() < 0.2, "{deviation}");
            // Only the start of the movement is unknown: noise is reduced by √100, up to the randomness of two numbers.
            assert!(error(&fused, &truth) < 3e-3, "{}", error(&fused, &truth));
        }
    }
}

#[test]
fn exact_movements_stay_as_they_are() {
    let (demonstrations, truth) = circle(50, 0.1, true, 0.0, 0);
    let fused = Fusion::default().fuse(&demonstrations).unwrap();
    assert_eq!(fused.rule, StepRule::Euler);
    assert!((&fused.movements[0].states - truth).amax() < 1e-14);
    let standing = Trajectory::new(DMatrix::from_element(2, 5, 1.5), 1.0).unwrap();
    let standing = standing.with_velocities(DMatrix::zeros(2, 5)).unwrap();
    let fused = Fusion::default().fuse(&Demonstrations::new(vec![standing]).unwrap()).unwrap();
    assert_eq!(fused.noise_variance, 0.0);
    assert_eq!(fused.movements[0].states, DMatrix::from_element(2, 5, 1.5));
    assert_eq!(fused.movements[0].variance, DVector::zeros(5));
}
