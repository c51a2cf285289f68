use std::fmt;

use crate::offsets::bipartition::Partition;

/// Share of discarded trajectories above which a warning is given.
const MANY: f64 = 0.5;
/// A warning is given if λ₂ is below this number of thresholds.
const NEAR: f64 = 10.0;

/// Reasons to doubt the result of an alignment.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// More than half of the trajectories are connected too weakly to be aligned.
    ManyDiscarded {
        /// Number of discarded trajectories.
        discarded: usize,
        /// Number of all trajectories.
        of: usize,
    },
    /// A part of the kept trajectories is barely connected to the rest, so its level may be wrong.
    BarelyConnected {
        /// λ₂ of the kept trajectories.
        lambda_2: f64,
        /// The threshold below which they would have been separated.
        threshold: f64,
    },
    /// Even the longest trajectory has less than half as many samples as dimensions.
    LooksTransposed {
        /// Dimensions of the state.
        dim: usize,
        /// Samples of the longest trajectory.
        n_samples: usize,
    },
    /// One step is more than ten times as long as its neighbours, because of a wrapped angle or missing samples.
    LongStep {
        /// The trajectory.
        trajectory: usize,
        /// The sample before its longest such step.
        sample: usize,
        /// Its length, as a multiple of the trajectory's usual step.
        times: f64,
    },
    /// The trajectory never moves and carries no information about the policy.
    StandsStill {
        /// The trajectory.
        trajectory: usize,
    },
    /// Two trajectories have the same states.
    Duplicated {
        /// Both, the lower first.
        trajectories: [usize; 2],
    },
    /// One trajectory is another one run backwards, so one of them ascends.
    Mirrored {
        /// Both, the lower first.
        trajectories: [usize; 2],
    },
}

impl Warning {
    /// Warnings about the connections between trajectories.
    pub(crate) fn about(partition: &Partition, threshold: f64) -> Vec<Self> {
        let of: usize = partition.groups.iter().map(Vec::len).sum();
        let discarded = of - partition.groups[0].len();
        let many = (discarded as f64 > MANY * of as f64).then_some(Warning::ManyDiscarded { discarded, of });
        let lambda_2 = partition.lambda_2.filter(|&lambda_2| lambda_2 < NEAR * threshold);
        let barely = lambda_2.map(|lambda_2| Warning::BarelyConnected { lambda_2, threshold });
        many.into_iter().chain(barely).collect()
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::ManyDiscarded { discarded, of } => write!(
                f,
                "{discarded} of {of} trajectories are too weakly connected to the rest and were discarded; use a wider bandwidth or give more trajectories"
            ),
            Warning::BarelyConnected { lambda_2, threshold } => write!(
                f,
                "a part of the kept trajectories is barely connected to the rest (lambda_2 = {lambda_2:e}, threshold {threshold:e}); use a wider bandwidth or a higher threshold"
            ),
            Warning::LooksTransposed { dim, n_samples } => write!(
                f,
                "the state has {dim} dimensions, and no trajectory more than {n_samples} sample(s); samples are columns: transpose the matrices if they are rows"
            ),
            Warning::LongStep { trajectory, sample, times } => write!(
                f,
                "trajectory {trajectory}: the step after sample {sample} is {times:.0} times as long as usual; unwrap angles, and cut the trajectory where samples are missing"
            ),
            Warning::StandsStill { trajectory } => {
                write!(f, "trajectory {trajectory} never moves; leave it out")
            }
            Warning::Duplicated { trajectories: [k, j] } => {
                write!(f, "trajectories {k} and {j} have the same states; leave one out unless both were shown")
            }
            Warning::Mirrored { trajectories: [k, j] } => {
                write!(f, "trajectory {j} is trajectory {k} run backwards; leave out the one that was not shown")
            }
        }
    }
}
