//! Forward kinematics, Jacobians and self-collision of robots described by URDF.
//!
//! Conventions everywhere: poses are in the root link's frame; metres and radians; Jacobian rows are vx vy vz wx wy wz
//! at the frame's origin, in root axes; configurations and columns follow the active joints in document order.
//! Functions that take a [`Workspace`] allocate nothing after the first call with it.
//!
//! ```
//! use kinematics::{RobotModel, Workspace};
//! use nalgebra::{DMatrix, DVector, Matrix6xX};
//!
//! let robot = RobotModel::from_urdf(
//!     r#"<robot name="door"><link name="frame"/><link name="leaf"/><link name="handle"/>
//!          <joint name="hinge" type="revolute"><parent link="frame"/><child link="leaf"/>
//!            <axis xyz="0 0 1"/><limit lower="0" upper="1.6"/></joint>
//!          <joint name="screw" type="fixed"><parent link="leaf"/><child link="handle"/>
//!            <origin xyz="0.8 0 1"/></joint></robot>"#,
//! )?;
//! let handle = robot.link("handle")?;
//! let mut workspace = Workspace::new();
//! let q = DVector::from_element(robot.n_joints(), std::f64::consts::FRAC_PI_2);
//! let poses = robot.forward_kinematics(q.as_view(), &mut workspace)?;
//! assert!((poses.position(handle).y - 0.8).abs() < 1e-15);
//!
//! let mut jacobian = Matrix6xX::zeros(robot.n_joints());
//! poses.jacobian(handle, &mut jacobian)?;
//! assert!((jacobian[(0, 0)] + 0.8).abs() < 1e-15);
//!
//! // Several configurations at once, in columns: the same numbers in less time.
//! let q = DMatrix::from_row_slice(1, 3, &[0.0, 0.5, std::f64::consts::FRAC_PI_2]);
//! let mut jacobians = Matrix6xX::zeros(3 * robot.n_joints());
//! let poses = robot.chain(handle).jacobians(q.as_view(), &mut workspace, &mut jacobians)?;
//! assert!((poses[2].translation.y - 0.8).abs() < 1e-15 && (jacobians[(0, 2)] + 0.8).abs() < 1e-15);
//! # Ok::<(), kinematics::KinematicsError>(())
//! ```
//!
//! Modules: `urdf` reads text into tags; `model` builds a robot from them; `nodes` holds the motion of one link;
//! `forward` computes poses and Jacobians; `collision` finds touching links (a feature, on by default);
//! `resolved_rate` computes joint velocities for a task.

#![allow(clippy::inline_always, reason = "vector dispatch compiles for a newer machine only what is inlined into it")]

#[cfg(feature = "collision")]
mod collision;
mod error;
mod forward;
mod model;
mod names;
mod nodes;
mod resolved_rate;
mod urdf;

#[cfg(feature = "collision")]
pub use collision::{Clearance, MeshShape, Nearby, SelfCollision};
pub use error::KinematicsError;
pub use forward::{Chain, LinkPoses, LinkPosesBatch, Workspace};
pub use model::{Attachment, CollisionShape, Inertial, Joint, JointMotion, LinkId, MotionKind, RobotModel};
pub use resolved_rate::ResolvedRate;
pub use urdf::{Element, Geometry, JointKind, UrdfProblem, UrdfWarning};

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
