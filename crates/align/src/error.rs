use thiserror::Error;

/// Reasons why nothing could be learnt. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum AlignError {
    /// A parameter is outside its range.
    #[error("{name} is {value}: it must {requirement}")]
    Parameter {
        /// Name of the field.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The condition on the value.
        requirement: &'static str,
    },
    /// The integration rule needs velocities that were not recorded.
    #[error(
        "trajectory {trajectory} has no recorded velocities, which this integration rule needs; add them with Trajectory::with_velocities or use Integration::Displacement"
    )]
    NoVelocities {
        /// The first trajectory without velocities.
        trajectory: usize,
    },
    /// The potential along a trajectory exceeds the range of f64.
    #[error(
        "trajectory {trajectory}: the potential overflows at sample {sample}; use larger units of length or smaller ones of time"
    )]
    PotentialOverflow {
        /// The trajectory.
        trajectory: usize,
        /// The first sample whose potential is not finite.
        sample: usize,
    },
    /// The potential along a trajectory is too small for f64, although the trajectory moves.
    #[error(
        "trajectory {trajectory}: it moves, but its potential underflows to {lowest:e}; use smaller units of length or larger ones of time"
    )]
    PotentialUnderflow {
        /// The trajectory.
        trajectory: usize,
        /// The largest magnitude of its potential.
        lowest: f64,
    },
    /// Squared distances between samples exceed the range of f64.
    #[error(
        "the samples span {span:e} in dimension {dimension}, so squared distances overflow; use larger units of length"
    )]
    SpanOverflow {
        /// The dimension with the widest span.
        dimension: usize,
        /// Largest minus smallest coordinate there.
        span: f64,
    },
    /// The bandwidth rule compares trajectories, but there is only one.
    #[error(
        "a single trajectory has no distance to others, so its bandwidth is undefined; give more or use Bandwidth::Fixed"
    )]
    SingleTrajectory,
    /// The bandwidth is zero because trajectories share points.
    #[error(
        "the bandwidth is 0 since trajectories touch exactly, {}; drop duplicated trajectories, or, where positions are rounded, use {}",
        name_pairs(pairs), fixed(*usable)
    )]
    ZeroBandwidth {
        /// All pairs of trajectories at squared distance zero, lower index first.
        pairs: Vec<(usize, usize)>,
        /// The rule's σ² from the distances of all other pairs, in units of the state squared, for use with
        /// `Bandwidth::Fixed`. `None` if there are too few.
        usable: Option<f64>,
    },
    /// The alignment would take too much memory.
    #[error(
        "the alignment could take {:.1} GB of memory, more than the {:.1} GB allowed; give fewer trajectories, every second sample or a narrower bandwidth, or raise PolicyAlign::memory_limit",
        *needed as f64 * 1e-9, *limit as f64 * 1e-9
    )]
    Memory {
        /// Bytes that it could need.
        needed: u64,
        /// Bytes that it may use.
        limit: u64,
    },
    /// The eigenvalues of the alignment graph could not be computed.
    #[error("the eigenvalues of H did not converge; try another bandwidth")]
    NoConvergence,
    /// The offsets exceed the range of f64.
    #[error(
        "the offset of trajectory {trajectory} is not finite: potentials differ by too much; use larger units of length"
    )]
    OffsetOverflow {
        /// The first trajectory with such an offset.
        trajectory: usize,
    },
    /// No sample remains to learn from.
    #[error("no sample is left to learn from; hold out fewer or give more trajectories")]
    NoSamples,
    /// The number of channels differs from the dimension.
    #[error("{found} channels for a state of {expected} dimensions; give one for each, or none")]
    Channels {
        /// Number of given channels.
        found: usize,
        /// Number of dimensions.
        expected: usize,
    },
    /// Movements depended on something besides the state, which a potential of the state cannot represent.
    #[error(
        "trajectory {trajectory} has another context (goal, object) than the first; align movements of one context each, or fit \
         the slope GP, which learns policies of a context"
    )]
    Context {
        /// The first trajectory whose context differs.
        trajectory: usize,
    },
    /// A stored policy has an unknown format version.
    #[error(
        "the stored policy has version {found}, this program reads 1 to {known}; use the program that stored it, or a newer one"
    )]
    PolicyVersion {
        /// The version found.
        found: u32,
        /// The newest version that can be read.
        known: u32,
    },
    /// A stored policy is inconsistent.
    #[error("the stored policy is damaged: {reason}")]
    CorruptPolicy {
        /// Description of the fault.
        reason: &'static str,
    },
    /// The regression refused its parameters or its data.
    #[error("LWPR: {0}")]
    Lwpr(#[from] lwpr::LwprError),
}

fn name_pairs(pairs: &[(usize, usize)]) -> String {
    const SHOWN: usize = 5;
    let named: Vec<_> = pairs.iter().take(SHOWN).map(|(k, j)| format!("{k} and {j}")).collect();
    let more = pairs.len().saturating_sub(SHOWN);
    if more == 0 { named.join(", ") } else { format!("{} and {more} more pairs", named.join(", ")) }
}

fn fixed(usable: Option<f64>) -> String {
    usable.map_or("Bandwidth::Fixed".to_owned(), |usable| format!("Bandwidth::Fixed({usable:.3e})"))
}
