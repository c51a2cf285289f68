//! Learning potential-based policies from constrained motion by aligning local potentials.
//!
//! A system follows a policy u = π(x) that descends a potential, π(x) = −∇φ(x) (1), (4), but under constraints that are
//! unknown and may differ from movement to movement, only the part N(x, t) π(x) that they leave can be seen (3).
//! Regression of what was seen averages over the constraints; this crate recovers π itself.
//! Wherever the system moves, it moves within the constraint, so that dφ = −uᵀdx: along every single trajectory the
//! potential follows by [`Integration`] (5)–(9), up to a constant.
//! Each trajectory thus gives a [`LocalPotential`], which says of any state what it knows of its nearest sample (10).
//! Trajectories that come near each other should agree there: how far each speaks for a state is its responsibility
//! (11), (12), with a [`Bandwidth`] taken from the distances between trajectories (18)–(22).
//! The offsets that level all local potentials minimise their weighted disagreement, a quadratic form
//! ([`AlignmentObjective`], (13)–(17)) whose matrix is the Laplacian of a graph of trajectories.
//! Where that graph falls apart, relative offsets are unknown: the largest part is kept, the rest discarded (Sec. 3.3).
//! [`PolicyAlign::align`] does all this, and [`Aligned`] tells what it found and what gives reason for doubt.
//! A [`Regressor`], LWPR unless another is given, then learns the global potential from the levelled samples (23), and
//! its negative gradient is the policy.
//! [`DirectPolicyLearning`] is the naive regression to compare with.
//!
//! ```
//! use align::{Bandwidth, LwprRegressor, PolicyAlign};
//! use motion::{Demonstrations, Policy};
//! use nalgebra::{DMatrix, DVector};
//! use rand::SeedableRng;
//!
//! // Movements down φ = ‖x‖²/20 from eight places, seen once a second.
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
//! The learner sees [`motion::Demonstrations`] and nothing else: this crate depends on none that knows the constraints
//! or the true policy. Randomness is handed in, and the same seed gives the same bits at any number of threads.
//!
//! Reading on: `algorithm` is the algorithm, a line a step; `integration`, `bandwidth`, and the folders `search` (nearest
//! samples) and `levelling` (responsibilities, objective, groups, offsets) are the steps; `learning` is the rest.

mod algorithm;
mod aligned;
mod bandwidth;
mod error;
mod integration;
mod learning;
mod levelling;
mod local_potential;
mod samples;
mod scrutiny;
mod search;
mod warning;

pub use algorithm::PolicyAlign;
pub use aligned::Aligned;
pub use bandwidth::Bandwidth;
pub use error::AlignError;
pub use integration::Integration;
pub use learning::{
    DirectPolicy, DirectPolicyLearning, GlobalPotential, Label, LwprRegressor, Origin, PotentialPolicy,
    PotentialPolicyLearning, Regressor,
};
pub use levelling::{AlignmentObjective, Split, SplitCause};
pub use local_potential::LocalPotential;
pub use samples::{SampleIter, Samples};
pub use warning::Warning;

/// The program of docs/rust.md, compiled.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/rust.md")]
struct RustPage;
