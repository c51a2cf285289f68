//! A plane that contains all movements, found from positions alone, without a policy.

use motion::{Demonstrations, upper_median};
use nalgebra::{DMatrix, DVector};
use prepare::numbers::short;

use super::{add_scatter, as_recorded, equation, parts};
use crate::{Finding, StateChannel};

/// Largest ratio of the thickness to the next larger extent.
const FLAT: f64 = 0.03;

/// The plane, in the units of the recording.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CommonPlane {
    /// Normal of unit length with a positive largest entry, (n).
    pub(crate) normal: DVector<f64>,
    /// Median over the movements of the coordinate along the normal.
    pub(crate) level: f64,
    /// Largest deviation of a movement from this level.
    pub(crate) apart: f64,
    /// Standard deviation of the normal's angle, radians.
    pub(crate) angle: f64,
    /// Standard deviation of positions across the plane.
    pub(crate) thickness: f64,
}

impl CommonPlane {
    /// (S30): the normal is the eigenvector with the least eigenvalue of the scatter of positions about their movements' means.
    /// `None` unless positions hardly vary along it and vary in all other directions.
    pub(crate) fn of(demonstrations: &Demonstrations, state: &[StateChannel]) -> Option<CommonPlane> {
        let movements = demonstrations.trajectories();
        let dim = demonstrations.dim();
        let freedom = demonstrations.n_samples().checked_sub(movements.len() + dim)?;
        let mut scatter = DMatrix::zeros(dim, dim);
        for movement in movements {
            add_scatter(&mut scatter, movement.states());
        }
        scatter.fill_upper_triangle_with_lower_triangle();
        let eigen = scatter.symmetric_eigen();
        let mut order: Vec<usize> = (0..dim).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let (&least, others) = order.split_first()?;
        let &next = others.first()?;
        let [thin, wide] = [least, next].map(|k| (eigen.eigenvalues[k].max(0.0) / freedom.max(1) as f64).sqrt());
        let widest = (eigen.eigenvalues.max() / freedom.max(1) as f64).sqrt();
        if freedom == 0 || thin > FLAT * wide || wide < FLAT * widest || wide == 0.0 {
            return None;
        }
        let tilt: f64 = others.iter().map(|&k| thin.powi(2) / eigen.eigenvalues[k]).sum();
        let scaled = eigen.eigenvectors.column(least).into_owned();
        let (normal, length) = as_recorded(&scaled, state);
        let levels: Vec<f64> =
            movements.iter().map(|movement| scaled.dot(&movement.states().column_mean()) / length).collect();
        let level = upper_median(levels.clone())?;
        let apart = levels.iter().map(|own| (own - level).abs()).fold(0.0, f64::max);
        Some(CommonPlane { normal, level, apart, angle: tilt.sqrt(), thickness: thin / length.abs() })
    }

    /// A remark that describes the plane or planes.
    pub(crate) fn finding(&self, state: &[StateChannel]) -> Finding {
        let plane = parts(&self.normal, state);
        let angle = short(self.angle.to_degrees());
        let what = if self.apart <= 5.0 * self.thickness.max(1e-9 * self.level.abs()) {
            format!("all movements stay at {} (normal ± {angle}°)", equation(&self.normal, self.level, state))
        } else {
            format!("every movement keeps its own value of {plane} (normal ± {angle}°)")
        };
        let next =
            "a constraint common to all, or a policy that never moves across: record movements that do".to_owned();
        Finding::remark(what, next)
    }
}

#[cfg(test)]
mod tests {
    use motion::Trajectory;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::super::channels;
    use super::*;

    /// Circles by hand in the plane with this normal and level, with noise of positions.
    fn circled(normal: &DVector<f64>, level: f64, noise: f64, rng: &mut ChaCha8Rng) -> Demonstrations {
        let others = DMatrix::from_fn(3, 2, |_, _| rng.random_range(-1.0..1.0f64));
        let basis = DMatrix::from_columns(&[normal.clone(), others.column(0).into(), others.column(1).into()]).qr().q();
        let movements = (0..8).map(|_| {
            let (radius, phase): (f64, f64) = (rng.random_range(0.1..0.3), rng.random_range(0.0..6.0));
            let states = DMatrix::from_columns(
                &(0..60)
                    .map(|at| {
                        let angle = phase + 0.1 * f64::from(at);
                        let inside =
                            basis.column(1) * (radius * angle.cos()) + basis.column(2) * (radius * angle.sin());
                        let off = DVector::from_fn(3, |_, _| noise * rng.random_range(-1.7..1.7));
                        normal * level + inside + off
                    })
                    .collect::<Vec<_>>(),
            );
            Trajectory::new(states, 0.02).unwrap()
        });
        Demonstrations::new(movements.collect()).unwrap()
    }

    proptest! {
        /// The plane of circles by hand is found to within a degree, with its level.
        #[test]
        fn a_circled_plane_is_named(seed in any::<u64>(), level in -0.5f64..0.5) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let normal = DVector::from_fn(3, |_, _| rng.random_range(-1.0..1.0f64)).normalize();
            let plane = CommonPlane::of(&circled(&normal, level, 0.002, &mut rng), &channels()).unwrap();
            let sign = plane.normal.dot(&normal).signum();
            let off = (&plane.normal * sign - &normal).norm().to_degrees();
            prop_assert!(off < 1.0, "{off} degrees");
            prop_assert!(off < 5.0 * plane.angle.to_degrees());
            prop_assert!((plane.level * sign - level).abs() < 0.003);
            prop_assert!(plane.finding(&channels()).what.starts_with("all movements stay at"));
        }

        /// Movements in all directions, or along a line, have no common plane.
        #[test]
        fn other_movements_have_no_plane(seed in any::<u64>(), line in any::<bool>()) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let along = DVector::from_fn(3, |_, _| rng.random_range(-1.0..1.0f64));
            let movement = |_| {
                let mut state = |at: usize| {
                    if line { &along * at as f64 } else { DVector::from_fn(3, |_, _| rng.random_range(-1.0..1.0f64)) }
                };
                Trajectory::new(DMatrix::from_columns(&(0..30).map(&mut state).collect::<Vec<_>>()), 0.1).unwrap()
            };
            let movements: Vec<Trajectory> = (0..4).map(movement).collect();
            prop_assert_eq!(CommonPlane::of(&Demonstrations::new(movements).unwrap(), &channels()), None);
        }
    }
}
