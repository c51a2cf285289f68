//! The moving agents, each with the same colour and line in every picture.

use experiments::Method;
use plot::{Dash, Stroke};

/// An agent that moves. Each has the same colour and line in every picture, distinguishable in grey and for
/// colour-blind people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Who {
    /// The true policy.
    Expert,
    /// Direct policy learning.
    Naive,
    /// A policy learnt from aligned potentials.
    PolicyAlign,
    /// The same, with additional demonstrations that reach the goal from all sides.
    PolicyAlignAllAround,
    /// A Gaussian process on the potential, observed through slopes.
    SlopeGp,
    /// A Gaussian process on the velocities.
    DirectGp,
    /// Constrained movements of the training data.
    Demonstration,
}

/// The colour of a learner in every figure, in HTML notation; `None` if no figure shows it.
pub fn color_of(learner: Method) -> Option<&'static str> {
    let who = match learner {
        Method::Naive => Who::Naive,
        Method::PolicyAlign => Who::PolicyAlign,
        Method::SlopeGp => Who::SlopeGp,
        Method::DirectGp => Who::DirectGp,
        Method::ConstraintConsistent | Method::SlopeGpNoTrend | Method::SlopeGpPushed | Method::AutoGp => return None,
    };
    Some(who.color())
}

/// Grey, for the true policy where a learnt one is drawn over it.
pub(crate) const TRUTH: &str = "#b4b4b4";

impl Who {
    /// The colour, in HTML notation.
    pub(crate) const fn color(self) -> &'static str {
        match self {
            Who::Expert => "#1a1a1a",
            Who::Naive => "#009e73",
            Who::PolicyAlign => "#d55e00",
            Who::PolicyAlignAllAround => "#7a3200",
            Who::SlopeGp => "#cc79a7",
            Who::DirectGp => "#b39b00",
            Who::Demonstration => "#0072b2",
        }
    }

    /// The line's dashes.
    pub(crate) fn dash(self) -> Dash {
        match self {
            Who::Expert | Who::Demonstration | Who::SlopeGp => Dash::Solid,
            Who::Naive | Who::DirectGp => Dash::Dotted,
            Who::PolicyAlign | Who::PolicyAlignAllAround => Dash::Dashed,
        }
    }

    /// Its name in legends.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Who::Expert => "expert",
            Who::Naive => "naive",
            Who::PolicyAlign => "PolicyAlign",
            Who::PolicyAlignAllAround => "PolicyAlign, shown from all sides",
            Who::SlopeGp => "slope GP",
            Who::DirectGp => "direct GP",
            Who::Demonstration => "demonstration",
        }
    }

    /// A line of this width, in its colour and dashes.
    pub(crate) fn stroke(self, width: f64) -> Stroke {
        Stroke { color: self.color(), width, dash: self.dash() }
    }
}
