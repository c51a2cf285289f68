//! Detects channels that are velocities of others: their integrals over time explain the steps of these.

use std::ops::Range;

use motion::{Demonstrations, Trajectory};
use nalgebra::DMatrix;

/// Minimum share of a channel's steps that its velocity explains.
const EXPLAINED: f64 = 0.97;
/// Velocities have the same unit if the factors of their steps differ by at most this share.
const ALIKE: f64 = 0.1;
/// Maximum number of stretches to compare, and of samples in one.
const STRETCHES: usize = 2000;
const SAMPLES: usize = 10;
/// Minimum number of stretches of a movement that determine a separate factor for it.
const OF_MOVEMENT: usize = 5;
/// Above this number, channels are not compared movement by movement.
const MOST_BY_MOVEMENT: usize = 64;

/// Displacements of channels in stretches of the movements.
pub(super) struct Integrals {
    /// Displacements, (n, stretches).
    steps: DMatrix<f64>,
    /// Integrals of the channels over time, (n, stretches).
    over_time: DMatrix<f64>,
    /// Duration of each stretch in seconds, and its movement.
    stretches: Vec<(f64, usize)>,
}

/// Sums over some stretches.
struct Sums {
    /// Σ step integralᵀ, (n, n).
    product: DMatrix<f64>,
    /// Σ step², Σ integral² and (Σ step seconds)²/Σ seconds² of each channel.
    squares: Vec<[f64; 3]>,
}

/// A channel and another one that explains its steps.
struct Pair {
    channels: (usize, usize),
    /// The step divided by the integral, in each group of stretches.
    factors: Vec<f64>,
    explained: f64,
}

impl Integrals {
    pub(super) fn of(demonstrations: &Demonstrations) -> Self {
        let places = || {
            demonstrations.trajectories().iter().enumerate().flat_map(|(k, movement)| {
                let last = movement.n_samples() - 1;
                let length = SAMPLES.min((last / 2).max(1));
                (0..last / length).map(move |stretch| (k, movement, stretch * length, (stretch + 1) * length))
            })
        };
        let every = places().count().div_ceil(STRETCHES).max(1);
        let chosen: Vec<(usize, &Trajectory, usize, usize)> = places().step_by(every).collect();
        let n = demonstrations.dim();
        let mut steps = DMatrix::zeros(n, chosen.len());
        let mut integrals = DMatrix::zeros(n, chosen.len());
        for (at, &(_, movement, from, to)) in chosen.iter().enumerate() {
            steps.set_column(at, &(movement.state(to) - movement.state(from)));
            let mut integral = integrals.column_mut(at);
            for sample in from..to {
                let half = 0.5 * movement.seconds(sample, sample + 1);
                integral.axpy(half, &movement.state(sample), 1.0);
                integral.axpy(half, &movement.state(sample + 1), 1.0);
            }
        }
        let stretches = chosen.iter().map(|&(k, movement, from, to)| (movement.seconds(from, to), k)).collect();
        Integrals { steps, over_time: integrals, stretches }
    }

    /// Pairs of a channel and its velocity, in the order of the channels. Empty unless they form a block of each, or alternate throughout.
    /// `clock` is no velocity.
    pub(super) fn velocities(&self, clock: Option<usize>) -> Vec<(usize, usize)> {
        let all = 0..self.stretches.len();
        self.blocks(std::slice::from_ref(&all), clock)
    }

    /// The same if time steps may differ between movements, so that no single factor fits all: the channels of a block must agree on it in
    /// every movement.
    pub(super) fn velocities_by_movement(&self, clock: Option<usize>) -> Vec<(usize, usize)> {
        let mut first = 0;
        let movements = self.stretches.chunk_by(|a, b| a.1 == b.1).map(|stretches| {
            first += stretches.len();
            first - stretches.len()..first
        });
        let told: Vec<Range<usize>> = movements.filter(|movement| movement.len() >= OF_MOVEMENT).collect();
        let enough = told.len() > 1 && 2 * told.iter().map(Range::len).sum::<usize>() > self.stretches.len();
        if enough && self.steps.nrows() <= MOST_BY_MOVEMENT { self.blocks(&told, clock) } else { Vec::new() }
    }

    fn blocks(&self, groups: &[Range<usize>], clock: Option<usize>) -> Vec<(usize, usize)> {
        let n = self.steps.nrows();
        let sums: Vec<Sums> = groups.iter().map(|group| self.sums(group)).collect();
        let all: Vec<f64> = (0..n).map(|i| sums.iter().map(|of| of.squares[i][0]).sum()).collect();
        // Motion that time alone explains needs no velocity.
        let is_even = |i: usize| sums.iter().map(|of| of.squares[i][2]).sum::<f64>() >= EXPLAINED * all[i];
        let pair = |i: usize, j: usize| {
            let (mut factors, mut explained) = (Vec::with_capacity(sums.len()), 0.0);
            for Sums { product, squares } in &sums {
                let factor = product[(i, j)] / squares[j][1];
                if !(factor > 0.0 && factor.is_finite()) {
                    return None;
                }
                factors.push(factor);
                explained += factor * product[(i, j)];
            }
            let explained = explained / all[i];
            (explained >= EXPLAINED).then_some(Pair { channels: (i, j), factors, explained })
        };
        let pairs: Vec<Pair> = (0..n)
            .filter(|&i| clock != Some(i) && !is_even(i))
            .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
            .filter(|&(_, j)| clock != Some(j))
            .filter_map(|(i, j)| pair(i, j))
            .collect();
        let blocks = pairs.iter().map(|unit| block(unit, &pairs, n)).max_by_key(Vec::len).unwrap_or_default();
        if !blocks.is_empty() {
            return blocks;
        }
        let channels: Vec<usize> = (0..n).filter(|&i| clock != Some(i)).collect();
        pairs.first().and_then(|unit| alternating(unit, &pairs, &channels)).unwrap_or_default()
    }

    fn sums(&self, group: &Range<usize>) -> Sums {
        let [steps, integrals] = [&self.steps, &self.over_time].map(|of| of.columns(group.start, group.len()));
        let seconds: Vec<f64> = self.stretches[group.clone()].iter().map(|stretch| stretch.0).collect();
        let of_time = seconds.iter().map(|s| s * s).sum::<f64>();
        let squares = |i: usize| {
            let step = steps.row(i);
            let rise: f64 = step.iter().zip(&seconds).map(|(step, seconds)| step * seconds).sum();
            [step.norm_squared(), integrals.row(i).norm_squared(), rise * rise / of_time]
        };
        Sums { squares: (0..steps.nrows()).map(squares).collect(), product: steps * integrals.transpose() }
    }
}

/// Whether velocities have the same unit, in each group of stretches.
fn alike(a: &Pair, b: &Pair) -> bool {
    a.factors.iter().zip(&b.factors).all(|(a, b)| (a / b - 1.0).abs() <= ALIKE)
}

/// Each channel followed by its velocity, with the factors of `unit`: at least two pairs, covering all `channels`.
fn alternating(unit: &Pair, all: &[Pair], channels: &[usize]) -> Option<Vec<(usize, usize)>> {
    let (pairs, []) = channels.as_chunks::<2>() else { return None };
    let found = |&[i, j]: &[usize; 2]| all.iter().any(|of| of.channels == (i, j) && alike(of, unit));
    (pairs.len() > 1 && pairs.iter().all(found)).then(|| pairs.iter().map(|&[i, j]| (i, j)).collect())
}

/// The pairs with the factors of `unit`, if the velocities are in the order of the channels and after all of them.
fn block(unit: &Pair, all: &[Pair], n: usize) -> Vec<(usize, usize)> {
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for i in 0..n {
        let own = all.iter().filter(|of| of.channels.0 == i).filter(|of| alike(of, unit));
        let after = own.filter(|of| pairs.last().is_none_or(|&(_, before)| of.channels.1 > before));
        pairs.extend(after.max_by(|a, b| a.explained.total_cmp(&b.explained)).map(|of| of.channels));
    }
    let apart = pairs.last().zip(pairs.first()).is_some_and(|(last, first)| last.0 < first.1);
    if apart && pairs.len() > 1 { pairs } else { Vec::new() }
}
