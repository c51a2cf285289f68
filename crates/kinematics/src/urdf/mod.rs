//! Reading URDF: text → tags ([`tag`]) → joints and shapes ([`joint`], [`origin`], [`geometry`]) → [`UrdfRobot`]. The
//! model checks how numbers and names fit together (a tree, mimic chains).

mod document;
mod element;
#[cfg(feature = "urdf-rs")]
mod from_urdf_rs;
mod geometry;
mod inertial;
mod joint;
mod lenient;
mod number;
mod origin;
mod problem;
mod scan;
pub(crate) mod tag;
mod version;

#[cfg(feature = "collision")]
pub(crate) use document::parsed;
pub(crate) use document::{UrdfRobot, read};
pub use element::{Element, UrdfWarning};
#[cfg(feature = "urdf-rs")]
pub(crate) use from_urdf_rs::from_urdf_rs;
pub use geometry::Geometry;
pub(crate) use geometry::UrdfCollision;
pub(crate) use inertial::UrdfInertial;
pub use joint::JointKind;
pub(crate) use joint::{Mimic, UrdfJoint, UrdfMotion};
pub(crate) use number::bounded;
#[cfg(feature = "collision")]
pub(crate) use problem::LARGEST;
pub use problem::UrdfProblem;
