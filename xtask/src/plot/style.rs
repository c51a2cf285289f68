use std::sync::Arc;

use kuva::plot::{ColorMap, LineStyle, MarkerShape};

/// Who moves: one colour and line each in every picture, distinct in grey and for colour-blind people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Who {
    /// The true policy.
    Expert,
    /// Direct policy learning.
    Naive,
    /// Aligned potentials.
    PolicyAlign,
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
            Who::Demonstration => "#0072b2",
        }
    }

    /// How its line is broken.
    pub(crate) fn dash(self) -> Dash {
        match self {
            Who::Expert | Who::Demonstration => Dash::Solid,
            Who::Naive => Dash::Dotted,
            Who::PolicyAlign => Dash::Dashed,
        }
    }

    /// Its name in legends.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Who::Expert => "expert",
            Who::Naive => "naive",
            Who::PolicyAlign => "policy-align",
            Who::Demonstration => "demonstration",
        }
    }

    /// A line as wide as this, in its colour and dashes.
    pub(crate) fn stroke(self, width: f64) -> Stroke {
        Stroke { color: self.color(), width, dash: self.dash() }
    }
}

/// How a line is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Dash {
    Solid,
    Dashed,
    Dotted,
}

impl From<Dash> for LineStyle {
    fn from(dash: Dash) -> Self {
        match dash {
            Dash::Solid => LineStyle::Solid,
            Dash::Dashed => LineStyle::Dashed,
            Dash::Dotted => LineStyle::Dotted,
        }
    }
}

/// How a line looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    /// As in HTML.
    pub(crate) color: &'static str,
    /// Pixels.
    pub(crate) width: f64,
    pub(crate) dash: Dash,
}

/// The shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    Circle,
    Square,
    /// A triangle that points upwards.
    Up,
    /// A triangle that points downwards.
    Down,
    Cross,
}

impl From<Mark> for MarkerShape {
    fn from(mark: Mark) -> Self {
        match mark {
            Mark::Circle => MarkerShape::Circle,
            Mark::Square => MarkerShape::Square,
            Mark::Up => MarkerShape::Triangle,
            Mark::Down => MarkerShape::TriangleDown,
            Mark::Cross => MarkerShape::Cross,
        }
    }
}

/// Colours of heights: from blue by grey to yellow, the higher the lighter, on all of which black can be seen.
pub(super) fn heights() -> ColorMap {
    ColorMap::Custom(Arc::new(|height| {
        let (r, g, b) = ColorMap::Cividis.map_rgb(height).unwrap_or_default();
        let [r, g, b] = [r, g, b].map(|channel| 255 - (255 - channel) / 5 * 3);
        format!("#{r:02x}{g:02x}{b:02x}")
    }))
}
