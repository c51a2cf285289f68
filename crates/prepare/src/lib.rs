//! Prepares recordings for learning: time steps, units, velocities, noise and faults. Each automatic decision is
//! recorded with its reason.
//!
//! ```
//! use motion::{Channel, Episode, Recordings, Source, Times, Verdict};
//! use nalgebra::DMatrix;
//! use prepare::{PrepareOptions, VelocitySource, prepare};
//!
//! // Twelve movements towards the origin at 20 Hz, positions in metres, velocities by mistake in millimetres per second.
//! let episodes = (0..12).map(|k| {
//!     let position = |axis: usize, i: usize| (f64::from(k) + axis as f64).cos() * (-0.025 * i as f64).exp();
//!     Episode {
//!         name: format!("take {k}"),
//!         source: Source::default(),
//!         times: Times::Even { step: 0.05, len: 40 },
//!         positions: DMatrix::from_fn(2, 40, position),
//!         velocities: Some(DMatrix::from_fn(2, 40, |axis, i| -500.0 * position(axis, i))),
//!         constraint: None,
//!         context: nalgebra::DVector::zeros(0),
//!     }
//! });
//! let state = ["x", "y"].map(|name| Channel { name: name.to_owned(), unit: Some("m".to_owned()) });
//! let recordings = Recordings { state: state.to_vec(), episodes: episodes.collect(), findings: vec![] };
//!
//! let prepared = prepare(&recordings, &PrepareOptions::default())?;
//! assert_eq!(prepared.velocities, VelocitySource::Recorded);
//! let velocities = prepared.demonstrations.trajectories()[0].velocities().expect("recorded");
//! assert!((velocities[(0, 0)] + 0.5).abs() < 0.05); // back in metres per second
//! assert_eq!(prepared.findings[0].verdict, Verdict::Doubtful); // and reported
//! assert!(prepared.decisions.iter().any(|decision| decision.flag == "--integration"));
//! # Ok::<(), prepare::PrepareError>(())
//! ```
//!
//! Readers report faults of files, `prepare` examines recordings, `policy_align` examines what needs a policy. [`Prepared`] holds the
//! demonstrations, every [`Decision`](motion::Decision) with the flag that overrides it, every [`Finding`](motion::Finding), those of the
//! reader first, and every episode that was [left out](motion::LeftOut). The guide is `docs/your-own-data.md`; `docs/decisions/trust.md`
//! gives the reasons.
//!
//! # When it fails
//!
//! - [`PrepareError`]: no episodes, no motion, rows and columns swapped, or an option that does not fit the data.
//! - **Episodes that are duplicates or stand still** are dropped and listed in [`Prepared::left_out`].
//! - **Time stamps in the wrong unit without velocities** look like a slower policy; only the time step reveals it.
//! - **Noise of more than a few per cent in positions alone** cannot be removed without losing the velocity. Record
//!   velocities or commands.
//! - **A push, a speed limit, delayed velocities or quaternions** hide a part of the policy. They are detected and reported, not repaired,
//!   except for late velocities and the signs of quaternions.
//! - **Mixed units** (metres and radians): [`PrepareOptions::scale`] sets a factor; learners may find
//!   one ([`Prepared::rescaled`]).

mod channel;
mod context;
mod degrees;
mod direction;
mod directions;
mod error;
mod findings;
mod notes;
pub mod numbers;
mod options;
mod prepared;
mod repairs;
mod samples;
mod scale;
mod velocity_source;
mod wall;

pub use channel::StateChannel;
pub use direction::{direction_by_channels, sum_of_parts};
pub use directions::directions;
pub use error::PrepareError;
pub use findings::end_places;
pub use options::{ContextUse, PrepareOptions, Repair, Smoothing, VelocityUse};
pub use prepared::Prepared;
pub use samples::least_noisy::with_less_noise;
pub use samples::noise::Noise;
pub use samples::smooth::with_slopes;
pub use samples::still::trim_still;
pub use samples::thinning::thinned;
pub use velocity_source::VelocitySource;
pub use wall::Wall;

use std::borrow::Cow;

use motion::Recordings;

use notes::Notes;

/// Turns recordings into demonstrations: determines time steps, units, velocities and noise, and reports faults. Owned recordings become
/// the demonstrations without a copy.
///
/// # Errors
/// [`PrepareError`] if nothing can be learnt: no episode, no motion, rows and columns swapped, or an option that does not fit.
pub fn prepare<'a>(
    recordings: impl Into<Cow<'a, Recordings>>,
    options: &PrepareOptions,
) -> Result<Prepared, PrepareError> {
    let Recordings { state: channels, episodes, findings } = recordings.into().into_owned();
    let mut notes = Notes { findings, ..Notes::default() };
    let scales = scale::scales(&channels, options, &mut notes)?;
    let found = episodes.len();
    let mut episodes = repairs::episodes::movements(episodes, &scales, &mut notes)?;
    repairs::duplicates::leave_out(&mut episodes, &mut notes);
    let (of_state, of_context) = context::split(&mut episodes, &channels, &options.context, &mut notes)?;
    let described = |of: &[usize]| of.iter().map(|&at| channels[at].clone()).collect::<Vec<_>>();
    let (state_channels, context_channels) = (described(&of_state), described(&of_context));
    let scales_of = |channels: &[usize]| scales.select_rows(channels);
    repairs::stamps::decide(&mut episodes, options, &mut notes)?;
    repairs::quaternions::align(&mut episodes, &state_channels, options.wraps, &mut notes);
    if options.wraps == Repair::Auto {
        repairs::wraps::unwrap(&mut episodes, &state_channels, &mut notes);
    }
    notes.findings.extend(findings::odd_channels(&episodes, &state_channels));
    if options.jumps == Repair::Auto {
        repairs::glitches::interpolate(&mut episodes, &state_channels, &mut notes);
        repairs::jumps::cut(&mut episodes, &state_channels, &mut notes);
    }
    repairs::episodes::leave_out_still(&mut episodes, &mut notes);
    notes.findings.extend(findings::other_units(&episodes, &scales_of(&of_state)));
    repairs::labels::decide(&mut episodes, of_state.len(), &mut notes);
    if episodes.is_empty() {
        // The last cleaning left nothing.
        let why = notes.left_out.last().map_or_else(String::new, |left_out| left_out.why.clone());
        return Err(PrepareError::NothingLeft { of: found, why });
    }
    let noise = repairs::episodes::lent(&mut episodes, samples::noise::of)?;
    let origin = repairs::velocities::decide(&mut episodes, options, &state_channels, &noise, &mut notes);
    let names: Vec<String> = episodes.iter().map(|episode| episode.name.clone()).collect();
    let constraints = episodes.iter().map(|of| Some(of.constraint.as_ref()?.only()?.to_owned())).collect();
    let demonstrations = repairs::episodes::demonstrations(episodes)?;
    let recorded = demonstrations.clone();
    notes.findings.extend(findings::velocities_and_clocks(&demonstrations, &state_channels));
    notes.findings.extend(findings::held_channels(&demonstrations, &state_channels));
    let smoothed = samples::smooth::as_requested(&demonstrations, options.smoothing, &mut notes)?;
    let (demonstrations, velocities) = if let Some(smoothed) = smoothed {
        (smoothed, samples::noise::as_requested(&demonstrations, origin))
    } else {
        let velocities = samples::noise::decide(&demonstrations, &noise, origin, &mut notes);
        (demonstrations, velocities)
    };
    let averaged = match velocities {
        VelocitySource::Positions => samples::thinning::decide(&demonstrations, &noise, &mut notes),
        _ => 1,
    };
    let state = scale::channels(&state_channels, &scales_of(&of_state), |at| demonstrations.values(at).collect());
    let contexts = |at| demonstrations.trajectories().iter().map(|movement| movement.context()[at]).collect();
    let context = scale::channels(&context_channels, &scales_of(&of_context), contexts);
    context::remark(&demonstrations, &context, &mut notes);
    repairs::stamps::doubt(&demonstrations, &mut notes);
    findings::examine(&demonstrations, &state, &noise, &mut notes);
    degrees::remark(&state, &mut notes);
    samples::still::remark(&demonstrations, noise.positions.as_deref(), (&names, &recorded), &mut notes);
    Ok(Prepared {
        time_step: demonstrations.time_step(),
        episodes: names,
        constraints,
        demonstrations,
        state,
        context,
        given_scales: options.scale.iter().map(|(name, _)| name.clone()).collect(),
        noise,
        velocities,
        smoothing: options.smoothing,
        averaged,
        decisions: notes.decisions,
        findings: notes.findings,
        left_out: notes.left_out,
    })
}

/// The program of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
