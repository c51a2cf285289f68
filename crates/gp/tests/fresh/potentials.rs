//! Gradients of potentials that match no family of the slope GP.

use nalgebra::{DMatrix, DVector};

/// A potential with the cube of its starts; `rank` is that of a constraint.
pub(crate) struct System {
    pub(crate) name: &'static str,
    pub(crate) dim: usize,
    pub(crate) rank: usize,
    pub(crate) middle: &'static [f64],
    pub(crate) half_width: f64,
    pub(crate) gradient: fn(&DVector<f64>) -> DVector<f64>,
}

const fn system(
    name: &'static str,
    rank: usize,
    middle: &'static [f64],
    half_width: f64,
    gradient: fn(&DVector<f64>) -> DVector<f64>,
) -> System {
    System { name, dim: middle.len(), rank, middle, half_width, gradient }
}

pub(crate) const SYSTEMS: [System; 12] = [
    system("franke", 1, &[0.5; 2], 0.5, franke),
    system("himmelblau", 1, &[0.0; 2], 5.0, himmelblau),
    system("mueller", 1, &[-0.2, 0.7], 0.8, mueller),
    system("quartic3", 1, &[0.0; 3], 1.5, quartic),
    system("saddle", 1, &[0.0; 2], 1.5, saddle),
    system("xy3", 1, &[0.0; 3], 2.0, angles),
    system("osc4", 1, &[0.0; 4], 1.5, chain),
    system("joint7", 2, &[0.4; 7], 0.7, arm),
    system("rastrigin", 1, &[0.0; 2], 1.0, rastrigin),
    system("logcosh3", 1, &[0.0; 3], 2.0, log_cosh),
    system("wells5", 2, &[0.0; 5], 2.0, wells),
    system("rosenbrock", 1, &[0.0, 0.5], 1.2, rosenbrock),
];

fn of<const N: usize>(numbers: [f64; N]) -> DVector<f64> {
    DVector::from_column_slice(&numbers)
}

fn franke(x: &DVector<f64>) -> DVector<f64> {
    let (a, b) = (9.0 * x[0], 9.0 * x[1]);
    let bump = |height: f64, value: f64, slopes: [f64; 2]| [height * value * slopes[0], height * value * slopes[1]];
    let first = (-((a - 2.0).powi(2) + (b - 2.0).powi(2)) / 4.0).exp();
    let second = (-(a + 1.0).powi(2) / 49.0 - (b + 1.0) / 10.0).exp();
    let third = (-((a - 7.0).powi(2) + (b - 3.0).powi(2)) / 4.0).exp();
    let fourth = (-(a - 4.0).powi(2) - (b - 7.0).powi(2)).exp();
    let all = [
        bump(0.75, first, [-(a - 2.0) / 2.0, -(b - 2.0) / 2.0]),
        bump(0.75, second, [-2.0 * (a + 1.0) / 49.0, -0.1]),
        bump(0.5, third, [-(a - 7.0) / 2.0, -(b - 3.0) / 2.0]),
        bump(-0.2, fourth, [-2.0 * (a - 4.0), -2.0 * (b - 7.0)]),
    ];
    let wall = [3.0 * (2.0 * x[0] - 1.0).powi(3), 3.0 * (2.0 * x[1] - 1.0).powi(3)];
    DVector::from_fn(2, |k, _| 9.0 * all.iter().map(|bump| bump[k]).sum::<f64>() + wall[k])
}

fn himmelblau(x: &DVector<f64>) -> DVector<f64> {
    let (p, q) = (x[0] * x[0] + x[1] - 11.0, x[0] + x[1] * x[1] - 7.0);
    of([4.0 * x[0] * p + 2.0 * q, 2.0 * p + 4.0 * x[1] * q])
}

/// Mueller and Brown's potential.
fn mueller(x: &DVector<f64>) -> DVector<f64> {
    let terms = [
        (-2.0, -1.0, 0.0, -10.0, 1.0, 0.0),
        (-1.0, -1.0, 0.0, -10.0, 0.0, 0.5),
        (-1.7, -6.5, 11.0, -6.5, -0.5, 1.5),
        (0.15, 0.7, 0.6, 0.7, -1.0, 1.0),
    ];
    let mut gradient = of([0.0, 0.0]);
    for (height, a, b, c, x0, y0) in terms {
        let (dx, dy) = (x[0] - x0, x[1] - y0);
        let value = height * (a * dx * dx + b * dx * dy + c * dy * dy).min(4.0).exp();
        gradient += of([value * (2.0 * a * dx + b * dy), value * (b * dx + 2.0 * c * dy)]);
    }
    gradient
}

fn quartic(x: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(3, |k, _| x[k].powi(3) - x[k] + 0.3 * x[(k + 1) % 3] + 0.3 * x[(k + 2) % 3])
}

fn saddle(x: &DVector<f64>) -> DVector<f64> {
    of([-x[0] + x[0].powi(3) + 0.3 * x[1], x[1] + 0.3 * x[0] + 0.5 * x[1].sin()])
}

fn angles(x: &DVector<f64>) -> DVector<f64> {
    let mut gradient = DVector::zeros(3);
    for (i, j) in [(0, 1), (1, 2), (0, 2)] {
        let slope = (x[i] - x[j]).sin();
        gradient[i] += slope;
        gradient[j] -= slope;
    }
    gradient[0] += 0.5 * x[0].sin();
    gradient[1] += (2.0 * x[1]).sin();
    gradient
}

fn chain(x: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(4, |k, _| {
        let neighbours = [k.checked_sub(1), Some(k + 1).filter(|&k| k < 4)];
        let springs: f64 = neighbours.into_iter().flatten().map(|other| x[k] - x[other]).sum();
        x[k].powi(3) - x[k] + 0.5 * springs
    })
}

/// Half the squared distance of a planar arm's hand from a point, and of its joints from rest.
fn arm(x: &DVector<f64>) -> DVector<f64> {
    let mut angles = [0.0; 7];
    let mut sum = 0.0;
    for k in 0..7 {
        sum += x[k];
        angles[k] = sum;
    }
    let hand: (f64, f64) = (angles.iter().map(|a| a.cos()).sum::<f64>(), angles.iter().map(|a| a.sin()).sum::<f64>());
    let off = (hand.0 - 1.5, hand.1 - 3.0);
    DVector::from_fn(7, |k, _| {
        let (down, across): (f64, f64) = (k..7).fold((0.0, 0.0), |s, j| (s.0 - angles[j].sin(), s.1 + angles[j].cos()));
        off.0 * down + off.1 * across + x[k]
    })
}

fn rastrigin(x: &DVector<f64>) -> DVector<f64> {
    x.map(|x| 2.0 * x + 4.0 * (4.0 * x).sin())
}

fn log_cosh(x: &DVector<f64>) -> DVector<f64> {
    let mixed = DMatrix::from_row_slice(3, 3, &[1.0, 0.5, 0.0, -0.4, 1.0, 0.3, 0.2, -0.5, 1.0]);
    let bends = (&mixed * x).map(|y| (3.0 * (y - 0.3)).tanh());
    mixed.tr_mul(&bends) + x * 0.1
}

/// Three wells at fixed places, in any dimension, in a bowl.
fn wells(x: &DVector<f64>) -> DVector<f64> {
    let dim = x.len();
    let width = 0.55 * (dim as f64).sqrt();
    let mut gradient = x * 0.1;
    for (well, depth) in [1.0, 0.8, 0.9].into_iter().enumerate() {
        let centre = DVector::from_fn(dim, |k, _| 1.1 * ((2 * well + 1) as f64 * (k as f64 + 0.7)).sin());
        let apart = x - centre;
        gradient += &apart * (depth * (-apart.norm_squared() / (2.0 * width * width)).exp() / width);
    }
    gradient
}

fn rosenbrock(x: &DVector<f64>) -> DVector<f64> {
    let bend = x[1] - x[0] * x[0];
    of([-40.0 * x[0] * bend - 2.0 * (1.0 - x[0]), 20.0 * bend])
}
