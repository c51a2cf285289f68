//! A plane that many movements reach and none crosses: a table, a fence or a joint's stop.

use std::collections::HashSet;

use gp::Rows;
use motion::upper_median;
use nalgebra::{DMatrix, DVector};
use prepare::numbers::percent;

use super::{as_recorded, equation, some_of};
use crate::{Finding, Prepared, VelocitySource, Verdict};

/// Largest dimension n: trial planes pass through n states, all of which must lie on the wall.
const DIMENSIONS: usize = 4;
/// Largest number of states.
const STATES: usize = 2000;
/// Number of trial planes.
const PLANES: usize = 400;
/// Number of times that each is refitted to the states near it.
const FITS: usize = 6;
/// States within this many standard deviations lie on the plane.
const NEAR: f64 = 2.5;
/// States farther than this many standard deviations are beyond it, at most one in a hundred.
const BEYOND: f64 = 3.5;
/// Largest standard deviation of the states on a wall, relative to the largest distance of a state.
const THIN: f64 = 0.03;
/// Least share of the states on a wall, and the least ratio of this share to their standard deviation relative to the largest distance.
const SHARE: f64 = 0.2;
const DENSE: f64 = 20.0;
/// If the share exceeds this, all states lie in one plane: see [`CommonPlane`](super::CommonPlane).
const ALL: f64 = 0.95;
/// Least share of the movements that reach the wall.
const MOVEMENTS: f64 = 0.5;
/// Least extent along a wall, as a share of the largest extent of all states; a smaller one is a goal.
const WIDE: f64 = 0.2;
/// Largest standard deviation of the states on a wall: factors of the noise of positions, as recorded or smoothed, plus a share of the
/// largest distance. Movements that converge to a straight path are less exact.
const NOISE: f64 = 1.3;
const SMOOTHED_NOISE: f64 = 0.6;
const EXACT: f64 = 0.001;
/// Share by which the policy differs from one without constraints; above it, the policy was not misled by the wall.
const DIFFERS: f64 = 0.25;

/// A plane fitted to the states near it, in the learner's units.
struct Wall {
    /// Normal of unit length, pointing outwards, (n).
    normal: DVector<f64>,
    /// A point on the plane, (n).
    at: DVector<f64>,
    /// Standard deviation of the states on it.
    thickness: f64,
    /// The largest distance of a state.
    farthest: f64,
    /// Indices of the states on the plane, and their share.
    on: Vec<usize>,
    share: f64,
    /// Least standard deviation along the plane.
    width: f64,
}

/// A finding if movements reach a plane that none crosses (S47), and the policy differs little, by `gap`, from one without constraints.
/// An obstacle there may hide where the policy goes.
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
    /// (S47), from at most [`STATES`] rows. The trial planes pass through deterministic, evenly spread states.
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

    /// The plane through these states, refitted to the states near it, if it resembles a wall.
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
            // Standard deviation of a normal distribution, enlarged to compensate for the truncation.
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

    /// Share of the states per thickness; thicknesses far below a five-hundredth of the largest distance count alike.
    fn density(&self) -> f64 {
        self.share / (self.thickness / self.farthest + 0.002)
    }
}

/// Signed distances of states from a plane, negative behind it.
fn heights(states: &DMatrix<f64>, at: &DVector<f64>, normal: &DVector<f64>) -> DVector<f64> {
    states.tr_mul(normal).add_scalar(-normal.dot(at))
}

/// Indices of the states on a plane.
fn near(heights: &DVector<f64>, thickness: f64) -> Vec<usize> {
    (0..heights.len()).filter(|&k| heights[k].abs() < NEAR * thickness).collect()
}

/// Standard deviations along the principal axes, ascending, and the axis of the least.
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

/// States that define trial plane number `plane`: point `plane` of a Kronecker sequence in n dimensions, which fills them evenly.
fn spread_out(plane: usize, n: usize, states: usize) -> Vec<usize> {
    // The root of xⁿ⁺¹ = x + 1; in one dimension this is the golden ratio.
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

    /// Movements of π(x) = −x with noise of positions, and the wall n·x ≤ level; all starts satisfy n·x < level.
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

        /// A wall in the way is found, with its normal and position; without a wall none is found.
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
