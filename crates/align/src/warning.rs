use std::fmt;

use crate::bipartition::Partition;

/// More than this share of trajectories discarded is worth a word.
const MANY: f64 = 0.5;
/// A λ₂ below so many thresholds is worth a word.
const NEAR: f64 = 10.0;

/// Why the result of an alignment may not be what was wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// More than half of the trajectories hang together too weakly to be levelled.
    ManyDiscarded {
        /// How many were discarded.
        discarded: usize,
        /// Of how many.
        of: usize,
    },
    /// A part of the kept trajectories is barely connected to the rest: its level may be wrong.
    BarelyConnected {
        /// λ₂ of the kept trajectories.
        lambda_2: f64,
        /// The threshold below which they would have been taken apart.
        threshold: f64,
    },
}

impl Warning {
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
        }
    }
}
