use std::sync::Arc;

use kuva::plot::{ColorMap, LineStyle, MarkerShape};

/// The dashes of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Continuous.
    Solid,
    /// Dashed.
    Dashed,
    /// Dotted.
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

/// The style of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// In HTML notation.
    pub color: &'static str,
    /// Width in pixels.
    pub width: f64,
    /// Its dashes.
    pub dash: Dash,
}

/// The shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A disc.
    Circle,
    /// A square with horizontal and vertical sides.
    Square,
    /// A triangle that points upwards.
    Up,
    /// A triangle that points downwards.
    Down,
    /// Two crossing lines.
    Cross,
    /// A star with five points.
    Star,
}

impl From<Mark> for MarkerShape {
    fn from(mark: Mark) -> Self {
        match mark {
            Mark::Circle => MarkerShape::Circle,
            Mark::Square => MarkerShape::Square,
            Mark::Up => MarkerShape::Triangle,
            Mark::Down => MarkerShape::TriangleDown,
            Mark::Cross => MarkerShape::Cross,
            Mark::Star => MarkerShape::Star,
        }
    }
}

/// Colours from the lowest height to the highest, evenly spaced.
const HEIGHTS: [[f64; 3]; 4] =
    [[92.0, 142.0, 214.0], [121.0, 196.0, 203.0], [190.0, 226.0, 162.0], [255.0, 240.0, 150.0]];

/// The colour of a height, 0 to 1: from blue through green to yellow, lighter with height. Black is legible on all of them.
pub(crate) fn height(height: f64) -> [u8; 3] {
    let along = height.clamp(0.0, 1.0) * (HEIGHTS.len() - 1) as f64;
    let below = (along as usize).min(HEIGHTS.len() - 2);
    let share = along - below as f64;
    std::array::from_fn(|i| (HEIGHTS[below][i] * (1.0 - share) + HEIGHTS[below + 1][i] * share).round() as u8)
}

/// [`height`] for the plotting crate.
pub(crate) fn heights() -> ColorMap {
    color_map(height)
}

/// The same, darker, because dots are small and on white.
pub(crate) fn heights_of_dots() -> ColorMap {
    color_map(|at| height(at).map(|part| (u16::from(part) * 7 / 10) as u8))
}

fn color_map(color: fn(f64) -> [u8; 3]) -> ColorMap {
    ColorMap::Custom(Arc::new(move |at| {
        let [r, g, b] = color(at);
        format!("#{r:02x}{g:02x}{b:02x}")
    }))
}
