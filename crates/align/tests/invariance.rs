//! Invariances of the alignment, and quantities that scale with the data.

use crate::drawn;
use align::{AlignError, Aligned, Bandwidth, Integration, PolicyAlign};
use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::collection::vec;
use proptest::prelude::*;

fn align(
    demonstrations: &Demonstrations,
    integration: Integration,
    bandwidth: Bandwidth,
) -> Result<Aligned, AlignError> {
    PolicyAlign { integration, bandwidth, ..Default::default() }.align(demonstrations)
}

/// Whether λ₂ is so far from the threshold that rounding cannot decide which trajectories are kept, and offsets are
/// accurate.
fn firm(aligned: &Aligned) -> bool {
    aligned.lambda_2().is_none_or(|lambda_2| lambda_2 > 1e-6) && aligned.groups().len() == 1
}

fn same(a: &DVector<f64>, b: &DVector<f64>, tolerance: f64) -> bool {
    a.len() == b.len() && (a - b).amax() <= tolerance * (1.0 + a.amax())
}

proptest! {
    #[test]
    fn order(
        demonstrations in drawn::demonstrations(2), integration in drawn::integration(), bandwidth in drawn::bandwidth(),
        order in Just((0..8).collect::<Vec<usize>>()).prop_shuffle(),
    ) {
        let count = demonstrations.n_trajectories();
        let order: Vec<usize> = order.into_iter().filter(|&k| k < count).collect();
        let shuffled = order.iter().map(|&k| demonstrations.trajectories()[k].clone()).collect();
        let aligned = align(&demonstrations, integration, bandwidth).unwrap();
        let again = align(&Demonstrations::new(shuffled).unwrap(), integration, bandwidth).unwrap();

        prop_assert_eq!(aligned.sigma_squared(), again.sigma_squared());
        let permuted = aligned.objective().unwrap().laplacian.select_rows(&order).select_columns(&order);
        prop_assert!((permuted - &again.objective().unwrap().laplacian).amax() < 1e-12);
        if firm(&aligned) {
            let offsets = DVector::from_iterator(count, order.iter().map(|&k| aligned.offset(k).unwrap()));
            prop_assert!(same(&offsets, again.offsets(), 1e-9));
        }
    }

    #[test]
    fn rotation_and_translation(
        demonstrations in drawn::demonstrations(2), integration in drawn::integration(), bandwidth in drawn::bandwidth(),
        basis in vec(-1.0..1.0, 49), shift in vec(-3.0..3.0, 7),
    ) {
        let n = demonstrations.dim();
        let rotation = DMatrix::from_column_slice(n, n, &basis[..n * n]).qr().q();
        let shift = DVector::from_column_slice(&shift[..n]);
        let turn = |x: &DMatrix<f64>| &rotation * x;
        let moved = drawn::mapped(&demonstrations, |x| {
            let mut moved = turn(x);
            moved.column_iter_mut().for_each(|mut column| column += &shift);
            moved
        }, turn);
        let aligned = align(&demonstrations, integration, bandwidth).unwrap();
        let again = align(&moved, integration, bandwidth).unwrap();

        prop_assert!((aligned.sigma_squared() - again.sigma_squared()).abs() <= 1e-9 * aligned.sigma_squared());
        if firm(&aligned) {
            prop_assert_eq!(aligned.kept(), again.kept());
            prop_assert!(same(aligned.offsets(), again.offsets(), 1e-6));
        }
    }

    #[test]
    fn scale(
        demonstrations in drawn::demonstrations(2), integration in drawn::integration(), bandwidth in drawn::bandwidth(),
        exponent in -40..40,
    ) {
        // By a power of two, so that rounding scales too and every bit must agree.
        let c = 2.0_f64.powi(exponent);
        let scaled = drawn::mapped(&demonstrations, |x| x * c, |u| u * c);
        let scaled_bandwidth = match bandwidth {
            Bandwidth::Fixed(sigma_squared) => Bandwidth::Fixed(c * c * sigma_squared),
            other => other,
        };
        let aligned = align(&demonstrations, integration, bandwidth).unwrap();
        let again = align(&scaled, integration, scaled_bandwidth).unwrap();

        prop_assert_eq!(c * c * aligned.sigma_squared(), again.sigma_squared());
        prop_assert_eq!(&aligned.objective().unwrap().laplacian, &again.objective().unwrap().laplacian);
        prop_assert_eq!(aligned.groups(), again.groups());
        prop_assert_eq!(c * c * aligned.offsets(), again.offsets().clone());
    }

    #[test]
    fn exact_potentials_that_meet_are_levelled_exactly(
        walks in vec((0i32..6, 0i32..6, vec((0usize..2, any::<bool>()), 3..25)), 2..10), slope in vec(-1.0..1.0, 2),
        curvature in 0.01..0.5,
    ) {
        // Walks on the points of a grid, which coincide exactly where they meet; the bandwidth is so small that nothing
        // else contributes. Velocities are such that uᵀdx is the exact decrease of φ.
        let phi = |x: &DVector<f64>| curvature * x.norm_squared() + slope[0] * x[0] + slope[1] * x[1];
        let trajectories = walks.iter().map(|(row, column, steps)| {
            let mut x = DVector::from_vec(vec![f64::from(*row), f64::from(*column)]);
            let mut states = vec![x.clone()];
            for &(dimension, forward) in steps {
                x[dimension] += if forward { 1.0 } else { -1.0 };
                states.push(x.clone());
            }
            let velocity = |i: usize| match states.get(i + 1) {
                Some(next) => (next - &states[i]) * (phi(&states[i]) - phi(next)),
                None => DVector::zeros(2),
            };
            let velocities: Vec<_> = (0..states.len()).map(velocity).collect();
            let trajectory = motion::Trajectory::new(DMatrix::from_columns(&states), 0.3).unwrap();
            trajectory.with_velocities(DMatrix::from_columns(&velocities)).unwrap()
        });
        let demonstrations = Demonstrations::new(trajectories.collect()).unwrap();
        let aligned = align(&demonstrations, Integration::Work, Bandwidth::Fixed(0.005)).unwrap();
        let misses: Vec<f64> = aligned.samples().into_iter().map(|(x, level)| level - phi(&x.into_owned())).collect();
        prop_assert!(misses.iter().all(|miss| (miss - misses[0]).abs() < 1e-10), "{misses:?}");
    }
}

/// Time steps enter individually: with uneven stamps, the potential decreases by the work of each step at its own
/// speed.
#[test]
fn uneven_stamps() {
    let states = DMatrix::from_row_slice(1, 4, &[0.0, 1.0, 3.0, 4.0]);
    let velocities = DMatrix::from_row_slice(1, 4, &[2.0, 1.0, 3.0, 5.0]);
    let trajectory = Trajectory::new(states, 1.0).unwrap().with_velocities(velocities).unwrap();
    let trajectory = trajectory.with_times(vec![0.0, 0.5, 2.5, 2.75]).unwrap();
    let demonstrations = Demonstrations::new(vec![trajectory]).unwrap();
    let values = |integration: Integration| integration.potentials(&demonstrations).unwrap().remove(0);
    assert_eq!(values(Integration::Displacement), [0.0, -2.0, -4.0, -8.0]);
    assert_eq!(values(Integration::Velocity), [0.0, -2.0, -4.0, -6.25]);
    assert_eq!(values(Integration::Work), [0.0, -2.0, -4.0, -7.0]);
}
