//! An arm follows its policy while a table keeps the tip at its height.

#![allow(clippy::print_stdout, reason = "a program")]

use std::convert::Infallible;

use constraints::{ConstraintError, PfaffianConstraint, PointConstraint, Unconstrained};
use nalgebra::{DMatrixViewMut, DVector, DVectorView, dmatrix, dvector};

/// The tip of three links of 1, 1 and 0.5 m in a vertical plane.
fn tip(q: DVectorView<'_, f64>) -> [f64; 2] {
    let (a, b, c) = (q[0], q[0] + q[1], q.sum());
    [a.cos() + b.cos() + 0.5 * c.cos(), a.sin() + b.sin() + 0.5 * c.sin()]
}

/// Its Jacobian, (2, 3): each joint rotates the tip about itself.
fn jacobian(q: DVectorView<'_, f64>, mut jacobian: DMatrixViewMut<'_, f64>) {
    let ([x, y], (a, b)) = (tip(q), (q[0], q[0] + q[1]));
    let joints = [[0.0, 0.0], [a.cos(), a.sin()], [a.cos() + b.cos(), a.sin() + b.sin()]];
    for (column, [joint_x, joint_y]) in joints.into_iter().enumerate() {
        (jacobian[(0, column)], jacobian[(1, column)]) = (joint_y - y, x - joint_x);
    }
}

/// Follows u = N(x, t) π(x) for three seconds; π pulls every joint towards the end of its motion.
fn follow(constraint: &dyn PfaffianConstraint, start: &DVector<f64>) -> Result<DVector<f64>, ConstraintError> {
    let (mut q, wished, time_step) = (start.clone(), dvector![0.9, -0.6, -1.2], 1e-3);
    for step in 0..3000 {
        let projector = constraint.null_space_projector(q.as_view(), time_step * f64::from(step))?;
        q += time_step * projector.project((&wished - &q).as_view());
    }
    Ok(q)
}

fn main() -> Result<(), ConstraintError> {
    let start = dvector![0.3, 0.8, -0.4];
    let table = PointConstraint::new(dmatrix![0.0, 1.0], 3, |q, matrix| {
        jacobian(q, matrix);
        Ok::<(), Infallible>(())
    })?;
    let at = |q: &DVector<f64>| format!("x {:.3} m, height {:.3} m", tip(q.as_view())[0], tip(q.as_view())[1]);
    println!("start     {}", at(&start));
    println!("free      {}", at(&follow(&Unconstrained { dim: 3 }, &start)?));
    println!("on table  {}", at(&follow(&table, &start)?));
    let projector = table.null_space_projector(start.as_view(), 0.0)?;
    println!("the table takes {} of {} directions of movement", projector.rank(), projector.dim());
    Ok(())
}
