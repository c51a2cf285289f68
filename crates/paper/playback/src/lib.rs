//! Movements of a humanoid's palms carried out with all its joints.
//!
//! Learners use palms only (Section 4.2). Showing a movement requires a whole body:
//! [`PalmTracking`] finds a [`JointPath`] that follows both palms within the joints' limits and keeps links apart.
//!
//! ```
//! use demo_gen::{Grasp, UpperBody};
//! use playback::PalmTracking;
//! use rand::SeedableRng;
//!
//! # let urdf = include_str!("../../../../robots/asimo_upper_body.urdf");
//! # let srdf = include_str!("../../../../robots/asimo_upper_body.srdf");
//! let grasp = Grasp::new(UpperBody::new(urdf, srdf)?);
//! let start = grasp.start(&mut rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
//! let palms = grasp.movement(&start)?.observed;
//! let path = PalmTracking::default().follow(&grasp.body, &palms, start.posture.as_view())?;
//! assert!(path.errors.max() < 1e-3 && path.clearances.min() > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Modules: `joint_path` contains the movement, `palm_control` the correction of a configuration, `link_gaps` the avoidance of
//! collisions, and `task` rows of Jacobians with their desired rates.

mod error;
mod joint_path;
mod link_gaps;
mod palm_control;
mod palm_tracking;
mod task;

pub use error::PlaybackError;
pub use joint_path::JointPath;
pub use palm_tracking::PalmTracking;
