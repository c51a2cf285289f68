//! Learns a policy from recorded movements under unknown constraints, and reports how far it can be trusted. Library
//! and program.
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use policy_align::motion::Policy as _;
//! use policy_align::nalgebra::{self, dvector}; // its macros name it
//! use policy_align::{FitOptions, PrepareOptions, Progress, Verdict, demo_io, fit, prepare};
//!
//! // 40 movements of a point that slides down a bowl along rails, π(x) = −2x.
//! let file = std::path::Path::new("../../docs/examples/toy.csv");
//! let recordings = demo_io::read(file, &demo_io::ReadOptions::default(), &mut |_bytes| ())?;
//! let prepared = prepare(&recordings, &PrepareOptions::default())?;
//!
//! let options = FitOptions { max_rows: 150, ..FitOptions::default() };
//! let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_step| () };
//! let model = fit(&prepared, &options, &mut progress)?;
//! assert_eq!(model.trust.verdict, Verdict::Good);
//! assert!(model.trust.numbers.held_out_error < 1e-3);
//!
//! let action = model.policy().action(dvector![0.3, 1.2].as_view());
//! assert!((action - dvector![-0.6, -2.4]).norm() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | step | item |
//! |---|---|
//! | prepare recordings | [`prepare()`]: each automatic choice is a [`Decision`] |
//! | learn | [`fit()`]: a [`Model`] with its [`Trust`], every doubt a [`Finding`] |
//! | learn from files larger than memory | [`Division`]: the files read at once; [`Digester`]: digests of the others; [`fit_with`] |
//! | store | [`Model`]: [`Model::save`], [`Model::load`], [`Model::policy`] in the units of the recording |
//! | use | [`RollOut`] under constraints; [`CSource`] and [`to_onnx`] export a policy without dependencies, [`to_lerobot`] for LeRobot |
//! | command | [`VelocityController`]: joint states in, velocities out, zero when the robot must stop |
//! | evaluate | [`evaluate()`] on other recordings, [`leave_constraints_out`] across constraints |
//!
//! Guides in `docs`: `your-own-data.md` (the program step by step), `which-learner.md`, `model-file.md`, `slope-gp.md`
//! (equations). `docs/your-own-data.md` lists the faults found in recordings, and links the verdicts on all kinds that the tests contain.
//!
//! # Exit codes of the program
//!
//! | code | meaning |
//! |---|---|
//! | 0 | success |
//! | 1 | the data or the result is refused: verdict "do not use", `--require` not met, nothing to learn from |
//! | 2 | usage: an unknown flag, a value out of range, a column that does not exist, an invalid constraint file |
//! | 3 | a file cannot be read or written, or is damaged |
//! | 4 | a bug in the program |
//! | 130 | interrupted by Ctrl-C |
//!
//! Errors have three lines on standard error: what is wrong, where, and what to try.
//!
//! # When it fails
//!
//! - **The same constraint in every recording** hides part of the policy; no learner can recover it. The verdict is
//!   then doubtful.
//! - **Constraints that push** (A u = b with b ≠ 0) are recovered only while A and b stay constant for some twenty
//!   samples, and oblique projections only if a robot's inertia makes them so.
//! - **Motion that depends on more than the recorded state** (time, a moving target): mostly "doubtful" or "do not use". What is constant during a
//!   movement, such as a goal or a load, can be context: [`Model::in_context`].
//! - **Mixed units**: constraints project orthogonally in some unit. [`fit()`] learns it if the data determine it;
//!   [`PrepareOptions::scale`] chooses it.
//! - **Outside the demonstrated region** a policy extrapolates: [`ModelPolicy::is_supported`] is false there.
//! - [`PrepareError`], [`FitError`], [`ModelError`], [`RollOutError`] and [`ExportError`] describe the fault and
//!   the remedy.

mod along;
mod channel_joints;
mod choice;
mod context;
mod error;
mod evaluate;
mod export;
mod fit;
mod halton;
mod large;
mod learnt;
mod leave_out;
mod model;
mod model_policy;
mod named;
mod robot_frames;
mod roll_out;
mod serving;
mod stored;
mod trust;

/// Dependencies that a program needs, re-exported so that it depends on this crate alone.
pub use ::{align, constraints, demo_io, gp, kinematics, lwpr, motion, nalgebra, prepare, rand, smoothing};
pub use channel_joints::joints_in_degrees;
pub use choice::Choice;
pub use context::ContextError;
pub use error::FitError;
pub use evaluate::{EvaluateError, Evaluation, Truth, evaluate};
pub use export::{CSource, ExportError, Precision, to_lerobot, to_onnx};
pub use fit::{Digest, FitOptions, LearnerChoice, Progress, Step, fit, fit_with};
pub use large::{DigestError, Digester, Division, FurtherPiece, Part, PartError, Unfinished};
pub use learnt::Learnt;
pub use leave_out::{ConstraintLeftOut, leave_constraints_out};
pub use model::{DataSummary, FileSummary, MadeBy, Model, PredictedSpeed};
pub use model_policy::{ModelPolicy, ModelPotential};
pub use motion::{Decision, Finding, LeftOut, Subject, Topic, Verdict};
pub use named::{ConstraintOn, ConstraintStretch, TaskLinks, constraint_file, estimate_constraints};
pub use prepare::{
    ContextUse, Noise, PrepareError, PrepareOptions, Prepared, Repair, Smoothing, StateChannel, VelocitySource,
    VelocityUse, direction_by_channels, prepare, trim_still,
};
pub use robot_frames::RobotFrames;
pub use roll_out::{ConstraintFileError, ConstraintSet, JointLimits, Path, RollOut, RollOutError, Stop, spread_starts};
pub use serving::{ControllerError, Halt, Quantity, VelocityCommand, VelocityController};
pub use stored::{ModelError, checksum_of, sha256, sha256_of_file, write_together, write_whole};
pub use trust::{AlignedNumbers, Trust, TrustNumbers};

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Compiles the program in docs/rust.md.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/rust.md")]
struct RustPage;
