use thiserror::Error;

use crate::{
    names::proposal,
    urdf::{Element, UrdfProblem},
};

/// Why a robot cannot be built, or a question about it cannot be answered.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum KinematicsError {
    /// The text is not well-formed XML.
    #[error("line {line}, column {column}: {message}; the text must be well-formed XML")]
    NotXml {
        /// Line of the fault, counted from 1.
        line: u32,
        /// Column of the fault, counted from 1.
        column: u32,
        /// What the XML reader says.
        message: String,
    },
    /// The URDF breaks a rule.
    #[error("{element}: {problem}")]
    Urdf {
        /// The link, the joint or the robot at fault.
        element: Element,
        /// The rule.
        problem: UrdfProblem,
    },
    /// No link has this name. Frames are links: give a tool or a palm a link of its own with a fixed joint.
    #[error("the robot has no link \"{name}\"{}", proposal(near))]
    UnknownLink {
        /// The name asked for.
        name: String,
        /// Link names like it, nearest first.
        near: Vec<String>,
    },
    /// No active joint has this name.
    #[error("the robot has no active joint \"{name}\"{}; fixed and mimic joints have no coordinate", proposal(near))]
    UnknownJoint {
        /// The name asked for.
        name: String,
        /// Names of active joints like it, nearest first.
        near: Vec<String>,
    },
    /// A configuration has not one value for each active joint.
    #[error("the configuration has {found} values, the robot has {expected} active joints; give one value each")]
    ConfigurationLength {
        /// The length given.
        found: usize,
        /// The number of active joints.
        expected: usize,
    },
    /// A configuration holds a NaN or an infinity.
    #[error("joint \"{joint}\" (value {index}): {value} is not a finite number")]
    NotFinite {
        /// The name of the first such joint.
        joint: String,
        /// Its place in the configuration, counted from 0.
        index: usize,
        /// The value itself.
        value: f64,
    },
    /// A Jacobian to be filled has not one column for each active joint.
    #[error("the Jacobian has {found} columns, the robot has {expected} active joints; give one column each")]
    JacobianColumns {
        /// The number of columns given.
        found: usize,
        /// The number of active joints.
        expected: usize,
    },
}

impl KinematicsError {
    /// A broken rule at a link, a joint or the robot.
    pub(crate) fn urdf(element: Element, problem: UrdfProblem) -> Self {
        KinematicsError::Urdf { element, problem }
    }
}
