//! Who moves: one colour and line each in every picture.

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
    /// Constrained movements that are learnt from.
    Demonstration,
}

impl Who {
    /// The colour, as in HTML.
    pub(crate) fn color(self) -> &'static str {
        match self {
            Who::Expert => "#1a1a1a",
            Who::Naive => "#009e73",
            Who::PolicyAlign => "#d55e00",
            Who::PolicyAlignAllAround => "#7b3fb8",
            Who::SlopeGp => "#cc79a7",
            Who::Demonstration => "#0072b2",
        }
    }

    /// How its line is broken.
    pub(crate) fn dash(self) -> Dash {
        match self {
            Who::Expert | Who::Demonstration | Who::SlopeGp => Dash::Solid,
            Who::Naive => Dash::Dotted,
            Who::PolicyAlign | Who::PolicyAlignAllAround => Dash::Dashed,
        }
    }

    /// Its name in legends.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Who::Expert => "expert",
            Who::Naive => "naive",
            Who::PolicyAlign => "policy-align",
            Who::PolicyAlignAllAround => "policy-align, goal shown from all sides",
            Who::SlopeGp => "slope GP",
            Who::Demonstration => "demonstration",
        }
    }

    /// A line as wide as this, in its colour and dashes.
    pub(crate) fn stroke(self, width: f64) -> Stroke {
        Stroke { color: self.color(), width, dash: self.dash() }
    }
}
