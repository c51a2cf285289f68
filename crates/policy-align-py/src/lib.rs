//! The native half of the Python package `policy_align`, on which `python/policy_align/*.py` is built.
//!
//! Python checks types and makes arrays C-ordered. Here they are copied once, and computations on the copies run
//! without the interpreter's lock. Rows are samples in Python and columns in Rust, so that a C-ordered (N, n) array
//! has the memory layout of an (n, N) matrix.

mod arrays;
mod fitted;
mod hints;
mod interruptible;
mod large;
mod model_document;
mod options;
mod parts;
mod pool;
mod recordings;
mod refusal;
mod rolling;

use pyo3::prelude::*;

/// The native half of `policy_align`.
#[pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::fitted::Fitted;
    #[pymodule_export]
    use crate::large::{Unfinished, digest, divide};
    #[pymodule_export]
    use crate::recordings::Recordings;
    #[pymodule_export]
    use crate::rolling::Path;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
