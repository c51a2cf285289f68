//! Errors of learnt policies and potentials against the truth, (A1)–(A4), and their summary over data sets.
//!
//! All are mean squared errors divided by the variance of the truth: 0 is perfect, 1 is as good as the best
//! constant. Samples are columns: a policy at N test states is an (n, N) matrix, a potential a vector (N).
//!
//! - [`nupe`]: error of the unconstrained policy (A1).
//! - [`ncpe`]: error of the policy projected through given constraints (A2).
//! - [`nppe`], [`npoe`]: errors of estimated constraints, measured by the policy and by the velocities that they allow.
//! - [`potential_nmse`]: error of a potential, up to a constant (A3), (A4).
//! - [`Summary`]: mean, standard deviation and median over data sets.
//!
//! ```
//! use metrics::{Summary, ncpe, nupe, potential_nmse};
//! use nalgebra::{dmatrix, dvector};
//!
//! let truth = dmatrix![1.0, -1.0, 0.0; 0.0, 1.0, -1.0];
//! let learnt = dmatrix![1.0, -1.0, 0.0; 0.5, 1.5, -0.5];
//! // Wrong by 0.5 in the second dimension; the truth has variance 2/3 in each.
//! assert!((nupe(&truth, &learnt)? - 0.25 / (4.0 / 3.0)).abs() < 1e-15);
//! // Under constraints that let only the first dimension move, nothing of that shows.
//! assert_eq!(ncpe(&truth, &learnt, |_sample, mut difference| difference[1] = 0.0)?, 0.0);
//! // A potential is known up to a constant only.
//! assert!(potential_nmse(&dvector![0.0, 1.0, 4.0], &dvector![7.0, 8.0, 11.0])? < 1e-30);
//!
//! let summary = Summary::of(&[0.02, 0.03, 0.07])?;
//! assert_eq!(summary.median, 0.03);
//! # Ok::<(), metrics::MetricsError>(())
//! ```

mod error;
mod policy;
mod potential;
mod spread;
mod summary;

pub use error::{MetricsError, Series};
pub use policy::{ncpe, npoe, nppe, nupe};
pub use potential::potential_nmse;
pub use summary::Summary;

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
