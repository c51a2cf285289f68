//! The types that the other crates share: recordings ([`Recordings`], [`Episode`]) and their anomalies ([`Finding`],
//! [`LeftOut`]), observations to learn from ([`Trajectory`], [`Demonstrations`]), the functions to learn ([`Policy`],
//! [`Potential`]), and the interface of all learners ([`Learner`], which returns a [`LearntPolicy`]).
//!
//! Samples are **columns**: a movement of `N` samples of an `n`-dimensional state is an (n, N) matrix, so that a state
//! is a contiguous view. Times are seconds; a state has the units of its dimensions (radians, metres).
//!
//! ```
//! use motion::{Demonstrations, Trajectory};
//! use nalgebra::DMatrix;
//!
//! let falling = DMatrix::from_row_slice(2, 3, &[0.0, 0.1, 0.2, 1.0, 0.9, 0.7]);
//! let rising = DMatrix::from_row_slice(2, 3, &[0.0, 0.1, 0.2, 0.0, 0.2, 0.3]);
//! let demonstrations = Demonstrations::from_states([falling, rising], 0.02)?;
//! assert_eq!(demonstrations.dim(), 2);
//! # Ok::<(), motion::MotionError>(())
//! ```
//!
//! A custom learner returns a policy together with its support by the demonstrations:
//!
//! ```
//! use motion::{Demonstrations, LearnError, Learner, LearntPolicy, Policy, SampleIndex};
//! use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
//! use rand::{Rng, SeedableRng as _};
//!
//! /// Learns the mean velocity.
//! #[derive(Debug)]
//! struct MeanVelocity;
//!
//! #[derive(Debug)]
//! struct Constant(DVector<f64>);
//!
//! impl Learner for MeanVelocity {
//!     fn learn(
//!         &self,
//!         demonstrations: &Demonstrations,
//!         _held_out: &[SampleIndex],
//!         _rng: &mut dyn Rng,
//!     ) -> Result<Box<dyn LearntPolicy>, LearnError> {
//!         let means = demonstrations.trajectories().iter().map(|movement| movement.step_velocities().column_mean());
//!         Ok(Box::new(Constant(means.sum::<DVector<f64>>() / demonstrations.n_trajectories() as f64)))
//!     }
//! }
//!
//! impl Policy for Constant {
//!     fn dim(&self) -> usize {
//!         self.0.len()
//!     }
//!
//!     fn action_into(&self, _state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
//!         action.copy_from(&self.0);
//!     }
//! }
//!
//! impl LearntPolicy for Constant {
//!     fn support(&self, _state: DVectorView<'_, f64>) -> f64 {
//!         1.0
//!     }
//! }
//!
//! let steady = DMatrix::from_fn(2, 5, |axis, i| (axis as f64 + 1.0) * i as f64);
//! let demonstrations = Demonstrations::from_states([steady], 0.5)?;
//! let learnt = MeanVelocity.learn(&demonstrations, &[], &mut rand::rngs::StdRng::seed_from_u64(1))?;
//! assert_eq!(learnt.action(DVector::zeros(2).as_view()), DVector::from_vec(vec![2.0, 4.0]));
//! # Ok::<(), motion::LearnError>(())
//! ```

mod angles;
pub mod anomalies;
mod demonstrations;
mod error;
mod finding;
mod hold_out;
mod learner;
mod least_seen;
mod policy;
mod recordings;
mod samples;
mod statistics;
mod times;
mod trajectory;

pub use angles::{is_in_degrees, unwrap_angle};
pub use demonstrations::Demonstrations;
pub use error::{MotionError, Series};
pub use finding::{Decision, Finding, LeftOut, Subject, Topic, Verdict};
pub use learner::{Certainty, LearnError, Learner, LearntPolicy};
pub use least_seen::LeastSeen;
pub use policy::{NegativeGradient, Policy, Potential};
pub use recordings::{Channel, Episode, RecordRange, Recordings, Source, is_called_context};
pub use samples::{Labels, SampleIndex, SampleSet};
pub use statistics::{mean_and_error, median, scaled, spread, standard_deviation, upper_median};
pub use times::{TimeUnit, Times, whole_step};
pub use trajectory::Trajectory;

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
