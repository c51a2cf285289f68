//! What was recorded, cleaned: how noisy positions are, and states and velocities without that noise.
//!
//! | recorded | take | because |
//! |---|---|---|
//! | positions | [`Smoother`] | velocities with their variance, and where constraints may have switched |
//! | noisy positions, clean velocities or commands | [`Fusion`] | only the start of a movement is unknown then |
//! | positions, for a rule that takes steps between them | [`SavitzkyGolay`] | plain and quick |
//!
//! [`PositionNoise`] says whether any of them is needed. Learners may use all of it: nothing here knows a policy.
//!
//! ```
//! use motion::Demonstrations;
//! use nalgebra::DMatrix;
//! use smoothing::Smoother;
//!
//! // Two movements towards the origin, seen 50 times a second.
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
//! Formulas are numbered (S15)–(S17) on from those of the crate `gp`. Trajectories are smoothed in parallel, with the
//! same bits at any number of threads. Times may be uneven: [`Stamped`] movements have a stamp for each sample.
//!
//! Reading on: `smoother` is the run of the smoother, a line a step; `scaled` is what goes in, `polynomials`, `windows`
//! and `evidence` are (S15), `segmentation` is (S16), `averages` and `smoothed` what comes out; `noise_by_evidence` finds
//! the noise. `fusion` chooses among the steps of `increments` and runs `kalman`.

mod averages;
mod error;
mod evidence;
mod fusion;
mod increments;
mod kalman;
mod noise;
mod noise_by_evidence;
mod polynomials;
mod savitzky_golay;
mod scaled;
mod segmentation;
mod smoothed;
mod smoother;
mod stamped;
mod windows;

pub use error::SmoothingError;
pub use fusion::{Fused, FusedMovement, Fusion};
pub use increments::StepRule;
pub use noise::PositionNoise;
pub use savitzky_golay::SavitzkyGolay;
pub use smoothed::{Smoothed, SmoothedMovement};
pub use smoother::{AxisScale, NoiseVariance, Smoother};
pub use stamped::Stamped;
