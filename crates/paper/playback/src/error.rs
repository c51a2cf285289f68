use demo_gen::DemoGenError;
use kinematics::KinematicsError;
use thiserror::Error;

/// The reason why a movement cannot be carried out.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlaybackError {
    /// The pull or the number of corrections is out of range.
    #[error(
        "pull {pull}, {corrections} corrections a sample: the pull must be from 0 to 1, the corrections at least 1"
    )]
    Tracking {
        /// The pull given.
        pull: f64,
        /// The number of corrections given.
        corrections: usize,
    },
    /// The clearance is out of range.
    #[error("clearance {clearance} m: it must be a finite number of metres, 0 or more")]
    Clearance {
        /// The clearance given, in metres.
        clearance: f64,
    },
    /// The stride is out of range.
    #[error("stride {stride}: it must be a number of radians above 0")]
    Stride {
        /// The stride given, in radians, or metres where a joint slides.
        stride: f64,
    },
    /// The movement of the hands does not consist of two points in space.
    #[error("the movement has {found} dimensions; those of a left and a right palm are 6")]
    Palms {
        /// Its number of dimensions.
        found: usize,
    },
    /// The robot has no such joint, or rejects a configuration or the damping.
    #[error(transparent)]
    Robot(#[from] KinematicsError),
    /// The positions of the palms cannot be computed.
    #[error(transparent)]
    Body(#[from] DemoGenError),
}
