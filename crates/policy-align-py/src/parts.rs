//! Work on many states that Ctrl-C can end.

use nalgebra::{DMatrix, DMatrixView};
use pyo3::prelude::*;

use crate::pool;

/// Number of states between two checks for signals, which take less than a second.
const TOGETHER: usize = 1024;

/// Applies `work` to groups of states (columns), one after the other, on our own threads, and passes each result to `take`
/// with the index of the group's first state. Signals are checked in between. A single state is not worth a switch to other
/// threads.
pub(crate) fn in_parts<T: Send>(
    py: Python<'_>,
    states: &DMatrix<f64>,
    work: impl Fn(DMatrixView<'_, f64>) -> T + Sync,
    mut take: impl FnMut(usize, T),
) -> PyResult<()> {
    // Runs at least once, so that the result for no states also has the right shape.
    for first in (0..states.ncols().max(1)).step_by(TOGETHER) {
        let some = states.columns(first, TOGETHER.min(states.ncols() - first));
        let found =
            py.detach(
                || {
                    if some.ncols() > 1 { pool::on(0, || work(some.as_view())) } else { Ok(work(some.as_view())) }
                },
            )?;
        take(first, found);
        py.check_signals()?;
    }
    Ok(())
}
