//! A policy that commands a robot: joint states in, velocities out, zero whenever it must not move.

mod controller;
mod error;
mod halt;
mod joint_order;

pub use controller::{VelocityCommand, VelocityController};
pub use error::ControllerError;
pub use halt::{Halt, Quantity};
