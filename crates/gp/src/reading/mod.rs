//! Determines whether the demonstrations were constrained.

pub(crate) mod auto_gp;
pub(crate) mod numbers;
pub(crate) mod slope_and_direct;

use motion::LeastSeen;
use serde::{Deserialize, Serialize};

use crate::reading::numbers::{FreeRows, ReadingNumbers};
use crate::report::doubt::Doubt;
use crate::rows::kept::Grouping;

/// Whether hidden constraints acted on the demonstrations (R8).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hypothesis {
    /// No sign of constraints: the direct policy, or the slope GP's if movements descend a potential that it learns far better.
    Free,
    /// Constraints hid part of the policy and varied: the slope policy.
    Constrained,
    /// Two readings explain the same data: usually the direct policy.
    Ambiguous,
    /// Neither policy predicts, so none should be trusted.
    Unexplained,
    /// Too few demonstrations to decide: the direct policy.
    TooFew,
}

impl Hypothesis {
    /// The reason to doubt the policy that this reading is, if it is one.
    pub(crate) fn doubt(self) -> Option<Doubt> {
        match self {
            Hypothesis::Free | Hypothesis::Constrained => None,
            Hypothesis::Ambiguous => Some(Doubt::AmbiguousReading),
            Hypothesis::Unexplained => Some(Doubt::UnexplainedMovements),
            Hypothesis::TooFew => Some(Doubt::TooFewDemonstrations),
        }
    }
}

/// Difference up to which the two policies count as equal, whatever was observed.
const SAME: f64 = 0.01;
/// Difference up to which the policies count as equal if all directions were observed.
const CLOSE: f64 = 0.1;
/// Coverage from which all directions count as observed if the policies differ: across a constraint common to all movements, noise alone
/// produces up to this share.
const WELL_SEEN: f64 = 0.25;
/// Minimum number of demonstrations for the reading constrained.
const DEMONSTRATIONS: usize = 5;
/// Left-out error above which movements are unexplained.
const UNEXPLAINED: f64 = 0.5;
/// Smallest share of free rows. Fewer may be the ones that a constraint common to them deflected.
const LEAST_FREE: f64 = 0.5;
/// Largest share of deflections along the motion, in that of noise. Constraints deflect across the motion.
const ACROSS: f64 = 0.3;
/// Share of the slope policy's squared length that certainly counts as hidden.
const HIDDEN: f64 = 0.08;

impl ReadingNumbers {
    /// (R8), in its order.
    pub fn reading(&self) -> Hypothesis {
        match () {
            () if self.grouping == Grouping::BlocksOfTime => Hypothesis::TooFew,
            () if self.free.is_some() => Hypothesis::Constrained,
            () if self.gap <= SAME || self.shows_a_potential() => {
                if self.seen() {
                    Hypothesis::Free
                } else {
                    Hypothesis::Ambiguous
                }
            }
            () if self.trajectories >= DEMONSTRATIONS && self.direction_tells() => Hypothesis::Constrained,
            () if self.p_d > UNEXPLAINED => Hypothesis::Unexplained,
            () if (self.gap <= CLOSE || self.is_a_line()) && self.seen() => Hypothesis::Free,
            () => Hypothesis::Ambiguous,
        }
    }

    /// Whether there was motion in every direction, and more than noise produces if the policies differ.
    pub fn seen(&self) -> bool {
        let least = if self.gap > SAME { WELL_SEEN } else { LeastSeen::COVERED };
        self.least_seen.coverage() >= least
    }

    /// Whether the state has one dimension. Its only direction cannot hide another: a constraint stops the movement or has no
    /// effect, and neither hides a part of the policy.
    fn is_a_line(&self) -> bool {
        self.least_seen.direction.len() == 1
    }

    /// Whether the direction of a movement improves the prediction of its speed much. If the state alone predicts well, the
    /// threshold is higher: people's handwriting, which is free, gains up to λ = 0.7 there.
    pub fn direction_tells(&self) -> bool {
        let least_lambda = if self.p_d > UNEXPLAINED { 0.5 } else { 0.75 };
        let gains = self.q <= 0.4 && self.t >= self.least_t();
        !self.is_a_line() && (gains || (self.lambda >= least_lambda && self.t_lambda >= self.least_t()))
    }

    /// Whether the directions in which velocities of a stretch differ are informative even if those of samples are not. If only
    /// logarithms of errors are compared, five movements may agree on that by chance.
    pub(crate) fn stretches_tell(&self) -> bool {
        let many = self.trajectories >= DEMONSTRATIONS && self.t >= self.least_t();
        many && self.gap > SAME && self.direction_tells()
    }

    /// Two standard deviations of Student's t distribution; infinite for three trajectories.
    fn least_t(&self) -> f64 {
        let freedom = self.trajectories.saturating_sub(1) as f64;
        if freedom > 2.0 { 2.0 * (freedom / (freedom - 2.0)).sqrt() } else { f64::INFINITY }
    }

    /// Whether the slope policy has an unobserved part. In many dimensions, and for policies with kinks, a potential is learnt
    /// from far fewer movements than a velocity field, with or without constraints. Then the two policies differ little, and by
    /// less than the direct one's error.
    pub fn hides(&self) -> bool {
        self.gap > self.p_d || (self.hidden >= HIDDEN && self.gap > CLOSE)
    }

    /// Whether the returned policy is the slope GP's.
    pub fn takes_slope(&self, reading: Hypothesis) -> bool {
        match reading {
            Hypothesis::Constrained => self.free.is_none(),
            Hypothesis::Unexplained => self.a_s < self.a_d,
            Hypothesis::Free | Hypothesis::Ambiguous => self.shows_a_potential(),
            Hypothesis::TooFew => false,
        }
    }

    /// Whether constraints deflected the other rows from the direct GP of the free ones (R10): it predicts how fast they move along their
    /// directions, and left-out movements at least as well as the slope GP does.
    pub(crate) fn free_rows_explain_all(&self) -> bool {
        let many = self.trajectories >= DEMONSTRATIONS && self.grouping == Grouping::Trajectories;
        let across = ACROSS / self.least_seen.direction.len() as f64;
        let explains =
            |free: FreeRows| (LEAST_FREE..1.0).contains(&free.share) && free.misfit <= 1.0 && free.along <= across;
        many && self.free.is_some_and(explains) && self.a_d <= self.a_s
    }

    /// Whether movement is free and both policies are nearly equal, so that nothing can have pushed either.
    pub(crate) fn agree_on_free_movement(&self) -> bool {
        self.reading() == Hypothesis::Free && self.gap <= CLOSE
    }

    /// Whether nothing was hidden and the slope GP is nevertheless far better.
    pub(crate) fn shows_a_potential(&self) -> bool {
        self.gap > SAME && self.trajectories >= DEMONSTRATIONS && self.direction_tells() && !self.hides()
    }

    /// Expected error of the direct policy learnt from free rows.
    pub(crate) fn error_of_free_rows(&self) -> f64 {
        self.p_d.max(self.a_d)
    }
}
