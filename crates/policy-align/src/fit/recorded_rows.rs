use gp::{GpError, Rows};
use motion::{Demonstrations, MotionError};
use prepare::{thinned, with_slopes};

use crate::{Prepared, Recorded};

/// The rows that the Gaussian processes learn from.
pub(crate) fn rows(prepared: &Prepared) -> Result<Rows, GpError> {
    let demonstrations = averaged(prepared)?;
    let demonstrations = match prepared.recorded {
        Recorded::PositionsAsRequested => with_slopes(&demonstrations).map_err(|error| cleaning(&error))?,
        _ => demonstrations,
    };
    let rows = prepared.recorded.front_end().rows(&demonstrations)?;
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
    thinned(&prepared.demonstrations, prepared.averaged).map_err(|error| cleaning(&error))
}

fn cleaning(error: &MotionError) -> GpError {
    GpError::Cleaning { reason: error.to_string() }
}
