use std::fmt;

use thiserror::Error;

/// The part of a URDF to which an error or a warning refers. Numbers count from 0, in document order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Element {
    /// The robot as a whole.
    Robot,
    /// The link of this name.
    Link(String),
    /// The joint of this name.
    Joint(String),
    /// A link without a name.
    UnnamedLink(usize),
    /// A joint without a name.
    UnnamedJoint(usize),
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Element::Robot => f.write_str("robot"),
            Element::Link(name) => write!(f, "link \"{name}\""),
            Element::Joint(name) => write!(f, "joint \"{name}\""),
            Element::UnnamedLink(index) => write!(f, "link {index}"),
            Element::UnnamedJoint(index) => write!(f, "joint {index}"),
        }
    }
}

/// A part of a URDF that was ignored; the robot is built from the rest of the file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum UrdfWarning {
    /// `quat_xyzw` has an effect from URDF version 1.1 on.
    #[error("{element}: quat_xyzw is ignored in URDF 1.0; write rpy, or version=\"1.1\" at the robot")]
    QuaternionIgnored {
        /// Its place.
        element: Element,
    },
}
