//! Reading URDF: text → tags ([`tag`]) → joints ([`joint`], [`origin`]) → [`UrdfRobot`]. What the numbers and names
//! mean together (a tree, mimic chains) is for the model to decide.

mod document;
mod joint;
mod origin;
mod problem;
mod tag;

pub(crate) use document::{UrdfRobot, read};
pub use joint::JointKind;
pub(crate) use joint::{Freedom, Mimic, UrdfJoint};
pub use problem::{Element, UrdfProblem, UrdfWarning};
