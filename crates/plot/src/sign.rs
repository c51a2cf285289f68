use std::fmt::Write as _;

use kuva::plot::ScatterPlot;
use kuva::render::color::Color;
use kuva::render::plots::Plot;
use kuva::render::render::{PathData, Primitive};

use crate::Mark;

/// The mark of a curve's points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sign {
    /// Its shape.
    pub mark: Mark,
    /// Its filling.
    pub filling: Filling,
}

/// The filling of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filling {
    /// Filled with the colour of its edge.
    Full,
    /// Filled with white.
    Hollow,
}

/// Half the width of a mark, pixels.
const SIZE: f64 = 4.0;
/// Share of a hollow mark that is empty.
const HOLLOW: f64 = 0.55;

impl Sign {
    /// Colours and sizes of the superimposed marks.
    fn layers(self, color: &str) -> Vec<(&str, f64)> {
        match self.filling {
            Filling::Full => vec![(color, SIZE)],
            Filling::Hollow => vec![(color, SIZE), ("#ffffff", HOLLOW * SIZE)],
        }
    }

    /// The marks at points of a plot.
    pub(crate) fn plots(self, points: &[(f64, f64)], color: &str) -> Vec<Plot> {
        let layer = |(color, size): (&str, f64)| {
            let marks = ScatterPlot::new().with_data(points.iter().copied()).with_color(color).with_size(size);
            Plot::Scatter(marks.with_marker(self.mark.into()))
        };
        self.layers(color).into_iter().map(layer).collect()
    }
}

/// A mark at a position of a scene, pixels; the same shape as the plotting crate draws at points of a plot.
pub(crate) fn shape(mark: Mark, (cx, cy): (f64, f64), color: &str, size: f64) -> Primitive {
    let corners: &[(f64, f64)] = match mark {
        Mark::Circle => {
            let fill = Color::from(color);
            return Primitive::Circle { cx, cy, r: size, fill, fill_opacity: None, stroke: None, stroke_width: None };
        }
        Mark::Square => &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)],
        Mark::Up => &[(0.0, -1.02), (-1.0, 0.68), (1.0, 0.68)],
        Mark::Down => &[(0.0, 1.02), (-1.0, -0.68), (1.0, -0.68)],
        Mark::Star => &[
            (0.0, -1.0),
            (0.235, -0.324),
            (0.951, -0.309),
            (0.380, 0.124),
            (0.588, 0.809),
            (0.0, 0.4),
            (-0.588, 0.809),
            (-0.380, 0.124),
            (-0.951, -0.309),
            (-0.235, -0.324),
        ],
        Mark::Cross => {
            &[(-0.9, -0.9), (0.0, 0.0), (0.9, -0.9), (0.0, 0.0), (0.9, 0.9), (0.0, 0.0), (-0.9, 0.9), (0.0, 0.0)]
        }
    };
    let mut d = String::new();
    for (i, (x, y)) in corners.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        let _ = write!(d, "{command}{:.1} {:.1}", cx + x * size, cy + y * size);
    }
    Primitive::Path(Box::new(PathData {
        d: d + "Z",
        fill: Some(Color::from(color)),
        stroke: Color::from(color),
        stroke_width: if mark == Mark::Cross { 1.5 } else { 0.5 },
        opacity: None,
        stroke_dasharray: None,
    }))
}
