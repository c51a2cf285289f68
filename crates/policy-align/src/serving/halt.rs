use std::fmt;

use prepare::numbers::short;

/// Reasons why a [`VelocityController`](super::VelocityController) commands zero.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Halt {
    /// No joint state has arrived.
    NoState,
    /// Positions of some joints have not arrived.
    Missing {
        /// The joints.
        joints: Vec<String>,
        /// The joints of the newest message.
        found: Vec<String>,
    },
    /// The oldest position is too old.
    Stale {
        /// Its joint.
        joint: String,
        /// Seconds since it arrived.
        age: f64,
    },
    /// A number is NaN or infinite.
    NotFinite {
        /// The quantity.
        quantity: Quantity,
        /// Its joint.
        joint: String,
        /// Its value.
        value: f64,
    },
    /// The state is outside the data ([`ModelPolicy::is_supported`](crate::ModelPolicy::is_supported)).
    Outside {
        /// The support there.
        support: f64,
    },
}

/// A number of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Its position, as the robot reports it.
    Position,
    /// Its velocity, according to the policy.
    Velocity,
}

impl Halt {
    /// The reason in a word, which does not depend on numbers and joints.
    pub fn word(&self) -> &'static str {
        match self {
            Halt::NoState => "no state",
            Halt::Missing { .. } => "missing",
            Halt::Stale { .. } => "stale",
            Halt::NotFinite { .. } => "not finite",
            Halt::Outside { .. } => "outside",
        }
    }
}

impl fmt::Display for Halt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Halt::NoState => write!(f, "no joint state received"),
            Halt::Missing { joints, found } => {
                let found = if found.is_empty() { "none".to_owned() } else { found.join(", ") };
                write!(f, "no position of {}; joints of the last message: {found}", joints.join(", "))
            }
            Halt::Stale { joint, age } => write!(f, "the position of {joint} is {} s old", short(*age)),
            Halt::NotFinite { quantity, joint, value } => {
                let quantity = match quantity {
                    Quantity::Position => "position",
                    Quantity::Velocity => "commanded velocity",
                };
                write!(f, "the {quantity} of {joint} is {value}")
            }
            Halt::Outside { support } => write!(f, "the state is outside the data (support {})", short(*support)),
        }
    }
}
