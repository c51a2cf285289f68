use gp::{FrontEnd, Rows};
use motion::Demonstrations;
use prepare::{thinned, with_less_noise, with_slopes};

use crate::{FitError, Prepared, VelocitySource};

/// The rows from which the Gaussian processes learn.
pub(crate) fn rows(prepared: &Prepared) -> Result<Rows, FitError> {
    let demonstrations = averaged(prepared)?;
    let demonstrations = match prepared.velocities {
        VelocitySource::PositionsAsRequested => with_slopes(&demonstrations)?,
        _ => demonstrations,
    };
    Ok(front_end(prepared.velocities).rows(&demonstrations)?)
}

/// The rows for estimating constraints. If recorded velocities are noisy, slopes of the positions are used if these have less
/// noise.
pub(crate) fn least_noisy_rows(prepared: &Prepared) -> Result<Rows, FitError> {
    let VelocitySource::Noisy(variance) = prepared.velocities else { return rows(prepared) };
    match with_less_noise(&averaged(prepared)?, variance)? {
        Some((demonstrations, variance)) => Ok(FrontEnd::NoisyVelocities { variance }.rows(&demonstrations)?),
        None => rows(prepared),
    }
}

/// The front end that converts recordings to rows of a Gaussian process.
fn front_end(velocities: VelocitySource) -> FrontEnd {
    match velocities {
        VelocitySource::Recorded | VelocitySource::PositionsAsRequested => FrontEnd::Velocities,
        VelocitySource::Noisy(variance) => FrontEnd::NoisyVelocities { variance },
        VelocitySource::Fused => FrontEnd::Fused(smoothing::Fusion::default()),
        VelocitySource::Positions => FrontEnd::Smoothed(smoothing::Smoother::default()),
    }
}

/// The movements with samples averaged as `prepare` decided.
pub(crate) fn averaged(prepared: &Prepared) -> Result<Demonstrations, FitError> {
    Ok(thinned(&prepared.demonstrations, prepared.averaged)?)
}
