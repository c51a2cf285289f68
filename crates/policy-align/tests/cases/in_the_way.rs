//! A wall that all movements reach, rotating constraints, constraints on a few movements, and pushes into fast regions.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::unseen::{COUNT, case, movement, normal, of_movements, pressed};
use super::{Case, FRESH, Named};

/// Radians per second.
const TURNING: f64 = 0.4;

/// −∇ of a bowl with other curvatures along each axis, and bumps; its goal is near 0.
fn bowl(x: &DVector<f64>) -> DVector<f64> {
    let last = (x.len() - 1) as f64;
    DVector::from_fn(x.len(), |k, _| -(1.0 + k as f64 / last) * x[k] - 0.4 * (1.5 * x[k] + k as f64).cos())
}

/// Adds white noise to velocities, relative to their size, and to positions, which have a spread of about 1.
fn noisy(case: Case, share: f64, seed: u64) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x2b);
    let case = case.velocity_noise(share, seed);
    case.each(|episode| episode.positions.apply(|x| *x += share * rng.sample::<f64, _>(StandardNormal)))
}

/// No movement passes the wall n·x = −0.4 in front of the goal; there are no other constraints.
fn walled(dim: usize, seed: u64) -> Case {
    const LEVEL: f64 = -0.4;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let n = normal(dim, &mut rng);
    let movements: Vec<[DMatrix<f64>; 3]> = (0..COUNT + FRESH)
        .map(|_| {
            let mut start = DVector::from_fn(dim, |_, _| rng.random_range(-2.0..2.0));
            start -= &n * (2.0 * (n.dot(&start) - LEVEL).max(0.0));
            let n = n.clone();
            let robot = move |_: f64, x: &DVector<f64>| {
                let policy = bowl(x);
                let blocks = n.dot(x) >= LEVEL && n.dot(&policy) > 0.0;
                if blocks { pressed(&n, 0.0, &policy) } else { policy }
            };
            movement(start, &(Box::new(|_, x| bowl(x)), Box::new(robot)))
        })
        .collect();
    of_movements(&["x", "y", "z"][..dim], &movements)
}

/// One constraint per movement, with a rotating normal.
fn turning(seed: u64) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let movements: Vec<[DMatrix<f64>; 3]> = (0..COUNT + FRESH)
        .map(|_| {
            let start = DVector::from_fn(6, |_, _| rng.random_range(-2.0..2.0));
            let n = normal(6, &mut rng);
            let across = normal(6, &mut rng);
            let across = (&across - &n * n.dot(&across)).normalize();
            let robot = move |time: f64, x: &DVector<f64>| {
                let (sine, cosine) = (TURNING * time).sin_cos();
                pressed(&(&n * cosine + &across * sine), 0.0, &bowl(x))
            };
            movement(start, &(Box::new(|_, x| bowl(x)), Box::new(robot)))
        })
        .collect();
    of_movements(&["q1", "q2", "q3", "q4", "q5", "q6"], &movements)
}

/// A policy that rotates about z; only the first movements are constrained.
pub(super) fn few_constrained(constrained: usize, seed: u64) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let policy = |x: &DVector<f64>| DVector::from_vec(vec![-x[0] - 2.0 * x[1], 2.0 * x[0] - x[1], -0.5 * x[2]]);
    let movements: Vec<[DMatrix<f64>; 3]> = (0..COUNT + FRESH)
        .map(|at| {
            let start = DVector::from_fn(3, |_, _| rng.random_range(-1.5..1.5));
            let n = normal(3, &mut rng);
            let robot =
                move |_: f64, x: &DVector<f64>| if at < constrained { pressed(&n, 0.0, &policy(x)) } else { policy(x) };
            movement(start, &(Box::new(move |_, x| policy(x)), Box::new(robot)))
        })
        .collect();
    of_movements(&["x", "y", "z"], &movements)
}

/// A limit cycle whose speed grows with the third power of the distance; constraints push movements out to where it is fast.
fn pushed_out(seed: u64) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let policy = |x: &DVector<f64>| {
        let inwards = 1.0 - x.norm_squared();
        DVector::from_vec(vec![x[1] + inwards * x[0], -x[0] + inwards * x[1]])
    };
    let movements: Vec<[DMatrix<f64>; 3]> = (0..COUNT + FRESH)
        .map(|_| {
            let start = DVector::from_fn(2, |_, _| rng.random_range(-1.5..1.5));
            let (n, push) = (normal(2, &mut rng), rng.sample::<f64, _>(StandardNormal));
            movement(start, &(Box::new(move |_, x| policy(x)), Box::new(move |_, x| pressed(&n, push, &policy(x)))))
        })
        .collect();
    of_movements(&["x", "y"], &movements)
}

/// All cases.
pub(crate) fn all() -> Vec<Named> {
    vec![
        case("a wall in the way of all, 2-D", |s| walled(2, s)),
        case("a wall in the way of all, 2-D, 2 % noise", |s| noisy(walled(2, s), 0.02, s)),
        case("a wall in the way of all, 3-D, 1 % noise", |s| noisy(walled(3, s), 0.01, s)),
        case("constraints that turn, 6-D, 1 % noise", |s| noisy(turning(s), 0.01, s)),
        case("one of forty movements constrained, 3-D", |s| few_constrained(1, s)),
        case("three of forty movements constrained, 3-D, 2 % noise", |s| noisy(few_constrained(3, s), 0.02, s)),
        case("pushed out to where the policy is fast", pushed_out),
    ]
}
