use thiserror::Error;

use crate::{
    names::proposal,
    urdf::{Element, UrdfProblem},
};

/// Largest coordinate of a configuration for which positions and their squares stay finite.
pub(crate) const FARTHEST: f64 = 1e100;

/// Reasons why a robot cannot be built or evaluated.
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
        /// The XML reader's message.
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
    /// No link has this name. Frames are links: add a link with a fixed joint for a tool or a palm.
    #[error("the robot has no link \"{name}\"{}", proposal(near))]
    UnknownLink {
        /// The requested name.
        name: String,
        /// Similar link names, nearest first.
        near: Vec<String>,
    },
    /// No active joint has this name.
    #[error("the robot has no active joint \"{name}\"{}; fixed and mimic joints have no coordinate", proposal(near))]
    UnknownJoint {
        /// The requested name.
        name: String,
        /// Similar names of active joints, nearest first.
        near: Vec<String>,
    },
    /// The number of values differs from the number of active joints.
    #[error("the configuration has {found} values, the robot has {expected} active joints; give one value each")]
    ConfigurationLength {
        /// The given length.
        found: usize,
        /// The number of active joints.
        expected: usize,
    },
    /// A configuration holds a NaN or an infinity.
    #[error("joint \"{joint}\" (value {index}): {value} is not a finite number")]
    NotFinite {
        /// The name of the first such joint.
        joint: String,
        /// Its index in the configuration, counted from 0.
        index: usize,
        /// The value itself.
        value: f64,
    },
    /// A coordinate is so large that positions computed from it could overflow.
    #[error("joint \"{joint}\" (value {index}): {value:e} is too far, {FARTHEST:e} is the most")]
    TooFar {
        /// The name of the first such joint.
        joint: String,
        /// Its index in the configuration, counted from 0.
        index: usize,
        /// The value itself, in radians or metres.
        value: f64,
    },
    /// The number of columns of a Jacobian differs from the number of active joints.
    #[error("the Jacobian has {found} columns, the robot has {expected} active joints; give one column each")]
    JacobianColumns {
        /// The given number of columns.
        found: usize,
        /// The number of active joints.
        expected: usize,
    },
    /// One of several configurations cannot be placed.
    #[error("configuration {index}: {reason}")]
    InBatch {
        /// The column of the first such configuration, counted from 0.
        index: usize,
        /// The reason.
        reason: Box<KinematicsError>,
    },
    /// Jacobians side by side do not have one column for each active joint in each configuration.
    #[error(
        "the Jacobians have {found} columns together; give {} ({configurations} configurations of {joints} active joints)",
        configurations * joints
    )]
    BatchColumns {
        /// The given number of columns.
        found: usize,
        /// The number of configurations.
        configurations: usize,
        /// The number of active joints.
        joints: usize,
    },
    /// Velocities do not have one value for each active joint in each configuration.
    #[error(
        "the velocities have the shape ({}, {}); give ({}, {}), active joints by configurations",
        found.0, found.1, expected.0, expected.1
    )]
    VelocitiesShape {
        /// The given numbers of rows and columns.
        found: (usize, usize),
        /// Active joints and configurations.
        expected: (usize, usize),
    },
    /// Collision geometry was requested, but the resolver lacks these meshes.
    #[error(
        "{} mesh(es) are missing: {}; resolve them, or leave them out on purpose",
        meshes.len(),
        meshes.iter().map(|(link, file)| format!("\"{file}\" of link \"{link}\"")).collect::<Vec<_>>().join(", ")
    )]
    MissingMeshes {
        /// Pairs of a link and a file, as the URDF names it.
        meshes: Vec<(String, String)>,
    },
    /// A mesh is not a shape.
    #[error("mesh \"{filename}\" of link \"{link}\": {reason}")]
    BadMesh {
        /// The link.
        link: String,
        /// The file, as the URDF names it.
        filename: String,
        /// Description of the fault.
        reason: String,
    },
    /// The damping of resolved-rate control is not a finite number of at least 0.
    #[error("damping {damping}: it must be a finite number, 0 or more")]
    Damping {
        /// The given damping.
        damping: f64,
    },
    /// The shapes of Jacobian, task velocity, pull and joint velocity do not match.
    #[error(
        "a task of {task} rows and a velocity of {velocity} joints do not fit a Jacobian of shape ({}, {}) and a pull of {pull} joints",
        jacobian.0, jacobian.1
    )]
    TaskShape {
        /// Rows and columns of the Jacobian.
        jacobian: (usize, usize),
        /// Rows of the task velocity.
        task: usize,
        /// Rows of the null-space pull.
        pull: usize,
        /// Rows of the joint velocity to be filled.
        velocity: usize,
    },
    /// The damped task has no solution: the task's rows are linearly dependent and there is no damping, or a value
    /// is not finite.
    #[error("the task is singular with damping {damping}; give a positive damping, and finite values")]
    SingularTask {
        /// The damping.
        damping: f64,
    },
}

impl KinematicsError {
    /// A broken rule at a link, a joint or the robot.
    pub(crate) fn urdf(element: Element, problem: UrdfProblem) -> Self {
        KinematicsError::Urdf { element, problem }
    }
}
