//! Chooses the unit of each context, which is unrelated to the state's.

use gp::SlopeGp;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::options::{FitOptions, LearnerChoice};
use super::recorded_rows::rows;
use crate::{FitError, Prepared, StateChannel};

/// The movements with each context multiplied by the factor that predicts left-out movements best. Contexts that the user scaled
/// keep their scale.
pub(super) fn comparable(prepared: &Prepared, options: &FitOptions) -> Result<Prepared, FitError> {
    if options.learner == LearnerChoice::PolicyAlign {
        return Err(FitError::Context { context: StateChannel::names(&prepared.context).join(", ") });
    }
    let gp = SlopeGp { max_rows: options.max_rows, ..SlopeGp::default() };
    let mut factors = gp.context_factors(&rows(prepared)?, &mut ChaCha8Rng::seed_from_u64(options.seed))?;
    for (factor, channel) in factors.iter_mut().zip(&prepared.context) {
        if prepared.given_scales.contains(&channel.name) {
            *factor = 1.0;
        }
    }
    Ok(prepared.with_context_scaled(&factors)?)
}
