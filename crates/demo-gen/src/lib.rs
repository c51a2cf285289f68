//! Simulated demonstrations: a system follows a known potential under constraints. The truth is recorded
//! separately from the observations.
//!
//! - [`Parabola`] (24), [`Sinusoidal`] (26): potentials φ; the demonstrated policy is π = −∇φ.
//! - [`RollOut`]: follows u = N(x,t) π(x) (3) from one start and yields a [`Recording`]; also follows any policy, without its truth.
//! - [`Recording`]: `observed`, a trajectory, and [`Truth`], which only judges may use.
//! - [`demonstrations`]: the observed part of many recordings, the only input of a learner.
//! - [`ToySystem`]: the paper's two-dimensional toy, many recordings from one generator.
//! - [`ThreeLinkArm`]: a planar arm whose hand stays on a line.
//! - [`UpperBody`]: the paper's humanoid, its posture "ready" and start states around it; [`HandInPlane`]: its movements with
//!   one hand in a plane.
//! - [`hand_jacobian`]: a robot's hand for a constraint; [`n_leaving_limits`]: counts movements that a real robot could not make.
//! - [`Grasp`]: reaching for a ball through a wall with a gap, in a [`GraspScene`].
//! - [`beyond`]: other policies, with and without a potential, in 2 to 22 dimensions.
//! - [`tasks`]: constraints A(x) u = b(x) with a task b: a limit cycle, and an arm that wipes.
//! - [`with_position_noise`], [`with_velocity_noise`]: add observation noise to recordings.
//!
//! ```
//! use constraints::LinearConstraint;
//! use demo_gen::{Parabola, RollOut, demonstrations};
//! use nalgebra::{dmatrix, dvector};
//!
//! let potential = Parabola { weight: 0.05, centre: dvector![0.0, 0.0] };
//! let constraint = LinearConstraint::new(dmatrix![1.0, 1.0])?;
//! let roll_out = RollOut { time_step: 1.0, n_samples: 40, ..RollOut::default() };
//! let recording = roll_out.record(&potential, &constraint, dvector![1.0, 0.0].as_view())?;
//!
//! // The constraint stops the system on the line x₁ + x₂ = 1, where it comes nearest to the centre.
//! let last = recording.observed.state(39);
//! assert!((last - dvector![0.5, 0.5]).norm() < 0.02);
//! // The unconstrained policy would still go on to the centre.
//! assert!((recording.truth.actions.column(39) + 0.1 * last).norm() < 1e-15);
//! assert_eq!(demonstrations(&[recording])?.n_samples(), 40);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod beyond;
mod error;
mod grasp;
mod grasp_scene;
mod instant;
mod noise;
mod potentials;
mod recording;
mod redraw;
mod robots;
mod roll_out;
pub mod tasks;
mod toy;
mod toy_potential;

pub use error::{DemoGenError, Part, Quantity};
pub use grasp::{Grasp, GraspStart};
pub use grasp_scene::GraspScene;
pub use noise::{with_position_noise, with_velocity_noise};
pub use potentials::{Parabola, Sinusoidal};
pub use recording::{Recording, Truth, demonstrations};
pub use redraw::Redraw;
pub use robots::hand::hand_jacobian;
pub use robots::hand_in_plane::HandInPlane;
pub use robots::limits::n_leaving_limits;
pub use robots::three_link_arm::ThreeLinkArm;
pub use robots::upper_body::{Side, UpperBody};
pub use roll_out::RollOut;
pub use toy::ToySystem;
pub use toy_potential::ToyPotential;

/// Compiles the README's program.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
