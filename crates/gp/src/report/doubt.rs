use std::fmt;

/// A reason to doubt a policy. `Display` says it in one sentence.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt {
    /// Two readings explain the demonstrations equally well.
    AmbiguousReading,
    /// Neither reading predicts left-out movements.
    UnexplainedMovements,
    /// There are too few demonstrations to tell whether constraints acted.
    TooFewDemonstrations,
    /// Left-out movements are not predicted.
    NotPredicted {
        /// Held-out R².
        r_squared: f64,
    },
    /// Left-out movements are predicted poorly.
    PoorlyPredicted {
        /// Held-out R².
        r_squared: f64,
    },
    /// Held-out errors are far larger than their predicted standard deviations.
    WrongNoise {
        /// √z².
        factor: f64,
    },
    /// The prior determines most of the policy along a direction.
    MostlyPrior {
        /// The direction, (n).
        direction: Vec<f64>,
        /// Posterior variance divided by prior variance.
        variance: f64,
    },
    /// Nothing moved along a direction.
    NeverMoved {
        /// The direction, (n).
        direction: Vec<f64>,
    },
    /// Models with and without rotation predict about equally well, and their policies differ.
    AmbiguousRotation {
        /// Their difference, as a share of the policy's variance.
        difference: f64,
    },
    /// Blocks of time were left out, so that R² is too good.
    BlocksOfTime,
}

impl Doubt {
    /// The doubt about a low held-out R²; `None` for others.
    pub(crate) fn about_prediction(r_squared: f64) -> Option<Doubt> {
        match r_squared {
            r2 if r2 < 0.5 => Some(Doubt::NotPredicted { r_squared }),
            r2 if r2 < 0.9 => Some(Doubt::PoorlyPredicted { r_squared }),
            _ => None,
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Doubt::AmbiguousReading => f.write_str(
                "two readings explain the demonstrations equally well: no constraint, or one common to all of them",
            ),
            Doubt::UnexplainedMovements => {
                f.write_str("neither reading predicts left-out movements: do not use this policy")
            }
            Doubt::TooFewDemonstrations => {
                f.write_str("too few demonstrations to tell whether constraints acted: record at least five")
            }
            Doubt::NotPredicted { r_squared } => {
                write!(f, "left-out movements are not predicted (R² {r_squared:.2}): do not use this policy")
            }
            Doubt::PoorlyPredicted { r_squared } => {
                write!(f, "left-out movements are predicted poorly (R² {r_squared:.2})")
            }
            Doubt::WrongNoise { factor } => {
                write!(f, "errors are {factor:.1} times those expected: the noise model is wrong")
            }
            Doubt::MostlyPrior { direction, variance } => write!(
                f,
                "the demonstrations hardly determine the policy along {} (posterior/prior variance {variance:.2}): it is mostly the prior there",
                Direction(direction)
            ),
            Doubt::NeverMoved { direction } => write!(f, "nothing ever moved along {}", Direction(direction)),
            Doubt::AmbiguousRotation { difference } => write!(
                f,
                "with and without rotation the slope policy differs by {:.0} %: across the paths it is a guess",
                100.0 * difference
            ),
            Doubt::BlocksOfTime => f.write_str(
                "one or two movements only: blocks of time were left out instead of movements, R² is too good",
            ),
        }
    }
}

struct Direction<'a>(&'a [f64]);

impl fmt::Display for Direction<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let entries: Vec<_> = self.0.iter().map(|entry| format!("{entry:.2}")).collect();
        write!(f, "({})", entries.join(", "))
    }
}
