//! A policy in command of a robot: joint states in, velocities out, zero wherever it must not move.

mod controller;
mod error;
mod halt;
mod joint_order;

pub use controller::{VelocityCommand, VelocityController};
pub use error::ControllerError;
pub use halt::{Halt, Quantity};
