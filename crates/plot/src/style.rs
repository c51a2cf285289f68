use std::sync::Arc;

use kuva::plot::{ColorMap, LineStyle, MarkerShape};

/// How a line is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// In one piece.
    Solid,
    /// In short pieces.
    Dashed,
    /// In dots.
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
pub struct Stroke {
    /// As in HTML.
    pub color: &'static str,
    /// Pixels.
    pub width: f64,
    /// In how many pieces.
    pub dash: Dash,
}

/// The shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A disc.
    Circle,
    /// A square with level sides.
    Square,
    /// A triangle that points upwards.
    Up,
    /// A triangle that points downwards.
    Down,
    /// Two lines across each other.
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
pub(crate) fn heights() -> ColorMap {
    ColorMap::Custom(Arc::new(|height| {
        let (r, g, b) = ColorMap::Cividis.map_rgb(height).unwrap_or_default();
        let [r, g, b] = [r, g, b].map(|channel| 255 - (255 - channel) / 5 * 3);
        format!("#{r:02x}{g:02x}{b:02x}")
    }))
}
