//! Gaussian processes that learn a policy from demonstrations, with error bars and a report on its reliability.
//!
//! | item | function |
//! |---|---|
//! | [`SlopeGp`] | learns a potential from slopes along the observed motion: for unknown constraints that vary |
//! | [`DirectGp`] | learns the velocities: for unconstrained motion |
//! | [`AutoGp`] | fits both and returns the one that the data support |
//! | [`FrontEnd`] | turns demonstrations into [`Rows`] of states and velocities |
//! | [`ConstraintEstimates`] | estimates the constraints that acted, once the policy is known |
//! | [`TrustReport`] | [doubts](Doubt) and numbers about a [`SlopeFit`] |
//!
//! ```
//! use gp::{AutoGp, FrontEnd, Hypothesis};
//! use motion::{Demonstrations, Policy as _, Trajectory};
//! use nalgebra::{DMatrix, dvector};
//! use rand::SeedableRng as _;
//!
//! // The policy π(x) = −x, demonstrated along twelve rails: only its component along each rail is observed.
//! let movements = (0..12).map(|k| {
//!     let (angle, along) = (0.55 * f64::from(k), 0.9 * f64::from(k));
//!     let (start, rail) = (dvector![angle.cos(), angle.sin()] * 1.5, dvector![along.cos(), along.sin()]);
//!     let (fixed, sliding) = (&start - &rail * rail.dot(&start), &rail * rail.dot(&start));
//!     let left = |sample: usize| (-0.1 * sample as f64).exp();
//!     let states = DMatrix::from_fn(2, 20, |axis, sample| fixed[axis] + left(sample) * sliding[axis]);
//!     let velocities = DMatrix::from_fn(2, 20, |axis, sample| -left(sample) * sliding[axis]);
//!     Trajectory::new(states, 0.1)?.with_velocities(velocities)
//! });
//! let demonstrations = Demonstrations::new(movements.collect::<Result<_, _>>()?)?;
//!
//! let rows = FrontEnd::Velocities.rows(&demonstrations)?;
//! let learnt = AutoGp::default().fit(&rows, &mut rand::rngs::StdRng::seed_from_u64(1))?;
//!
//! assert_eq!(learnt.reading(), Hypothesis::Constrained); // so that the slope GP's policy is handed out
//! let x = dvector![0.3, -0.4];
//! assert!((learnt.action(x.as_view()) + &x).norm() < 1e-4);
//! assert!(learnt.slope().uncertainty(x.as_view()).trace() < 1e-4); // cov π(x)
//! assert!(learnt.slope().report().doubts().is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Equations
//!
//! Comments cite (S1)–(S47) and (R1)–(R10). [`equations`] defines them and lists the steps of the search; it is
//! `docs/slope-gp.md` of the repository. `docs/which-learner.md` compares the learners, `docs/decisions/gp.md` gives
//! the reasons.
//!
//! # When it fails
//!
//! - **The same constraint in every demonstration** makes the velocity a function of the state, like an unconstrained
//!   policy. The data cannot distinguish the two: [`Hypothesis::Ambiguous`], and [`TrustReport::least_seen`] names the
//!   direction that never moved.
//! - **Constraints that push** (A u = b, b ≠ 0) with A or b changing from sample to sample, or that project obliquely. While A and b are
//!   constant, the model learns from the directions in which velocities differ ([`TrustReport::push`]). This also applies to constraints on
//!   a robot's hand ([`Rows::with_task_spaces`]).
//! - **Motion that depends on more than the state** (time, a moving target) is [`Hypothesis::Unexplained`]. A quantity that is constant
//!   during a movement, such as a goal or a load, can be context ([`Rows::with_context`]).
//! - **Corridors**: if all movements follow one narrow path, nothing tests the policy across it.
//! - **Kinks in many dimensions** are learnt slowly; the held-out R² is then low and [`TrustReport::doubts`] says so.
//! - **More than 1,500 rows** are thinned, because time grows with their cube ([`SlopeGp::max_rows`]). With [`SlopeGp::inducing_rows`], up
//!   to 64 times as many rows (at most 32,000) are also used, if that predicts left-out movements better.
//! - [`GpError`]: no motion, too few rows, or of three or more trajectories, fewer than three with usable rows.

mod constraint_estimate;
mod dimension;
mod direct;
#[cfg(doc)]
pub mod equations;
mod error;
mod evidence;
mod formula;
mod inducing;
mod kernel;
mod learner;
mod left_out;
mod reading;
mod report;
mod rows;
mod scales;
mod screening_subset;
mod slope;
mod stored;
mod stretches;
mod support;

pub use constraint_estimate::{Acting, ConstraintEstimates, StretchEstimate};
pub use direct::data::DirectData;
pub use direct::direct_gp::{DirectFit, DirectGp};
pub use direct::model::DirectModel;
pub use error::GpError;
pub use evidence::Evidence;
pub use formula::{DirectFormula, ScaledStates, SlopeFormula};
pub use kernel::block::Block;
pub use kernel::direct_block::DirectBlock;
pub use kernel::falling::{Falling, Series, Summand};
pub use kernel::family::{Family, Trend};
pub use kernel::shape::Shape;
pub use kernel::term::{Exponential, Fall, Term};
pub use learner::{GpLearner, LearnsFromRows};
pub use left_out::LeftOutPredictions;
pub use left_out::curl_test::CurlTest;
pub use motion::LeastSeen;
pub use reading::Hypothesis;
pub use reading::auto_gp::{AutoFit, AutoGp};
pub use reading::numbers::{FreeRows, LeftOutRow, ReadingNumbers, TrajectoryErrors};
pub use report::doubt::Doubt;
pub use report::identifiability::Identifiability;
pub use report::trust_report::{FamilyNumbers, FamilyReport, ModelKind, TrustReport};
pub use rows::front_end::FrontEnd;
pub use rows::kept::{Grouping, RowsDropped};
pub use rows::task_space::TaskSpace;
pub use rows::{MOST_ROWS, Rows};
pub use scales::LearntScales;
pub use slope::data::SlopeData;
pub use slope::fit::SlopeFit;
pub use slope::model::SlopeModel;
pub use slope::policy::{SlopePolicy, SlopePotential};
pub use slope::push_test::PushTest;
pub use slope::slope_gp::SlopeGp;

/// The program of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
