//! Compares policies at recorded states.

use gp::Rows;
use nalgebra::DMatrix;

/// Largest number of states at which policies are compared.
const STATES: usize = 500;

/// The rows' states, evenly thinned, (n, M).
pub(super) fn states(rows: &Rows) -> DMatrix<f64> {
    let every = rows.len().div_ceil(STATES);
    let chosen: Vec<usize> = (0..rows.len()).step_by(every).collect();
    rows.states().select_columns(&chosen)
}
