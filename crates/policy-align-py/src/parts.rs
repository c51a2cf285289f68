//! Work on many states that Ctrl-C ends.

use nalgebra::{DMatrix, DMatrixView};
use pyo3::prelude::*;

use crate::pool;

/// States between two looks at signals: less than a second.
const TOGETHER: usize = 1024;

/// Works on some states (columns) after others, on threads of our own, and gives `take` what it finds with the first of these
/// states. Ctrl-C is heard in between. One state is not worth the way to other threads.
pub(crate) fn in_parts<T: Send>(
    py: Python<'_>,
    states: &DMatrix<f64>,
    work: impl Fn(DMatrixView<'_, f64>) -> T + Sync,
    mut take: impl FnMut(usize, T),
) -> PyResult<()> {
    // At least once, so that nothing found of no state has its form.
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
