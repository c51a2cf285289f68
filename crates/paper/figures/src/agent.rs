//! The moving agents, each with the same colour and line in every picture.

use experiments::Method;
use plot::{Dash, Stroke};

/// An agent that moves. Each has the same colour and line in every picture, distinguishable in grey and for
/// colour-blind people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Agent {
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
    let agent = match learner {
        Method::Naive => Agent::Naive,
        Method::PolicyAlign => Agent::PolicyAlign,
        Method::SlopeGp => Agent::SlopeGp,
        Method::DirectGp => Agent::DirectGp,
        Method::ConstraintConsistent | Method::SlopeGpNoTrend | Method::SlopeGpPushed | Method::AutoGp => return None,
    };
    Some(agent.color())
}

/// Grey, for the true policy where a learnt one is drawn over it.
pub(crate) const TRUTH: &str = "#b4b4b4";

impl Agent {
    /// The colour, in HTML notation.
    pub(crate) const fn color(self) -> &'static str {
        match self {
            Agent::Expert => "#1a1a1a",
            Agent::Naive => "#009e73",
            Agent::PolicyAlign => "#d55e00",
            Agent::PolicyAlignAllAround => "#7a3200",
            Agent::SlopeGp => "#cc79a7",
            Agent::DirectGp => "#b39b00",
            Agent::Demonstration => "#0072b2",
        }
    }

    /// The line's dashes.
    pub(crate) fn dash(self) -> Dash {
        match self {
            Agent::Expert | Agent::Demonstration | Agent::SlopeGp => Dash::Solid,
            Agent::Naive | Agent::DirectGp => Dash::Dotted,
            Agent::PolicyAlign | Agent::PolicyAlignAllAround => Dash::Dashed,
        }
    }

    /// Its name in legends.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Agent::Expert => "expert",
            Agent::Naive => "naive",
            Agent::PolicyAlign => "PolicyAlign",
            Agent::PolicyAlignAllAround => "PolicyAlign, shown from all sides",
            Agent::SlopeGp => "slope GP",
            Agent::DirectGp => "direct GP",
            Agent::Demonstration => "demonstration",
        }
    }

    /// A line of this width, in its colour and dashes.
    pub(crate) fn stroke(self, width: f64) -> Stroke {
        Stroke { color: self.color(), width, dash: self.dash() }
    }
}
