use gp::{GpError, Rows};

use motion::Demonstrations;

use crate::prepare::thinned;
use crate::{Prepared, Recorded};

/// What the Gaussian processes learn from.
pub(crate) fn rows(prepared: &Prepared) -> Result<Rows, GpError> {
    let rows = prepared.recorded.front_end().rows(&averaged(prepared)?)?;
    match prepared.recorded {
        Recorded::NoisyVelocities(variance) => {
            let count = rows.len();
            rows.with_variances(vec![variance; count])
        }
        _ => Ok(rows),
    }
}

/// The movements with samples averaged as decided.
pub(super) fn averaged(prepared: &Prepared) -> Result<Demonstrations, GpError> {
    thinned(&prepared.demonstrations, prepared.averaged)
        .map_err(|error| GpError::Cleaning { reason: error.to_string() })
}
