//! Scores two learnt policies against the true one, without and with constraints.

#![allow(clippy::print_stdout, reason = "a program")]

use metrics::{MetricsError, Summary, ncpe, nupe, potential_nmse};
use nalgebra::{DMatrix, DVector};

fn main() -> Result<(), MetricsError> {
    // The policy π(x) = −x on a grid of 25 states, and two learners' estimates.
    let states = DMatrix::from_fn(2, 25, |axis, i| [(i % 5) as f64, (i / 5) as f64][axis] - 2.0);
    let truth = -&states;
    let mut averaged = truth.clone();
    averaged.row_mut(1).scale_mut(0.5); // averaging over constraints lost half of the second dimension
    let precise = truth.map(|u| 1.01 * u);

    println!("policy     nUPE      nCPE");
    for (name, learnt) in [("averaged", &averaged), ("precise", &precise)] {
        // In the constrained error the second dimension is blocked, so that the error there does not count.
        let constrained = ncpe(&truth, learnt, |_sample, mut difference| difference[1] = 0.0)?;
        println!("{name:<9}  {:.1e}   {constrained:.1e}", nupe(&truth, learnt)?);
    }

    // A potential is known up to a constant, so that the offset of 7 does not count.
    let potential = DVector::from_iterator(25, states.column_iter().map(|x| 0.5 * x.norm_squared()));
    println!("potential with an offset of 7: {:.1e}", potential_nmse(&potential, &potential.add_scalar(7.0))?);

    // One of five data sets failed, which the median hardly reflects.
    let summary = Summary::of(&[0.02, 0.03, 0.025, 0.031, 0.9])?;
    println!("{} data sets: mean {:.3}, median {:.3}", summary.n, summary.mean, summary.median);
    Ok(())
}
