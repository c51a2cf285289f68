//! From recorded movements to a policy: what a program that uses this crate starts from.

use align::{Bandwidth, LwprRegressor, PolicyAlign};
use motion::{Demonstrations, Policy};
use nalgebra::{DMatrix, DVector};
use rand::{SeedableRng, rngs::StdRng};

#[allow(clippy::print_stdout)]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let demonstrations = Demonstrations::from_states(recorded_movements(), 0.5)?;

    let aligned = PolicyAlign { bandwidth: Bandwidth::Medium, ..Default::default() }.align(&demonstrations)?;
    for warning in aligned.warnings() {
        println!("warning: {warning}");
    }
    let learnt = aligned.learn(&LwprRegressor::default(), &mut StdRng::seed_from_u64(1))?;

    let x = DVector::from_vec(vec![0.5, -0.2]);
    let u = learnt.action(x.as_view());
    println!("kept {} of {} movements", aligned.kept().len(), demonstrations.n_trajectories());
    println!("at ({:.2}, {:.2}) move with ({:.3}, {:.3}) per second", x[0], x[1], u[0], u[1]);
    Ok(())
}

/// Stands in for your own data: one matrix a movement, one column a sample. Here something rolls down φ = ‖x‖²/20, each
/// time on another straight rail.
fn recorded_movements() -> impl Iterator<Item = DMatrix<f64>> {
    (0..60).map(|k| {
        let angle = 0.7 * f64::from(k);
        let rail = DVector::from_vec(vec![angle.cos(), angle.sin()]);
        let mut x = DVector::from_vec(vec![(2.1 * angle).sin(), (1.3 * angle).cos()]);
        let states: Vec<_> = (0..60)
            .map(|_| {
                let step = &rail * rail.dot(&x) * (-0.1 * 0.5);
                x += step;
                x.clone()
            })
            .collect();
        DMatrix::from_columns(&states)
    })
}
