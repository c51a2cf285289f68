use gp::{GpError, Rows};

use crate::{Prepared, Recorded};

/// What the Gaussian processes learn from.
pub(crate) fn rows(prepared: &Prepared) -> Result<Rows, GpError> {
    let rows = prepared.recorded.front_end().rows(&prepared.demonstrations)?;
    match prepared.recorded {
        Recorded::NoisyVelocities(variance) => {
            let count = rows.len();
            rows.with_variances(vec![variance; count])
        }
        _ => Ok(rows),
    }
}
