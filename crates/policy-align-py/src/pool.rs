//! Our own threads instead of rayon's global ones: their number can be chosen, and a forked process, which inherits no
//! threads, gets new ones instead of waiting for ever.

use std::collections::HashMap;
use std::process;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use pyo3::PyResult;
use pyo3::exceptions::PyRuntimeError;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Thread pools by process and number of threads.
type Pools = HashMap<(u32, usize), Arc<ThreadPool>>;

/// Pools of the process before a fork are kept, because none of their threads is left to end them.
static POOLS: LazyLock<Mutex<Pools>> = LazyLock::new(Mutex::default);

/// Runs work on this number of threads; 0 means rayon's default. Results do not depend on it.
pub(crate) fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let key = (process::id(), threads);
    let pool = if let Some(pool) = pools.get(&key) {
        Arc::clone(pool)
    } else {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = Arc::new(pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?);
        pools.insert(key, Arc::clone(&pool));
        pool
    };
    drop(pools);
    Ok(pool.install(work))
}
