//! From what a file says to what a learner can use, with a line for everything that was decided on the way.

mod channel;
mod decision;
mod directions;
mod duplicates;
mod episodes;
mod error;
mod finding;
pub mod in_words;
mod jumps;
mod left_out;
mod noise;
mod options;
mod prepared;
mod remarks;
mod scale;
mod smooth;
mod stamps;
mod thinning;
mod velocities;
mod wraps;

pub use channel::StateChannel;
pub use decision::Decision;
pub use directions::directions;
pub use error::PrepareError;
pub use finding::{Finding, Verdict};
pub use left_out::LeftOutEpisode;
pub use noise::Noise;
pub use options::{PrepareOptions, Repair, Smoothing, VelocityUse};
pub use prepared::{Prepared, Recorded};
pub use smooth::with_slopes;
pub use thinning::thinned;

use demo_io::Recordings;

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
    if options.wraps == Repair::Auto {
        wraps::unwrap(&mut takes, &recordings.state, &mut notes);
    }
    if options.jumps == Repair::Auto {
        jumps::cut(&mut takes, &mut notes);
    }
    episodes::leave_out_still(&mut takes, &mut notes);
    if takes.is_empty() {
        let why = notes.left_out.first().map_or_else(String::new, |left_out| left_out.why.clone());
        return Err(PrepareError::NothingLeft { of: recordings.episodes.len(), why });
    }
    let noise = noise::of(&episodes::demonstrations(&takes)?);
    let agreement = velocities::decide(&mut takes, options, &recordings.state, &noise, &mut notes);
    let demonstrations = episodes::demonstrations(&takes)?;
    let smoothed = smooth::as_requested(&demonstrations, options.smoothing, &mut notes)?;
    let (demonstrations, recorded) = if let Some(smoothed) = smoothed {
        (smoothed, noise::as_requested(&demonstrations, &noise, agreement))
    } else {
        let recorded = noise::decide(&demonstrations, &noise, agreement, &mut notes);
        (demonstrations, recorded)
    };
    let averaged = match recorded {
        Recorded::Positions => thinning::decide(&demonstrations, &noise, &mut notes),
        _ => 1,
    };
    let state = scale::channels(recordings, &scales, &demonstrations);
    stamps::doubt(&demonstrations, &mut notes);
    remarks::about(&demonstrations, &state, &noise, &mut notes);
    Ok(Prepared::new(demonstrations, &takes, state, noise, (recorded, options.smoothing, averaged), notes))
}
