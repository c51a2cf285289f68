//! The search for a plane that many movements reach and none crosses (S47).
//!
//! It takes O(planes × fits × states × n²) operations.

use std::collections::HashSet;

use motion::upper_median;
use nalgebra::{DMatrix, DVector};

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
/// If the share exceeds this, all states lie in one plane that no movement leaves.
const ALL: f64 = 0.95;
/// Least share of the movements that reach the wall.
const MOVEMENTS: f64 = 0.5;
/// Least standard deviation along a wall, as a share of the largest one of all states; a smaller one is a goal.
const WIDE: f64 = 0.2;
/// The same if the standard deviation along the wall is this multiple of that across it: states at a goal spread alike in all directions.
const FLAT_WIDE: f64 = 0.1;
const FLAT: f64 = 10.0;

/// A plane that states of many movements lie on and none lie beyond: a table, a fence or a joint's stop.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// Unit normal, pointing out of the region of the states, (n).
    pub normal: DVector<f64>,
    /// A point on the plane, (n), in the units of the states.
    pub at: DVector<f64>,
    /// Standard deviation of the states on the plane along its normal.
    pub thickness: f64,
    /// Largest distance of a state from the plane.
    pub farthest: f64,
    /// Share of the states that lie on the plane.
    pub share: f64,
}

impl Wall {
    /// The most densely populated wall among `states` (n, N); `movement` holds the number of each state's movement, (N).
    /// Trial planes pass through n states each, spread evenly over all by a fixed sequence, so the result is deterministic. Such a trial
    /// succeeds if all n states lie on the wall, which is rare for large n. Further ones are the outermost planes across each axis, on which
    /// joints' stops and tables lie. `None` for n < 2.
    pub fn of(states: &DMatrix<f64>, movement: &[usize]) -> Option<Wall> {
        let (n, count) = states.shape();
        if n < 2 || count == 0 {
            return None;
        }
        let movements = movement.iter().collect::<HashSet<_>>().len() as f64;
        let all: Vec<usize> = (0..count).collect();
        let widest = Plane::fitted(states, &all).deviations[n - 1];
        let mut heights = vec![0.0; count];
        let through = (0..PLANES).map(|number| Plane::fitted(states, &spread_out(number, n, count)));
        let outermost = (0..n).flat_map(|axis| Plane::outermost(states, axis));
        let candidates = through.chain(outermost).filter_map(|plane| {
            let (wall, on, deviations) = plane.refined(states, &mut heights)?;
            let reached: HashSet<usize> = on.into_iter().map(|state| movement[state]).collect();
            let is_flat = deviations[1] >= FLAT * deviations[0];
            let is_wide = deviations[1] >= if is_flat { FLAT_WIDE } else { WIDE } * widest;
            (reached.len() as f64 >= MOVEMENTS * movements && is_wide).then_some(wall)
        });
        candidates.max_by(|a, b| a.density().total_cmp(&b.density()))
    }

    /// Share of the states over the thickness; differences below a five-hundredth of the way do not count.
    fn density(&self) -> f64 {
        self.share / (self.thickness / self.farthest + 0.002)
    }
}

/// A plane through the mean of some states, across their direction of least variance.
struct Plane {
    at: DVector<f64>,
    normal: DVector<f64>,
    /// Standard deviations of the states along their principal axes, ascending; the first is that along the normal.
    deviations: Vec<f64>,
}

impl Plane {
    fn fitted(states: &DMatrix<f64>, chosen: &[usize]) -> Plane {
        let (n, count) = (states.nrows(), chosen.len() as f64);
        let state = |k: usize| &states.as_slice()[k * n..][..n];
        let mut at = DVector::zeros(n);
        for &k in chosen {
            at.iter_mut().zip(state(k)).for_each(|(sum, x)| *sum += x);
        }
        at /= count;
        let mut scatter = DMatrix::zeros(n, n);
        for &k in chosen {
            for (j, (xj, mj)) in state(k).iter().zip(&at).enumerate() {
                for (i, (xi, mi)) in state(k).iter().zip(&at).enumerate().skip(j) {
                    scatter[(i, j)] += (xi - mi) * (xj - mj);
                }
            }
        }
        scatter.fill_upper_triangle_with_lower_triangle();
        let eigen = (scatter / count).symmetric_eigen();
        let normal = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
        let mut deviations: Vec<f64> = eigen.eigenvalues.iter().map(|&square| square.max(0.0).sqrt()).collect();
        deviations.sort_by(f64::total_cmp);
        Plane { at, normal, deviations }
    }

    /// The planes across an axis through its largest and smallest coordinate.
    fn outermost(states: &DMatrix<f64>, axis: usize) -> [Plane; 2] {
        let row = states.row(axis).transpose();
        [row.imax(), row.imin()].map(|outermost| Plane {
            at: states.column(outermost).into_owned(),
            normal: DVector::from_fn(states.nrows(), |other, _| f64::from(u8::from(other == axis))),
            deviations: Vec::new(),
        })
    }

    /// Refits the plane to the states near it, several times. Returns a wall with the states on it and their standard deviations along
    /// the principal axes, ascending, unless the plane is no wall. `heights` is overwritten, (N).
    fn refined(mut self, states: &DMatrix<f64>, heights: &mut [f64]) -> Option<(Wall, Vec<usize>, Vec<f64>)> {
        let (n, all) = (states.nrows(), heights.len() as f64);
        let mut farthest = self.heights(states, heights);
        let mut thickness = THIN * farthest;
        for _ in 0..FITS {
            let near = near(heights, thickness);
            if near.len() < 5 * n || (near.len() as f64) < 0.5 * SHARE * all {
                return None;
            }
            self = Plane::fitted(states, &near);
            farthest = self.heights(states, heights);
            let median = upper_median(near.iter().map(|&k| heights[k].abs()).collect())?;
            // Of a normal distribution, with room for what was cut off.
            thickness = (1.1 * 1.4826 * median).max(1e-6 * farthest);
        }
        let side = -heights.iter().sum::<f64>().signum();
        let on = near(heights, thickness);
        let share = on.len() as f64 / all;
        let beyond = heights.iter().filter(|&height| side * height > BEYOND * thickness).count() as f64 / all;
        let thinness = thickness / farthest;
        let is_wall = thinness < THIN && beyond < 0.01 && share >= SHARE.max(DENSE * thinness) && share < ALL;
        let wall = Wall { normal: self.normal * side, at: self.at, thickness, farthest, share };
        is_wall.then_some((wall, on, self.deviations))
    }

    /// Writes the distances of all states from the plane, negative behind it, and returns the largest absolute one.
    fn heights(&self, states: &DMatrix<f64>, heights: &mut [f64]) -> f64 {
        let level = self.normal.dot(&self.at);
        let mut farthest = 0.0f64;
        for (height, state) in heights.iter_mut().zip(states.as_slice().chunks_exact(states.nrows())) {
            *height = state.iter().zip(&self.normal).map(|(x, n)| x * n).sum::<f64>() - level;
            farthest = farthest.max(height.abs());
        }
        farthest
    }
}

/// The states that lie on a plane.
fn near(heights: &[f64], thickness: f64) -> Vec<usize> {
    (0..heights.len()).filter(|&k| heights[k].abs() < NEAR * thickness).collect()
}

/// The states that plane `number` passes through: point `number` of a Kronecker sequence in n dimensions, which fills them evenly.
fn spread_out(number: usize, n: usize, states: usize) -> Vec<usize> {
    // The root of xⁿ⁺¹ = x + 1, the golden ratio in one dimension.
    let ratio = (0..64).fold(2.0_f64, |root, _| (1.0 + root).powf(1.0 / (n + 1) as f64));
    let powers = std::iter::successors(Some(1.0 / ratio), |power| Some(power / ratio));
    let places = powers.take(n).map(|power| ((number + 1) as f64 * power).fract() * states as f64);
    places.map(|place| (place as usize).min(states - 1)).collect()
}
