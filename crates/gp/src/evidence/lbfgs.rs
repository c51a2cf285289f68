//! L-BFGS within a box: two-loop recursion, projection, Armijo backtracking.

use std::collections::VecDeque;

use nalgebra::DVector;

use crate::evidence::Evidence;

const MEMORY: usize = 10;
/// As many iterations as ever pay.
pub(crate) const ITERATIONS: usize = 40;
/// Stop when no entry of the projected gradient exceeds this.
const FLAT: f64 = 1e-5;
/// Stop when a step lowers the value by less than this share.
const SLOW: f64 = 2.2e-9;
/// Share of the slope's promise that a step must keep.
const ARMIJO: f64 = 1e-4;
const SHORTENINGS: usize = 20;
/// Stands for a covariance without Cholesky factor.
const WALL: f64 = 1e10;

/// Lower and upper bounds of every variable.
#[derive(Debug, Clone)]
pub(crate) struct Bounds {
    pub(crate) lower: DVector<f64>,
    pub(crate) upper: DVector<f64>,
}

impl Bounds {
    fn project(&self, point: &DVector<f64>) -> DVector<f64> {
        point.sup(&self.lower).inf(&self.upper)
    }

    /// The gradient without the entries that push a variable out of the box.
    fn free(&self, point: &DVector<f64>, gradient: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(point.len(), |k, _| {
            let out =
                (point[k] <= self.lower[k] && gradient[k] > 0.0) || (point[k] >= self.upper[k] && gradient[k] < 0.0);
            if out { 0.0 } else { gradient[k] }
        })
    }
}

/// The least point found from `start` in at most so many iterations; a value of none counts as 1e10 with zero gradient.
pub(crate) fn minimise(
    mut objective: impl FnMut(&DVector<f64>) -> Option<Evidence>,
    start: &DVector<f64>,
    bounds: &Bounds,
    iterations: usize,
) -> DVector<f64> {
    let mut evaluate = |point: &DVector<f64>| {
        objective(point).unwrap_or_else(|| Evidence { value: WALL, gradient: DVector::zeros(point.len()) })
    };
    let mut point = bounds.project(start);
    let mut here = evaluate(&point);
    let mut pairs = VecDeque::new();
    for _ in 0..iterations {
        let free = bounds.free(&point, &here.gradient);
        if free.amax() < FLAT {
            break;
        }
        let mut direction = descent(&free, &pairs);
        if direction.dot(&free) >= 0.0 {
            pairs.clear();
            direction = descent(&free, &pairs);
        }
        let Some((next, there)) = search(&mut evaluate, bounds, (&point, &here), &direction) else { break };
        let decrease = (here.value - there.value) / here.value.abs().max(there.value.abs()).max(1.0);
        let pair = (&next - &point, &there.gradient - &here.gradient);
        if pair.0.dot(&pair.1) > f64::EPSILON * pair.1.norm_squared() {
            pairs.truncate(MEMORY - 1);
            pairs.push_front(pair);
        }
        (point, here) = (next, there);
        if decrease < SLOW {
            break;
        }
    }
    point
}

/// −Hg by the two-loop recursion over the pairs (s, y), the newest first; variables held at a bound stay.
fn descent(free: &DVector<f64>, pairs: &VecDeque<(DVector<f64>, DVector<f64>)>) -> DVector<f64> {
    let mut direction = free.clone();
    let mut shares = Vec::new();
    for (s, y) in pairs {
        let share = s.dot(&direction) / s.dot(y);
        direction.axpy(-share, y, 1.0);
        shares.push(share);
    }
    match pairs.front() {
        Some((s, y)) => direction *= s.dot(y) / y.norm_squared(),
        // As long a first step as a variable is likely to need.
        None => direction /= free.norm().max(1.0),
    }
    for ((s, y), share) in pairs.iter().zip(shares).rev() {
        let other = y.dot(&direction) / s.dot(y);
        direction.axpy(share - other, s, 1.0);
    }
    DVector::from_fn(free.len(), |k, _| if free[k] == 0.0 { 0.0 } else { -direction[k] })
}

/// The first of the steps 1, a cubic's least point, then halves, that lowers the value by enough.
fn search(
    evaluate: &mut impl FnMut(&DVector<f64>) -> Evidence,
    bounds: &Bounds,
    (point, here): (&DVector<f64>, &Evidence),
    direction: &DVector<f64>,
) -> Option<(DVector<f64>, Evidence)> {
    let mut step = 1.0;
    for shortening in 0..SHORTENINGS {
        let next = bounds.project(&(point + direction * step));
        let there = evaluate(&next);
        let promised = here.gradient.dot(&(&next - point));
        if there.value <= here.value + ARMIJO * promised && there.value < here.value {
            return Some((next, there));
        }
        let slopes = (here.gradient.dot(direction), there.gradient.dot(direction));
        step *= if shortening == 0 { cubic(here.value, there.value, slopes).clamp(0.1, 0.5) } else { 0.5 };
    }
    None
}

/// Where the cubic through both ends of [0, 1] with these slopes is least; ½ if nowhere.
fn cubic(at_0: f64, at_1: f64, (slope_0, slope_1): (f64, f64)) -> f64 {
    let bend = slope_0 + slope_1 - 3.0 * (at_1 - at_0);
    let root = (bend * bend - slope_0 * slope_1).sqrt();
    let least = 1.0 - (slope_1 + root - bend) / (slope_1 - slope_0 + 2.0 * root);
    if least.is_finite() { least } else { 0.5 }
}
