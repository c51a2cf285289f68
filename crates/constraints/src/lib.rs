//! Constraints on motion, and the projectors onto their null spaces.
//!
//! A Pfaffian constraint requires A(x,t) u = 0 (2) of the velocity u at every instant; for instance, a hand that wipes a
//! table must not leave its plane. A system with the policy π(x) then moves with u = N(x,t) π(x), where N = I − A⁺A (3)
//! is the orthogonal projection onto the null space of A. Constraints that push (A u = b, b ≠ 0) are not represented.
//!
//! - [`PfaffianConstraint`]: the trait of all constraints; implement it for your own.
//! - [`LinearConstraint`], [`Unconstrained`], [`Switching`]: the same A everywhere, none, and one after another in time.
//! - [`Barrier`]: plates that stop points in space, active only near them.
//! - [`PointConstraint`]: a hand in a plane or on a line, by the Jacobian of its position.
//! - [`NullSpaceProjector`]: N, applied without being formed.
//!
//! ```
//! use constraints::{LinearConstraint, PfaffianConstraint, Switching};
//! use nalgebra::{dmatrix, dvector};
//!
//! // Motion in the plane: for two seconds along the first axis only, then along the diagonal only.
//! let along_the_axis = LinearConstraint::new(dmatrix![0.0, 1.0])?;
//! let along_the_diagonal = LinearConstraint::new(dmatrix![1.0, -1.0])?;
//! let constraint = Switching::new(vec![(0.0, along_the_axis), (2.0, along_the_diagonal)])?;
//!
//! let (state, wanted) = (dvector![0.3, 0.7], dvector![1.0, 3.0]);
//! let early = constraint.null_space_projector(state.as_view(), 0.5)?.project(wanted.as_view());
//! let late = constraint.null_space_projector(state.as_view(), 2.0)?.project(wanted.as_view());
//! assert!((early - dvector![1.0, 0.0]).norm() < 1e-15);
//! assert!((late - dvector![2.0, 2.0]).norm() < 1e-15);
//! # Ok::<(), constraints::ConstraintError>(())
//! ```

mod barrier;
mod constraint;
mod error;
mod linear;
mod point;
mod projector;
mod switching;

pub use barrier::{Barrier, Plate};
pub use constraint::{PfaffianConstraint, Unconstrained};
pub use error::ConstraintError;
pub use linear::LinearConstraint;
pub use point::PointConstraint;
pub use projector::NullSpaceProjector;
pub use switching::Switching;

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
