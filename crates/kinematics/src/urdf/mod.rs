//! Reading URDF: text → tags ([`tag`]) → joints and shapes ([`joint`], [`origin`], [`geometry`]) → [`UrdfRobot`]. What
//! the numbers and names mean together (a tree, mimic chains) is for the model to decide.

mod document;
mod element;
mod geometry;
mod joint;
mod lenient;
mod origin;
mod problem;
pub(crate) mod tag;

pub(crate) use document::{UrdfRobot, parsed, read};
pub use element::{Element, UrdfWarning};
pub use geometry::Geometry;
pub(crate) use geometry::UrdfCollision;
pub use joint::JointKind;
pub(crate) use joint::{Freedom, Mimic, UrdfJoint};
pub use problem::UrdfProblem;
