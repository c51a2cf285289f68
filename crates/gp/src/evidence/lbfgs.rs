//! L-BFGS within a box: two-loop recursion, projection, Armijo backtracking.

use std::collections::VecDeque;

use nalgebra::DVector;

use crate::evidence::Evidence;

const MEMORY: usize = 10;
/// The search stops when no entry of the projected gradient exceeds this.
const FLAT: f64 = 1e-5;
/// Share of the linear prediction by which a step must lower the value.
const ARMIJO: f64 = 1e-4;
const SHORTENINGS: usize = 20;
/// Value for a covariance without a Cholesky factor.
const WALL: f64 = 1e10;

/// Lower and upper bound of each variable.
#[derive(Debug, Clone)]
pub(crate) struct Bounds {
    pub(crate) lower: DVector<f64>,
    pub(crate) upper: DVector<f64>,
}

impl Bounds {
    fn project(&self, point: &DVector<f64>) -> DVector<f64> {
        point.sup(&self.lower).inf(&self.upper)
    }

    /// The gradient without the entries that would move a variable out of the box.
    fn free(&self, point: &DVector<f64>, gradient: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(point.len(), |k, _| {
            let out =
                (point[k] <= self.lower[k] && gradient[k] > 0.0) || (point[k] >= self.upper[k] && gradient[k] < 0.0);
            if out { 0.0 } else { gradient[k] }
        })
    }
}

/// Stopping criteria of a search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    pub(crate) iterations: usize,
    /// The search stops at a step that lowers the value by less than this.
    pub(crate) tolerance: f64,
}

/// The curvature learnt by a search: the last steps and the changes of the gradient, the newest first.
#[derive(Debug, Clone, Default)]
pub(crate) struct Curvature(VecDeque<(DVector<f64>, DVector<f64>)>);

impl Curvature {
    /// Rescales to the curvature of `factor` times the objective.
    pub(crate) fn scale(&mut self, factor: f64) {
        self.0.iter_mut().for_each(|(_, y)| *y *= factor);
    }

    fn learn(&mut self, s: DVector<f64>, y: DVector<f64>) {
        if s.dot(&y) > f64::EPSILON * y.norm_squared() {
            self.0.truncate(MEMORY - 1);
            self.0.push_front((s, y));
        }
    }
}

/// The best point found from `start`; a missing value counts as 1e10 with zero gradient.
pub(crate) fn minimise(
    mut objective: impl FnMut(&DVector<f64>) -> Option<Evidence>,
    start: &DVector<f64>,
    bounds: &Bounds,
    limits: Limits,
    curvature: &mut Curvature,
) -> DVector<f64> {
    let mut evaluate = |point: &DVector<f64>| {
        objective(point).unwrap_or_else(|| Evidence { value: WALL, gradient: DVector::zeros(point.len()) })
    };
    let mut point = bounds.project(start);
    let mut here = evaluate(&point);
    for _ in 0..limits.iterations {
        let free = bounds.free(&point, &here.gradient);
        if free.amax() < FLAT {
            break;
        }
        let mut direction = descent(&free, curvature);
        if direction.dot(&free) >= 0.0 {
            *curvature = Curvature::default();
            direction = descent(&free, curvature);
        }
        let Some((next, there)) = search(&mut evaluate, bounds, (&point, &here), &direction, limits.tolerance) else {
            break;
        };
        let decrease = here.value - there.value;
        curvature.learn(&next - &point, &there.gradient - &here.gradient);
        (point, here) = (next, there);
        if decrease < limits.tolerance {
            break;
        }
    }
    point
}

/// −Hg by the two-loop recursion over the pairs (s, y), the newest first; variables held at a bound do not move.
fn descent(free: &DVector<f64>, Curvature(pairs): &Curvature) -> DVector<f64> {
    let mut direction = free.clone();
    let mut shares = Vec::new();
    for (s, y) in pairs {
        let share = s.dot(&direction) / s.dot(y);
        direction.axpy(-share, y, 1.0);
        shares.push(share);
    }
    match pairs.front() {
        Some((s, y)) => direction *= s.dot(y) / y.norm_squared(),
        // The length of a first step that a variable is likely to need.
        None => direction /= free.norm().max(1.0),
    }
    for ((s, y), share) in pairs.iter().zip(shares).rev() {
        let other = y.dot(&direction) / s.dot(y);
        direction.axpy(share - other, s, 1.0);
    }
    DVector::from_fn(free.len(), |k, _| if free[k] == 0.0 { 0.0 } else { -direction[k] })
}

/// The first of the steps 1, minimum of a cubic, then halves, that lowers the value sufficiently; `None` once steps promise less
/// than the tolerance.
fn search(
    evaluate: &mut impl FnMut(&DVector<f64>) -> Evidence,
    bounds: &Bounds,
    (point, here): (&DVector<f64>, &Evidence),
    direction: &DVector<f64>,
    tolerance: f64,
) -> Option<(DVector<f64>, Evidence)> {
    let mut step = 1.0;
    for shortening in 0..SHORTENINGS {
        let next = bounds.project(&(point + direction * step));
        let there = evaluate(&next);
        let promised = here.gradient.dot(&(&next - point));
        if there.value <= here.value + ARMIJO * promised && there.value < here.value {
            return Some((next, there));
        }
        if shortening > 0 && -promised < tolerance {
            return None;
        }
        let slopes = (here.gradient.dot(direction), there.gradient.dot(direction));
        step *= if shortening == 0 { cubic(here.value, there.value, slopes).clamp(0.1, 0.5) } else { 0.5 };
    }
    None
}

/// Minimum on [0, 1] of the cubic with these values and slopes at both ends; ½ if there is none.
fn cubic(at_0: f64, at_1: f64, (slope_0, slope_1): (f64, f64)) -> f64 {
    let bend = slope_0 + slope_1 - 3.0 * (at_1 - at_0);
    let root = (bend * bend - slope_0 * slope_1).sqrt();
    let least = 1.0 - (slope_1 + root - bend) / (slope_1 - slope_0 + 2.0 * root);
    if least.is_finite() { least } else { 0.5 }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    const LIMITS: Limits = Limits { iterations: 200, tolerance: 1e-10 };

    /// Minimises a quadratic with its minimum at `least`, then the quadratic `factor` times as steep from the same start, but with
    /// the curvature of the first search. Returns the points found and the numbers of evaluations; for the first also the gradient.
    fn searched_twice(dim: usize, width: f64, factor: f64, seed: u64) -> ([(DVector<f64>, usize); 2], DVector<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let root = DMatrix::from_fn(dim, dim, |_, _| rng.random_range(-1.0..1.0));
        let bowl = root.tr_mul(&root) + DMatrix::identity(dim, dim) * 0.1;
        let mut point = || DVector::from_fn(dim, |_, _| rng.random_range(-2.0..2.0));
        let (start, least) = (point(), point());
        let bounds = Bounds { lower: DVector::repeat(dim, -width), upper: DVector::repeat(dim, width) };
        let mut curvature = Curvature::default();
        let searches = [1.0, factor].map(|steepness| {
            let mut evaluations = 0;
            let evidence = |x: &DVector<f64>| {
                evaluations += 1;
                let gradient = steepness * (&bowl * (x - &least));
                Some(Evidence { value: 0.5 * gradient.dot(&(x - &least)), gradient })
            };
            let found = minimise(evidence, &start, &bounds, LIMITS, &mut curvature);
            curvature.scale(factor);
            (found, evaluations)
        });
        let free = bounds.free(&searches[0].0, &(&bowl * (&searches[0].0 - &least)));
        (searches, free)
    }

    proptest! {
        /// At the minimum of a quadratic in a box, the free part of the gradient vanishes.
        #[test]
        fn bowls_have_their_least_points(dim in 1_usize..8, width in 0.5..3.0_f64, factor in 0.5..4.0_f64, seed in any::<u64>()) {
            let ([(found, _), (again, _)], free) = searched_twice(dim, width, factor, seed);
            prop_assert!(free.amax() < 1e-3, "{free}");
            prop_assert!((again - found).amax() < 1e-3);
        }
    }

    /// Known curvature saves evaluations.
    #[test]
    fn known_curvature_saves_evaluations() {
        let (mut unknown, mut known) = (0, 0);
        for seed in 0..50 {
            let ([(_, first), (_, second)], _) = searched_twice(6, 10.0, 2.0, seed);
            (unknown, known) = (unknown + first, known + second);
        }
        assert!(3 * known < 2 * unknown, "{known} evaluations, {unknown} without");
    }
}
