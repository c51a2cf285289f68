//! Estimates the noise of recorded positions, and states and velocities without it.
//!
//! | recorded | use | gives |
//! |---|---|---|
//! | positions | [`Smoother`] | velocities with their variance, and where constraints may have switched |
//! | noisy positions, exact velocities or commands | [`Fusion`] | states that integrate the velocities |
//! | positions with hardly any noise | [`slopes`], [`slopes_between_switches`] | velocities |
//! | positions, for a rule that takes steps between them | [`SavitzkyGolay`] | a simple, fast polynomial filter |
//!
//! [`PositionNoise`] estimates whether any of them is needed. Nothing here depends on a policy, so every learner may use it.
//!
//! ```
//! use motion::Demonstrations;
//! use nalgebra::DMatrix;
//! use smoothing::Smoother;
//!
//! // Two movements towards the origin, recorded 50 times a second.
//! let movements = [1.0, -2.0].map(|start| {
//!     DMatrix::from_fn(2, 40, |axis, i| start * (axis as f64 + 0.5) * (-0.02 * i as f64).exp())
//! });
//! let demonstrations = Demonstrations::from_states(movements, 0.02)?;
//! let smoothed = Smoother::default().smooth(&demonstrations)?;
//! let first = &smoothed.movements[0];
//! for i in 0..40 {
//!     let error = first.velocities.column(i) + &first.states.column(i); // d/dt e^−t = −e^−t
//!     assert!(error.norm() < 1e-3);
//!     assert!(first.velocity_variance[i] < 1e-6);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Equations (S15)–(S17) are in [section 8 of `docs/slope-gp.md`](../gp/equations/index.html#8-smoothing).
//! Trajectories are smoothed in parallel, with the same bits for any number of threads. Times may be uneven:
//! [`motion::Trajectory::stamped`].
//!
//! # When it fails
//!
//! - **Noise larger than the movement over a few samples** leaves velocities uncertain; their variance shows it.
//! - **Drift and correlated noise** count as movement, because the noise is assumed to be white.
//! - **Axes of very different noise**: give [`AxisScale::Given`], since one variance serves all scaled axes.
//! - [`SmoothingError`]: no motion, missing velocities, too few samples, or overflow.
//!
//! To read the source: `smoother` has one line for each step; `scaled` prepares the input; `polynomials`, `windows` and
//! `evidence` implement (S15), `segmentation` (S16); `averages` and `smoothed` form the result; `noise_by_evidence`
//! estimates the noise. `fusion` chooses among the steps of `increments` and runs `kalman`.

mod error;
mod fusion;
mod increments;
mod kalman;
mod noise;
mod piecewise;
mod savitzky_golay;
mod slopes;

pub use error::SmoothingError;
pub use fusion::{Fused, FusedMovement, Fusion};
pub use increments::StepRule;
pub use noise::{PositionNoise, VelocityNoise};
pub use piecewise::scaled::AxisScale;
pub use piecewise::smoothed::{Smoothed, SmoothedMovement};
pub use piecewise::smoother::{NoiseVariance, Smoother};
pub use savitzky_golay::SavitzkyGolay;
pub use slopes::{slopes, slopes_between_switches};

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
