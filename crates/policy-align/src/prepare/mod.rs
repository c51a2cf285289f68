//! From what a file says to what a learner can use, with a line for everything that was decided on the way.

mod duplicates;
mod episodes;
mod jumps;
mod noise;
mod options;
mod prepared;
mod remarks;
mod scale;
mod stamps;
mod velocities;
mod wraps;

pub use noise::Noise;
pub use options::{PrepareOptions, VelocityUse};
pub use prepared::{Prepared, Recorded};

use demo_io::Recordings;
use motion::Demonstrations;

use crate::PrepareError;
use episodes::Take;
use prepared::Notes;

/// Makes demonstrations of recordings: time, units, velocities, noise, and what is wrong with them.
///
/// # Errors
/// [`PrepareError`] where nothing can be learnt: no episode, no motion, rows and columns exchanged, or an option that
/// does not fit.
pub fn prepare(recordings: &Recordings, options: &PrepareOptions) -> Result<Prepared, PrepareError> {
    let mut notes = Notes::default();
    let scales = scale::scales(recordings, options, &mut notes)?;
    let mut takes = Take::all(recordings, &scales)?;
    duplicates::leave_out(&mut takes, &mut notes);
    stamps::decide(&mut takes, options, &mut notes)?;
    wraps::unwrap(&mut takes, &recordings.state, &mut notes);
    jumps::cut(&mut takes, &mut notes);
    episodes::leave_out_still(&mut takes, &mut notes);
    if takes.is_empty() {
        let why = notes.left_out.first().map_or_else(String::new, |left_out| left_out.why.clone());
        return Err(PrepareError::NothingLeft { of: recordings.episodes.len(), why });
    }
    let agreement = velocities::decide(&mut takes, options, &recordings.state, &mut notes);
    let trajectories = takes.iter().map(Take::trajectory).collect::<Result<_, _>>()?;
    // Takes are of one dimension, as recordings are.
    let demonstrations = Demonstrations::new(trajectories)
        .map_err(|source| PrepareError::Episode { episode: takes[0].name.clone(), source })?;
    let noise = noise::of(&demonstrations);
    let recorded = noise::decide(&demonstrations, &noise, agreement, options, &mut notes);
    let state = scale::channels(recordings, &scales, &demonstrations);
    remarks::about(&demonstrations, &state, &noise, &mut notes);
    Ok(Prepared::new(demonstrations, &takes, state, noise, recorded, notes))
}
