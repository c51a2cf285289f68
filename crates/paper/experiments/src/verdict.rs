//! The rule that compares our numbers with the paper's.

use serde::{Deserialize, Serialize};

use crate::measure::Kind;
use crate::paper::Printed;

/// Result of comparing our mean with the printed one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Within the band around the printed mean.
    Agrees,
    /// Below the band: a smaller error of the learner.
    #[serde(alias = "better")]
    Lower,
    /// Above the band: a larger error of the learner.
    #[serde(alias = "worse")]
    Higher,
    /// Outside the band, for measures where neither direction is better.
    Differs,
}

/// A printed share of 0 ± 0 agrees with any share that would be printed as 0: below 0.005 percent.
const PRINTED_ZERO: f64 = 0.005;

/// Judges our mean: it agrees within one printed s.d. Only an error that depends on the learner can be lower or higher.
pub(crate) fn verdict(kind: Kind, ours: f64, paper: Printed) -> Verdict {
    let difference = ours - paper.mean;
    let band = match kind {
        Kind::Share if paper.mean == 0.0 && paper.sd == 0.0 => PRINTED_ZERO,
        _ => paper.sd,
    };
    match kind {
        _ if difference.abs() <= band => Verdict::Agrees,
        Kind::Share | Kind::BaselineError | Kind::SetUpError => Verdict::Differs,
        Kind::LearnerError if difference < 0.0 => Verdict::Lower,
        Kind::LearnerError => Verdict::Higher,
    }
}

impl Verdict {
    /// The word beside one cell.
    pub fn word(self) -> &'static str {
        self.words()[0]
    }

    /// The words that follow a count of one.
    pub fn singular(self) -> &'static str {
        self.words()[1]
    }

    /// The words that follow a larger count.
    pub fn plural(self) -> &'static str {
        self.words()[2]
    }

    fn words(self) -> [&'static str; 3] {
        match self {
            Verdict::Agrees => ["agrees", "agrees", "agree"],
            Verdict::Lower => ["lower", "is lower", "are lower"],
            Verdict::Higher => ["higher", "is higher", "are higher"],
            Verdict::Differs => ["differs", "differs", "differ"],
        }
    }

    /// Whether the verdict is "agrees" or "lower".
    pub fn reached(self) -> bool {
        matches!(self, Verdict::Agrees | Verdict::Lower)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_and_shares_are_judged_by_their_own_band() {
        let printed = |mean, sd| Printed { mean, sd };
        for (kind, ours, paper, expected) in [
            (Kind::LearnerError, 0.625, printed(0.5, 0.125), Verdict::Agrees),
            (Kind::LearnerError, 0.375, printed(0.5, 0.125), Verdict::Agrees),
            (Kind::LearnerError, 0.0625, printed(0.0625, 0.0), Verdict::Agrees),
            (Kind::LearnerError, 0.0501, printed(0.04, 0.01), Verdict::Higher),
            (Kind::LearnerError, 0.0299, printed(0.04, 0.01), Verdict::Lower),
            (Kind::Share, 12.0, printed(10.0, 2.0), Verdict::Agrees),
            (Kind::Share, 7.9, printed(10.0, 2.0), Verdict::Differs),
            (Kind::Share, 12.1, printed(10.0, 2.0), Verdict::Differs),
            (Kind::BaselineError, 0.85, printed(0.75, 0.125), Verdict::Agrees),
            (Kind::BaselineError, 0.9, printed(0.75, 0.125), Verdict::Differs),
            (Kind::SetUpError, 0.4, printed(0.75, 0.125), Verdict::Differs),
            (Kind::SetUpError, 0.7, printed(0.75, 0.125), Verdict::Agrees),
            (Kind::Share, 0.004, printed(0.0, 0.0), Verdict::Agrees),
            (Kind::Share, 0.006, printed(0.0, 0.0), Verdict::Differs),
        ] {
            assert_eq!(verdict(kind, ours, paper), expected, "{kind:?} {ours} against {paper:?}");
        }
    }
}
