//! Movements beyond the paper's: other policies, with and without a potential, in 2 to 22 dimensions.
//!
//! - [`Wells`], [`Planes`]: potentials; [`Swirl`], [`LimitCycle`], [`Handwriting`]: policies without a potential.
//! - [`DriftingConstraint`]: random rows that turn with the state.
//! - [`BeyondSystem`]: data sets of these, free, constrained, or both ([`ConstraintKind`]).

mod direction;
mod drifting_constraint;
mod handwriting;
mod planes;
mod policy_kind;
mod system;
mod wells;
mod whirls;

pub use drifting_constraint::DriftingConstraint;
pub use handwriting::Handwriting;
pub use planes::Planes;
pub use policy_kind::PolicyKind;
pub use system::{BeyondSystem, ConstraintKind};
pub use wells::Wells;
pub use whirls::{LimitCycle, Swirl};
