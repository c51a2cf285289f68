//! Prepares recordings for learning: time steps, units, velocities, noise and faults. Each automatic decision is
//! recorded with its reason.
//!
//! ```
//! use demo_io::{Channel, Episode, Recordings, Source};
//! use nalgebra::DMatrix;
//! use prepare::{PrepareOptions, Recorded, Verdict, prepare};
//!
//! // Twelve movements towards the origin at 20 Hz, positions in metres, velocities by mistake in millimetres per second.
//! let episodes = (0..12).map(|k| {
//!     let position = |axis: usize, i: usize| (f64::from(k) + axis as f64).cos() * (-0.025 * i as f64).exp();
//!     Episode {
//!         name: format!("take {k}"),
//!         source: Source { file: "reach.csv".to_owned(), rows: None },
//!         times: (0..40).map(|i| 0.05 * f64::from(i)).collect(),
//!         positions: DMatrix::from_fn(2, 40, position),
//!         velocities: Some(DMatrix::from_fn(2, 40, |axis, i| -500.0 * position(axis, i))),
//!         constraint: None,
//!     }
//! });
//! let state = ["x", "y"].map(|name| Channel { name: name.to_owned(), unit: Some("m".to_owned()) });
//! let recordings = Recordings { state: state.to_vec(), episodes: episodes.collect(), notes: vec![] };
//!
//! let prepared = prepare(&recordings, &PrepareOptions::default())?;
//! assert_eq!(prepared.recorded, Recorded::Velocities);
//! let velocities = prepared.demonstrations.trajectories()[0].velocities().expect("recorded");
//! assert!((velocities[(0, 0)] + 0.5).abs() < 0.05); // back in metres per second
//! assert_eq!(prepared.findings[0].verdict, Verdict::Doubtful); // and reported
//! assert!(prepared.decisions.iter().any(|decision| decision.flag == "--integration"));
//! # Ok::<(), prepare::PrepareError>(())
//! ```
//!
//! [`Prepared`] holds the demonstrations, every [`Decision`] with the flag that overrides it, and every [`Finding`]
//! that casts doubt on the data. [`Recorded::front_end`] says how a Gaussian process should read them. The guide is
//! `docs/your-own-data.md`; `docs/decisions/trust.md` gives the reasons.
//!
//! # When it fails
//!
//! - [`PrepareError`]: no episodes, no motion, rows and columns exchanged, or an option that does not fit the data.
//! - **Episodes that are duplicates or stand still** are dropped and listed in [`Prepared::left_out`].
//! - **Time stamps in the wrong unit without velocities** look like a slower policy; only the time step shows it.
//! - **Noise of more than a few per cent in positions alone** cannot be removed without losing the velocity. Record
//!   velocities or commands.
//! - **Mixed units** (metres and radians): nothing chooses a metric for you. [`PrepareOptions::scale`] sets one.

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
