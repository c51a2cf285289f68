//! Who moves: one colour and line each in every picture.

use experiments::Method;
use plot::{Dash, Stroke};

/// Who moves: one colour and line each in every picture, distinct in grey and for colour-blind people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Who {
    /// The true policy.
    Expert,
    /// Direct policy learning.
    Naive,
    /// Aligned potentials.
    PolicyAlign,
    /// Aligned potentials, from demonstrations that come to the goal from all around too.
    PolicyAlignAllAround,
    /// A Gaussian process on the potential, seen through slopes.
    SlopeGp,
    /// A Gaussian process on the velocities.
    DirectGp,
    /// Constrained movements that are learnt from.
    Demonstration,
}

/// The colour of a learner in every figure, as in HTML; none where no figure shows it.
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

/// The true policy where something learnt lies over it: a grey.
pub(crate) const TRUTH: &str = "#b4b4b4";

impl Who {
    /// The colour, as in HTML.
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

    /// How its line is broken.
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

    /// A line as wide as this, in its colour and dashes.
    pub(crate) fn stroke(self, width: f64) -> Stroke {
        Stroke { color: self.color(), width, dash: self.dash() }
    }
}
