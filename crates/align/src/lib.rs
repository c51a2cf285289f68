//! Learns potential-based policies from constrained motion by aligning local potentials.
//!
//! ```
//! use align::{Bandwidth, LwprRegressor, PolicyAlign};
//! use motion::{Demonstrations, Policy};
//! use nalgebra::{DMatrix, DVector};
//! use rand::SeedableRng;
//!
//! // Movements down φ = ‖x‖²/20 from eight places, sampled once a second.
//! let movements = (0..8).map(|k| {
//!     let angle = f64::from(k);
//!     DMatrix::from_fn(2, 60, |row, i| 0.9_f64.powi(i as i32) * if row == 0 { angle.cos() } else { angle.sin() })
//! });
//! let demonstrations = Demonstrations::from_states(movements, 1.0)?;
//!
//! let aligned = PolicyAlign { bandwidth: Bandwidth::Medium, ..Default::default() }.align(&demonstrations)?;
//! assert_eq!(aligned.kept().len(), 8);
//!
//! let mut rng = rand::rngs::StdRng::seed_from_u64(1);
//! let learnt = aligned.learn(&LwprRegressor::default(), &mut rng)?;
//! let x = DVector::from_vec(vec![0.3, 0.1]);
//! let u = learnt.action(x.as_view());
//! assert!((u + 0.1 * &x).norm() < 0.02);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The problem
//!
//! A system follows a policy u = π(x) that descends a potential, π(x) = −∇φ(x) (1), (4). Unknown constraints, which
//! vary between movements, only pass the component N(x, t) π(x) (3). Regression on the observed velocities averages
//! over the constraints; this crate recovers π itself.
//!
//! # The algorithm
//!
//! 1. [`Integration`]: N projects orthogonally, so dφ = −uᵀdx along every trajectory. This gives the potential along it
//!    up to a constant (5)–(9).
//! 2. [`LocalPotential`]: each trajectory predicts the potential of any state by that of its nearest sample (10).
//! 3. [`Bandwidth`]: responsibilities weigh these predictions by distance (11), (12), with σ² from the distances
//!    between trajectories (18)–(22).
//! 4. [`AlignmentObjective`]: the offsets of all local potentials minimise their weighted disagreement (13)–(17), a
//!    quadratic form whose matrix is the Laplacian of a graph of trajectories.
//! 5. If the graph has separate parts, their relative offsets are undetermined: the largest group is kept, the others
//!    are discarded (Sec. 3.3, App. B).
//! 6. A [`Regressor`], by default LWPR, learns the global potential from the aligned samples (23). Its negative
//!    gradient is the policy.
//!
//! [`PolicyAlign::align`] performs steps 1 to 5, and [`Aligned`] holds the result with its [`Warning`]s.
//! [`DirectPolicyLearning`] is the naive regression, for comparison.
//!
//! # When it fails
//!
//! - **Few movements**: trajectories must pass near each other under different constraints. The slope GP of the crate
//!   `gp` needs fewer.
//! - **No potential**: cycles and rotation are not represented.
//! - **Constraints that push** (A u = b, b ≠ 0), move or project obliquely: dφ = −uᵀdx does not hold.
//! - **Noisy positions** bias the integrated potential. Record velocities, or smooth the positions first (crate
//!   `smoothing`).
//! - **Many groups**: if [`Aligned::discarded`] is long, use a wider [`Bandwidth`] or record more.
//! - **A context** (goal, object) that differs between movements: the slope GP learns policies with a context.
//! - [`AlignError`]: parameters out of range, missing velocities, an undefined bandwidth, overflow, or too little
//!   memory.
//!
//! # Conventions
//!
//! The learner uses only [`motion::Demonstrations`]: the crate does not depend on any crate with access to the
//! constraints or the true policy. The caller passes the random generator; the same seed gives the same bits at any
//! number of threads. `docs/notation.md` maps the symbols of the paper to names.
//!
//! Reading the source: `algorithm` has one line for each step; `integration`, `bandwidth`, and the folders `search`
//! (nearest samples) and `offsets` (responsibilities, objective, groups, offsets) implement the steps; `learning`
//! contains the regression and the policies.

mod algorithm;
mod aligned;
mod bandwidth;
mod checks;
mod error;
mod integration;
mod learning;
mod local_potential;
mod offsets;
mod samples;
mod search;
mod sparse;
mod warning;

pub use algorithm::PolicyAlign;
pub use aligned::Aligned;
pub use bandwidth::Bandwidth;
pub use error::AlignError;
pub use integration::Integration;
pub use learning::{
    DirectPolicy, DirectPolicyLearning, GlobalPotential, LwprRegressor, Origin, PotentialPolicy,
    PotentialPolicyLearning, Regressor,
};
pub use local_potential::LocalPotential;
pub use offsets::{AlignmentObjective, Split, SplitCause};
pub use samples::{SampleIter, Samples};
pub use warning::Warning;

/// The program of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
