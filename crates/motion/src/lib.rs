//! The vocabulary that the other crates share: what was observed ([`Trajectory`], [`Demonstrations`]), what is
//! sought ([`Policy`], [`Potential`]), and who seeks it ([`Learner`], which returns a [`LearntPolicy`]).
//!
//! Samples are **columns**: a movement of `N` samples of an `n`-dimensional state is an (n, N) matrix, so that a state
//! is a contiguous view. Times are seconds; a state has whatever unit its dimensions have (radians, metres).
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

mod demonstrations;
mod error;
mod hold_out;
mod learner;
mod policy;
mod sample_index;
mod sample_set;
mod trajectory;

pub use demonstrations::Demonstrations;
pub use error::{MotionError, Series};
pub use learner::{LearnError, Learner, LearntPolicy};
pub use policy::{NegativeGradient, Policy, Potential};
pub use sample_index::SampleIndex;
pub use sample_set::SampleSet;
pub use trajectory::Trajectory;
