use thiserror::Error;

use crate::{
    names::proposal,
    urdf::{Element, UrdfProblem},
};

/// Largest coordinate of a configuration that can be placed: positions and their squares stay finite.
pub(crate) const FARTHEST: f64 = 1e100;

/// Why a robot cannot be built or evaluated.
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
    /// No link has this name. Frames are links: add a link with a fixed joint for a tool or a palm.
    #[error("the robot has no link \"{name}\"{}", proposal(near))]
    UnknownLink {
        /// The requested name.
        name: String,
        /// Link names like it, nearest first.
        near: Vec<String>,
    },
    /// No active joint has this name.
    #[error("the robot has no active joint \"{name}\"{}; fixed and mimic joints have no coordinate", proposal(near))]
    UnknownJoint {
        /// The requested name.
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
    /// A coordinate so large that positions computed from it could overflow.
    #[error("joint \"{joint}\" (value {index}): {value:e} is too far, {FARTHEST:e} is the most")]
    TooFar {
        /// The name of the first such joint.
        joint: String,
        /// Its place in the configuration, counted from 0.
        index: usize,
        /// The value itself, in radians or metres.
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
    /// One of several configurations cannot be placed.
    #[error("configuration {index}: {reason}")]
    InBatch {
        /// The column of the first such configuration, counted from 0.
        index: usize,
        /// What is wrong with it.
        reason: Box<KinematicsError>,
    },
    /// Jacobians to be filled side by side have not one column for each active joint in each configuration.
    #[error(
        "the Jacobians have {found} columns together; give {} ({configurations} configurations of {joints} active joints)",
        configurations * joints
    )]
    BatchColumns {
        /// The number of columns given.
        found: usize,
        /// The number of configurations.
        configurations: usize,
        /// The number of active joints.
        joints: usize,
    },
    /// Velocities have not one value for each active joint in each configuration.
    #[error(
        "the velocities have the shape ({}, {}); give ({}, {}), active joints by configurations",
        found.0, found.1, expected.0, expected.1
    )]
    VelocitiesShape {
        /// Rows and columns given.
        found: (usize, usize),
        /// Active joints and configurations.
        expected: (usize, usize),
    },
    /// Collision geometry was requested, and the resolver does not have these meshes.
    #[error(
        "{} mesh(es) are missing: {}; resolve them, or leave them out on purpose",
        meshes.len(),
        meshes.iter().map(|(link, file)| format!("\"{file}\" of link \"{link}\"")).collect::<Vec<_>>().join(", ")
    )]
    MissingMeshes {
        /// Links, and the files as the URDF names them.
        meshes: Vec<(String, String)>,
    },
    /// A mesh is not a shape.
    #[error("mesh \"{filename}\" of link \"{link}\": {reason}")]
    BadMesh {
        /// The link.
        link: String,
        /// The file, as the URDF names it.
        filename: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The damping of a resolved-rate step is not a number from 0 up.
    #[error("damping {damping}: it must be a finite number, 0 or more")]
    Damping {
        /// The damping given.
        damping: f64,
    },
    /// Jacobian, task velocity, pull and joint velocity do not fit together.
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
        /// Rows of the joint velocity to be written.
        velocity: usize,
    },
    /// The damped task has no solution: the task's rows depend on one another and there is no damping, or a value is
    /// not finite.
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
