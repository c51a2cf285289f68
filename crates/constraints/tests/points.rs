//! Points that stay in a plane or on a line, compared with the literal nᵀJ and with the motion of the point itself.

use std::{convert::Infallible, f64::consts::PI};

use constraints::{ConstraintError, PfaffianConstraint, PointConstraint};
use nalgebra::{DMatrix, DMatrixViewMut, DVector, DVectorView, Vector3, dmatrix, dvector};
use proptest::collection::vec;
use proptest::prelude::*;

/// An arm in space: link i of length `lengths[i]` rotates by qᵢ about the z axis for even i, the y axis for odd i.
#[derive(Debug, Clone)]
struct Arm {
    lengths: Vec<f64>,
}

impl Arm {
    /// The tip of the links from `first` on, relative to the base of the first.
    fn tip_from(&self, first: usize, q: DVectorView<'_, f64>) -> Vector3<f64> {
        let beyond = (first..self.lengths.len()).rev().fold(Vector3::zeros(), |tip, link| {
            nalgebra::Rotation3::from_axis_angle(&axis(link), q[link]) * (tip + Vector3::x() * self.lengths[link])
        });
        let turned = |point, link| nalgebra::Rotation3::from_axis_angle(&axis(link), q[link]) * point;
        (0..first).rev().fold(beyond, turned)
    }

    fn tip(&self, q: &DVector<f64>) -> Vector3<f64> {
        self.tip_from(0, q.as_view())
    }

    /// Column j: axis j, rotated by all joints before it, times the vector from joint j to the tip.
    #[allow(clippy::unnecessary_wraps, reason = "what a constraint is given may fail")]
    fn jacobian(&self, q: DVectorView<'_, f64>, mut jacobian: DMatrixViewMut<'_, f64>) -> Result<(), Infallible> {
        for joint in 0..self.lengths.len() {
            let turned = |axis, link| nalgebra::Rotation3::from_axis_angle(&self::axis(link), q[link]) * axis;
            let axis = (0..joint).rev().fold(axis(joint).into_inner(), turned);
            jacobian.column_mut(joint).copy_from(&axis.cross(&self.tip_from(joint, q)));
        }
        Ok(())
    }
}

fn axis(link: usize) -> nalgebra::Unit<Vector3<f64>> {
    if link.is_multiple_of(2) { Vector3::z_axis() } else { Vector3::y_axis() }
}

/// An arm, a configuration, one or two normals (k, 3) and a desired velocity (n).
fn case() -> impl Strategy<Value = (Arm, DVector<f64>, DMatrix<f64>, DVector<f64>)> {
    (3..7usize, 1..3usize).prop_flat_map(|(n, k)| {
        let arm = vec(0.3..1.5f64, n).prop_map(|lengths| Arm { lengths });
        let normals = vec(-2.0..2.0f64, 3 * k).prop_map(move |entries| DMatrix::from_vec(k, 3, entries));
        let far_from_zero = |normals: &DMatrix<f64>| normals.row_iter().all(|row| row.norm() > 0.1);
        let vector = |range: f64| vec(-range..range, n).prop_map(DVector::from_vec);
        (arm, vector(PI), normals.prop_filter("zero normals", far_from_zero), vector(1.0))
    })
}

proptest! {
    #[test]
    fn the_matrix_is_the_normals_times_the_jacobian((arm, q, normals, _) in case(), time in -9.0..9.0f64) {
        let n = q.len();
        let constraint = PointConstraint::new(normals.clone(), n, |q, j| arm.jacobian(q, j)).unwrap();
        let a = constraint.matrix(q.as_view(), time).unwrap();
        let mut jacobian = DMatrix::zeros(3, n);
        arm.jacobian(q.as_view(), jacobian.as_view_mut()).unwrap();
        for (row, normal) in normals.row_iter().enumerate() {
            for column in 0..n {
                let literal: f64 = (0..3).map(|d| normal[d] * jacobian[(d, column)]).sum();
                prop_assert!((a[(row, column)] - literal).abs() < 1e-13);
            }
        }
        prop_assert_eq!(constraint.dim(), n);
        prop_assert_eq!(constraint.normals(), &normals);
    }

    /// nᵀ(p(x + du) − p(x)) vanishes faster than du, and p moves in the free directions: only the desired motion along
    /// the normals is removed.
    #[test]
    fn the_point_stays_in_its_plane_or_on_its_line((arm, q, normals, wish) in case(), time in 0.0..9.0f64) {
        let constraint = PointConstraint::new(normals.clone(), q.len(), |q, j| arm.jacobian(q, j)).unwrap();
        let u = constraint.null_space_projector(q.as_view(), time).unwrap().project(wish.as_view());
        let d = 1e-5;
        let moved = arm.tip(&(&q + d * &u)) - arm.tip(&(&q - d * &u));
        for normal in normals.row_iter() {
            // Central differences: the error is of third order in d; arms are at most 9 long.
            let along = (normal * moved)[0] / normal.norm();
            prop_assert!(along.abs() / (2.0 * d) < 1e-7, "{along}");
        }
        let mut jacobian = DMatrix::zeros(3, q.len());
        arm.jacobian(q.as_view(), jacobian.as_view_mut()).unwrap();
        prop_assert!((jacobian * &u - moved / (2.0 * d)).amax() < 1e-7);
    }

    /// The lengths of the normals do not matter.
    #[test]
    fn lengths_of_normals_do_not_matter((arm, q, normals, wish) in case(), factor in 0.01..100.0f64) {
        let free = |normals| {
            let constraint = PointConstraint::new(normals, q.len(), |q, j| arm.jacobian(q, j)).unwrap();
            constraint.null_space_projector(q.as_view(), 0.0).unwrap()
        };
        let (one, other) = (free(normals.clone()), free(-factor * normals));
        prop_assert_eq!(one.rank(), other.rank());
        prop_assert!((one.project(wish.as_view()) - other.project(wish.as_view())).amax() < 1e-9);
    }
}

/// Two links stretched along x cannot move their tip along x: if the forbidden motion is impossible, the rank drops.
#[test]
fn a_stretched_arm_is_free_along_itself() {
    let tip = |q: DVectorView<'_, f64>, mut jacobian: DMatrixViewMut<'_, f64>| {
        let (a, b) = (q[0], q[0] + q[1]);
        jacobian.copy_from(&dmatrix![-a.sin() - b.sin(), -b.sin(); a.cos() + b.cos(), b.cos()]);
        Ok::<(), Infallible>(())
    };
    let along = PointConstraint::new(dmatrix![1.0, 0.0], 2, tip).unwrap();
    let across = PointConstraint::new(dmatrix![0.0, 1.0], 2, tip).unwrap();
    let on_a_point = PointConstraint::new(dmatrix![1.0, 0.0; 0.0, 1.0], 2, tip).unwrap();
    let rank = |constraint: &dyn PfaffianConstraint, q: DVector<f64>| {
        constraint.null_space_projector(q.as_view(), 0.0).unwrap().rank()
    };
    for (q, ranks) in [(dvector![0.0, 0.0], [0, 1, 1]), (dvector![0.3, 0.5], [1, 1, 2])] {
        let found = [rank(&along, q.clone()), rank(&across, q.clone()), rank(&on_a_point, q)];
        assert_eq!(found, ranks);
    }
}

#[test]
fn bad_points_are_refused() {
    let still = |_: DVectorView<'_, f64>, mut jacobian: DMatrixViewMut<'_, f64>| {
        jacobian.fill(0.0);
        Ok::<(), Infallible>(())
    };
    let refused = |normals| PointConstraint::new(normals, 2, still).err();
    assert_eq!(refused(DMatrix::zeros(0, 3)), Some(ConstraintError::NoNormal));
    assert_eq!(refused(DMatrix::zeros(1, 0)), Some(ConstraintError::NoNormal));
    assert_eq!(refused(dmatrix![0.0, 1.0; 0.0, 0.0]), Some(ConstraintError::Normal { row: 1, normal: vec![0.0, 0.0] }));
    assert_eq!(
        refused(dmatrix![f64::INFINITY, 1.0]),
        Some(ConstraintError::Normal { row: 0, normal: vec![f64::INFINITY, 1.0] })
    );
    assert!(matches!(refused(dmatrix![f64::NAN, 1.0]), Some(ConstraintError::Normal { row: 0, .. })));

    let silent = |_: DVectorView<'_, f64>, _: DMatrixViewMut<'_, f64>| Ok::<(), Infallible>(());
    let unknown = PointConstraint::new(dmatrix![1.0, 0.0], 2, silent).unwrap();
    let error = unknown.null_space_projector(dvector![0.0, 0.0].as_view(), 0.0).unwrap_err();
    assert!(matches!(error, ConstraintError::NotFinite { row: 0, column: 0, value } if value.is_nan()));
}

/// The reason for the error is passed on.
#[test]
fn jacobian_errors_pass_on_their_reason() {
    let broken = |_: DVectorView<'_, f64>, mut jacobian: DMatrixViewMut<'_, f64>| {
        jacobian.fill(1.0);
        Err("the encoder is dead")
    };
    let point = PointConstraint::new(dmatrix![1.0, 0.0], 2, broken).unwrap();
    let error = ConstraintError::Jacobian { reason: "the encoder is dead".to_owned() };
    let q = dvector![0.0, 0.0];
    assert_eq!(point.matrix(q.as_view(), 0.0), Err(error.clone()));
    assert_eq!(point.null_space_projector(q.as_view(), 0.0), Err(error));
}
