//! A plane that many movements run into and none crosses: a table, a fence or a joint's stop.

use std::collections::HashSet;

use gp::Rows;
use motion::upper_median;
use nalgebra::{DMatrix, DVector};
use prepare::numbers::percent;

use super::{as_recorded, equation, some_of};
use crate::{Finding, Prepared, VelocitySource, Verdict};

/// Dimensions at most: planes through so many states are tried, all of which have to lie on the wall.
const DIMENSIONS: usize = 4;
/// States looked at, at most.
const STATES: usize = 2000;
/// Planes that are tried.
const PLANES: usize = 400;
/// Times that each is fitted anew to the states near it.
const FITS: usize = 6;
/// States nearer than so many standard deviations lie on the plane.
const NEAR: f64 = 2.5;
/// And further than so many they are beyond it; no more than one in a hundred may be.
const BEYOND: f64 = 3.5;
/// Standard deviation of the states on a wall, as a share of the way to the farthest, at most.
const THIN: f64 = 0.03;
/// Share of the states on a wall, at least; and so many times their standard deviation as a share of the way to the farthest.
const SHARE: f64 = 0.2;
const DENSE: f64 = 20.0;
/// Share of the states above which one plane has all: see [`CommonPlane`](super::CommonPlane).
const ALL: f64 = 0.95;
/// Share of the movements that reach it, at least.
const MOVEMENTS: f64 = 0.5;
/// Least extent along a wall, as a share of the largest of all states: less is a goal.
const WIDE: f64 = 0.2;
/// Standard deviation of the states on a wall, at most: times the noise of positions, as recorded or smoothed, and as a share of the way
/// to the farthest. Movements that come together on a straight path are less exact.
const NOISE: f64 = 1.3;
const SMOOTHED_NOISE: f64 = 0.6;
const EXACT: f64 = 0.001;
/// Share by which the policy differs from one without constraints, from which it has not taken the wall for its own doing.
const DIFFERS: f64 = 0.25;

/// A plane fitted to the states near it, in the units that were learnt from.
struct Wall {
    /// Of unit length, pointing out, (n).
    normal: DVector<f64>,
    /// A place on it, (n).
    at: DVector<f64>,
    /// Standard deviation of the states on it.
    thickness: f64,
    /// The largest distance of all states.
    farthest: f64,
    /// Which states lie on it, and their share.
    on: Vec<usize>,
    share: f64,
    /// Least standard deviation along it.
    width: f64,
}

/// A finding if movements run into a plane that none crosses (S47), and the policy differs by so small a `gap` from one without
/// constraints: what stops them there may hide where the policy goes.
pub(crate) fn wall(rows: &Rows, prepared: &Prepared, gap: f64) -> Option<Finding> {
    let Prepared { state, noise, .. } = prepared;
    if state.len() < 2 || state.len() > DIMENSIONS || gap >= DIFFERS {
        return None;
    }
    let wall = Wall::of(rows, state.len())?;
    let noise =
        noise.positions.as_ref().map_or(0.0, |of| wall.normal.component_mul(&DVector::from_column_slice(of)).norm());
    let times = if matches!(prepared.velocities, VelocitySource::Noisy(_)) { NOISE } else { SMOOTHED_NOISE };
    if wall.thickness > times * noise + EXACT * wall.farthest {
        return None;
    }
    let level = wall.normal.dot(&wall.at);
    let level = if level.abs() < EXACT * wall.farthest { 0.0 } else { level };
    let (normal, length) = as_recorded(&wall.normal, state);
    let plane = equation(&normal, level / length, state);
    Some(Finding {
        verdict: Verdict::Doubtful,
        what: format!("{} of the states lie on the plane {plane}, which no movement crosses", percent(wall.share)),
        next: "if something stops the hand there, record movements without it: it may hide where the policy goes"
            .to_owned(),
    })
}

impl Wall {
    /// (S47), of at most [`STATES`] rows; planes through states that are spread evenly over all, without chance.
    fn of(rows: &Rows, n: usize) -> Option<Wall> {
        let chosen = some_of(rows, STATES);
        let states = rows.states().rows(0, n).select_columns(&chosen);
        let movement: Vec<usize> = chosen.iter().map(|&row| rows.indices()[row].trajectory).collect();
        let movements = movement.iter().collect::<HashSet<_>>().len() as f64;
        let widest = principal(&states).0[n - 1];
        let is_reached = |wall: &Wall| {
            let reached: HashSet<usize> = wall.on.iter().map(|&state| movement[state]).collect();
            reached.len() as f64 >= MOVEMENTS * movements && wall.width >= WIDE * widest
        };
        let planes = (0..PLANES).filter_map(|plane| Wall::through(&states, &spread_out(plane, n, chosen.len())));
        planes.filter(is_reached).max_by(|a, b| a.density().total_cmp(&b.density()))
    }

    /// The plane through these states, fitted anew to the states near it, if it is like a wall.
    fn through(states: &DMatrix<f64>, through: &[usize]) -> Option<Wall> {
        let n = states.nrows();
        let few = states.select_columns(through);
        let (mut at, mut normal) = (few.column_mean(), principal(&few).1);
        let mut heights = heights(states, &at, &normal);
        let mut thickness = THIN * heights.amax();
        let mut width = 0.0;
        for _ in 0..FITS {
            let near = near(&heights, thickness);
            if near.len() < 5 * n || (near.len() as f64) < 0.5 * SHARE * heights.len() as f64 {
                return None;
            }
            let on = states.select_columns(&near);
            at = on.column_mean();
            let (spreads, least) = principal(&on);
            normal = least;
            width = spreads[1];
            heights = self::heights(states, &at, &normal);
            let median = upper_median(near.iter().map(|&k| heights[k].abs()).collect())?;
            // Of a normal distribution, with room for what was cut off.
            thickness = (1.1 * 1.4826 * median).max(1e-6 * heights.amax());
        }
        let side = -heights.sum().signum();
        let (on, farthest, all) = (near(&heights, thickness), heights.amax(), heights.len() as f64);
        let share = on.len() as f64 / all;
        let beyond = heights.iter().filter(|&height| side * height > BEYOND * thickness).count() as f64 / all;
        let thinness = thickness / farthest;
        let is_wall = thinness < THIN && beyond < 0.01 && share >= SHARE.max(DENSE * thinness) && share < ALL;
        is_wall.then(|| Wall { normal: normal * side, at, thickness, farthest, on, share, width })
    }

    /// Share of the states over the thickness; differences below a five-hundredth of the way do not count.
    fn density(&self) -> f64 {
        self.share / (self.thickness / self.farthest + 0.002)
    }
}

/// Distances of states from a plane, negative behind it.
fn heights(states: &DMatrix<f64>, at: &DVector<f64>, normal: &DVector<f64>) -> DVector<f64> {
    states.tr_mul(normal).add_scalar(-normal.dot(at))
}

/// Which states lie on a plane.
fn near(heights: &DVector<f64>, thickness: f64) -> Vec<usize> {
    (0..heights.len()).filter(|&k| heights[k].abs() < NEAR * thickness).collect()
}

/// Standard deviations along the principal axes, rising, and the axis of the least.
fn principal(states: &DMatrix<f64>) -> (Vec<f64>, DVector<f64>) {
    let mean = states.column_mean();
    let mut centred = states.clone();
    centred.column_iter_mut().for_each(|mut x| x -= &mean);
    let eigen = (&centred * centred.transpose() / states.ncols() as f64).symmetric_eigen();
    let least = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
    let mut spreads: Vec<f64> = eigen.eigenvalues.iter().map(|&square| square.max(0.0).sqrt()).collect();
    spreads.sort_by(f64::total_cmp);
    (spreads, least)
}

/// Which states plane number `plane` goes through: point `plane` of a Kronecker sequence in n dimensions, which fills them evenly.
fn spread_out(plane: usize, n: usize, states: usize) -> Vec<usize> {
    // The root of xⁿ⁺¹ = x + 1, the golden ratio in one dimension.
    let ratio = (0..64).fold(2.0_f64, |root, _| (1.0 + root).powf(1.0 / (n + 1) as f64));
    let powers = std::iter::successors(Some(1.0 / ratio), |power| Some(power / ratio));
    let places = powers.take(n).map(|power| ((plane + 1) as f64 * power).fract() * states as f64);
    places.map(|place| (place as usize).min(states - 1)).collect()
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Movements of π(x) = −x with noise of positions, and the wall n·x ≤ level, n·x of all starts being less.
    fn movements(normal: &DVector<f64>, level: Option<f64>, noise: f64, rng: &mut ChaCha8Rng) -> Rows {
        let n = normal.len();
        let (mut states, mut velocities, mut indices) = (vec![], vec![], vec![]);
        for trajectory in 0..15 {
            let mut x = DVector::from_fn(n, |_, _| rng.random_range(-2.0..2.0f64));
            if let Some(level) = level {
                x -= normal * (normal.dot(&x) - level).max(0.0) * rng.random_range(1.1..2.0);
            }
            for sample in 0..30 {
                let mut velocity = -&x;
                if level.is_some_and(|level| normal.dot(&x) >= level) {
                    velocity -= normal * normal.dot(&velocity).max(0.0);
                }
                states.push(&x + DVector::from_fn(n, |_, _| noise * rng.random_range(-1.7..1.7)));
                velocities.push(velocity.clone());
                indices.push(SampleIndex { trajectory, sample });
                x += velocity * 0.07;
                if let Some(level) = level {
                    x -= normal * (normal.dot(&x) - level).max(0.0);
                }
            }
        }
        Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6))]

        /// A wall in the way is found, with its normal and place; movements without one have none.
        #[test]
        fn a_wall_is_found(seed in any::<u64>(), n in 2..5usize, level in -1.0..-0.3f64, noise in 0.0..0.03f64, there in any::<bool>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let normal = DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0f64)).normalize();
            let rows = movements(&normal, there.then_some(level), noise, &mut rng);
            let found = Wall::of(&rows, n);
            prop_assert_eq!(found.is_some(), there);
            if let Some(Wall { normal: found, at, share, .. }) = found {
                prop_assert!(found.dot(&normal) > 0.99, "{found} instead of {normal}");
                prop_assert!((found.dot(&at) - level).abs() < 0.05);
                prop_assert!(share > 0.3, "{share}");
            }
        }
    }
}
