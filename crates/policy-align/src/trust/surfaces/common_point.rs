//! Straight movements through one point: rails through a hub or a trocar look like free movements to or from it.

use motion::{Demonstrations, Trajectory, upper_median};
use nalgebra::{DMatrix, DVector};
use prepare::numbers::short;

use super::{add_scatter, some_of};
use crate::{Finding, StateChannel};

/// Largest standard deviation of a straight movement's positions across its line, as a share of that along it.
const STRAIGHT: f64 = 0.05;
/// Shorter movements than this share of the usual length, from first to last position, are not compared: noise bends them.
const LONG: f64 = 0.2;
/// Maximum number of samples of a movement that determine its line, evenly spread.
const SAMPLES: usize = 100;
/// Least share of the others that are straight, and their least number.
const SHARE: f64 = 0.9;
const FEW: usize = 5;
/// Largest distance of the lines from the point, relative to that of their movements' means.
const MEET: f64 = 0.05;
/// Least mean square of a direction across the lines; along parallel lines, the point is undetermined.
const ACROSS: f64 = 0.02;
/// If a smaller share of the ways leads towards the point, it is the start. If a smaller share leads away from it, it is the goal …
const ONE_WAY: f64 = 0.02;
/// … unless at least this share of the movements comes to rest before it or beyond it: at this share of its first distance, and in the last
/// tenth of its time with less than this share of its mean speed.
const ELSEWHERE: f64 = 0.1;
const SHORT: f64 = 0.2;
const SLOW: f64 = 0.3;
/// A smaller coordinate of the point, relative to the usual length, is 0.
const ZERO: f64 = 1e-6;

/// The line of a straight movement.
struct Line {
    /// Mean of the positions, (n).
    mean: DVector<f64>,
    /// I − d dᵀ, where d is the unit direction, (n, n).
    across: DMatrix<f64>,
    /// The movement's first and last positions along d, relative to the mean.
    ends: (f64, f64),
    /// Speed along d in the last tenth, relative to the mean speed.
    last_speed: f64,
    direction: DVector<f64>,
}

impl Line {
    fn of(movement: &Trajectory) -> Option<Line> {
        let (n, count) = (movement.states().nrows(), movement.n_samples());
        let mut scatter = DMatrix::zeros(n, n);
        let mean = add_scatter(&mut scatter, &movement.states().select_columns(&some_of(count, SAMPLES)));
        scatter.fill_upper_triangle_with_lower_triangle();
        let eigen = scatter.symmetric_eigen();
        let largest = eigen.eigenvalues.imax();
        let along = eigen.eigenvalues[largest];
        let straight = eigen.eigenvalues.sum() - along <= STRAIGHT.powi(2) * along;
        let direction = eigen.eigenvectors.column(largest).into_owned();
        let end = |at: usize| direction.dot(&(movement.state(at) - &mean));
        let last = count - 1;
        let ends = (end(0), end(last));
        let tenth = last.div_ceil(10);
        let last_speed = (ends.1 - end(last - tenth)).abs() / tenth as f64 / ((ends.1 - ends.0).abs() / last as f64);
        let across = DMatrix::identity(n, n) - &direction * direction.transpose();
        (along > 0.0 && straight).then_some(Line { mean, across, ends, last_speed, direction })
    }

    /// The first and last positions along d, relative to the point.
    fn ends_from(&self, point: &DVector<f64>) -> (f64, f64) {
        let at = self.direction.dot(&(point - &self.mean));
        (self.ends.0 - at, self.ends.1 - at)
    }

    /// Whether the movement comes to rest before the point or beyond it.
    fn rests_elsewhere(&self, point: &DVector<f64>) -> bool {
        let (first, last) = self.ends_from(point);
        last.abs() > SHORT * first.abs() && self.last_speed < SLOW
    }

    /// How far the movement approaches the point, and how far it leaves it, along the line.
    fn ways(&self, point: &DVector<f64>) -> (f64, f64) {
        let (first, last) = self.ends_from(point);
        if first * last < 0.0 {
            return (first.abs(), last.abs());
        }
        let nearer = first.abs() - last.abs();
        (nearer.max(0.0), (-nearer).max(0.0))
    }
}

/// A finding if movements are straight and lead through one point that is neither their goal nor their start. The point c minimises the
/// squared distances of the lines, Σ |(I − d dᵀ)(c − x̄)|² over the movements with mean x̄ and direction d.
pub(crate) fn common_point(demonstrations: &Demonstrations, state: &[StateChannel]) -> Option<Finding> {
    if demonstrations.n_trajectories() < FEW {
        return None;
    }
    let length = |movement: &Trajectory| (movement.state(movement.n_samples() - 1) - movement.state(0)).norm();
    let usual = upper_median(demonstrations.trajectories().iter().map(length).collect())?;
    let movements: Vec<&Trajectory> =
        demonstrations.trajectories().iter().filter(|movement| length(movement) > LONG * usual).collect();
    let lines: Vec<Line> = movements.iter().copied().filter_map(Line::of).collect();
    let (n, count) = (demonstrations.dim(), lines.len() as f64);
    if n < 2 || lines.len() < FEW || count < SHARE * movements.len() as f64 {
        return None;
    }
    let across: DMatrix<f64> = lines.iter().map(|line| &line.across).sum::<DMatrix<f64>>() / count;
    let target: DVector<f64> = lines.iter().map(|line| &line.across * &line.mean).sum::<DVector<f64>>() / count;
    if across.clone().symmetric_eigenvalues().min() < ACROSS {
        return None;
    }
    let point = across.cholesky()?.solve(&target);
    let off: f64 = lines.iter().map(|line| (&line.across * (&point - &line.mean)).norm_squared()).sum();
    let far: f64 = lines.iter().map(|line| (&point - &line.mean).norm_squared()).sum();
    let (towards, away) = lines.iter().map(|line| line.ways(&point)).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    let is_start = towards < ONE_WAY * (towards + away);
    let elsewhere = lines.iter().filter(|line| line.rests_elsewhere(&point)).count() as f64;
    let is_goal = away < ONE_WAY * (towards + away) && elsewhere < ELSEWHERE * count;
    if off > MEET.powi(2) * far || is_start || is_goal {
        return None;
    }
    let exact = |c: f64| if c.abs() < ZERO * usual { 0.0 } else { c };
    let place = point.iter().zip(state);
    let place = place.map(|(c, channel)| format!("{} {}", channel.name, short(exact(*c) / channel.scale)));
    Some(Finding::doubt(
        format!(
            "movements are straight and lead through one point ({}), but do not all end or begin there",
            place.collect::<Vec<_>>().join(", ")
        ),
        "if rails or a pivot there guide the hand, they hide the policy across: record movements beside them",
    ))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::super::channels;
    use super::*;

    /// Movements of π(x) = −x, or of π(x) = x if `out`, along lines through `hub` or free, with noise of positions.
    fn movements(hub: Option<&DVector<f64>>, out: bool, noise: f64, rng: &mut ChaCha8Rng) -> Demonstrations {
        let movement = |_| {
            let start = DVector::from_fn(3, |_, _| rng.random_range(-2.0..2.0f64));
            let rail = hub.map(|hub| (&start - hub).normalize());
            let mut x = start;
            let states = (0..80).map(|_| {
                let velocity = rail.as_ref().map_or_else(|| -&x, |rail| -rail * rail.dot(&x));
                x += velocity * if out { -0.02 } else { 0.05 };
                &x + DVector::from_fn(3, |_, _| noise * rng.random_range(-1.7..1.7))
            });
            Trajectory::new(DMatrix::from_columns(&states.collect::<Vec<_>>()), 0.05).unwrap()
        };
        Demonstrations::new((0..20).map(movement).collect()).unwrap()
    }

    proptest! {
        /// Rails through a point are named with the point; free straight movements to a goal or from a start are not.
        #[test]
        fn rails_through_a_point_are_named(seed in any::<u64>(), noise in 0.0..0.003f64) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let hub = DVector::from_fn(3, |_, _| rng.random_range(0.6..1.0f64));
            let found = common_point(&movements(Some(&hub), false, noise, &mut rng), &channels());
            let what = found.map(|found| found.what).unwrap_or_default();
            let x: f64 = what.split("(x ").nth(1).and_then(|rest| rest.split(',').next()?.parse().ok()).unwrap_or(f64::NAN);
            prop_assert!((x - hub[0]).abs() < 0.1, "{what}: {hub}");
            for out in [false, true] {
                prop_assert!(common_point(&movements(None, out, noise, &mut rng), &channels()).is_none());
            }
        }
    }
}
