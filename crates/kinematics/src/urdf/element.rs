use std::fmt;

use thiserror::Error;

/// The part of a URDF that an error or a warning speaks of. Numbers count from 0, in document order.
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

/// Something in a URDF that was passed over; the robot is what the rest of the file says.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum UrdfWarning {
    /// `quat_xyzw` counts from URDF version 1.1 on.
    #[error("{element}: quat_xyzw is ignored in URDF 1.0; write rpy, or version=\"1.1\" at the robot")]
    QuaternionIgnored {
        /// Where it stands.
        element: Element,
    },
}
