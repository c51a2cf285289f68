use std::sync::Arc;

use kuva::plot::{BandPlot, LinePlot};
use kuva::render::layout::TickFormat;
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;

use crate::sheet::{Edge, titled, with_axes};
use crate::{Panel, Sign, Sketch, Stroke};

/// How values are spaced on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Equal differences are equally long.
    Linear,
    /// Equal ratios are equally long.
    Logarithmic,
}

impl Axis {
    /// Lower and upper end of a band.
    fn band(self, mean: f64, sd: f64) -> [f64; 2] {
        let low = match self {
            Axis::Linear => mean - sd,
            Axis::Logarithmic => mean * mean / (mean + sd),
        };
        [low, mean + sd]
    }
}

/// Means and standard deviations of a quantity. [`crate::Key`] names it.
#[derive(Debug, Clone)]
pub struct Curve {
    /// (x, mean, standard deviation).
    pub points: Vec<(f64, f64, f64)>,
    /// Of the line through the means; the band has its colour.
    pub stroke: Stroke,
    /// At each point.
    pub sign: Sign,
}

/// Quantities against a quantity: lines through the means, in bands. On a linear axis a band reaches one standard
/// deviation up and down; on a logarithmic one it reaches that far up and, for the eye, as far down, and so never to 0.
#[derive(Debug, Clone)]
pub struct Curves {
    /// Above it.
    pub title: String,
    /// What is varied, with its unit.
    pub x_label: String,
    /// What is measured, with its unit.
    pub y_label: String,
    /// How y is spaced.
    pub y_axis: Axis,
    /// From and to.
    pub x: [f64; 2],
    /// From and to; on a logarithmic axis positive.
    pub y: [f64; 2],
    /// From tick to tick.
    pub x_step: f64,
    /// Later ones lie on top.
    pub lines: Vec<Curve>,
    /// Pixels.
    pub size: (f64, f64),
}

/// How much a band hides of what is behind it.
const BAND: f64 = 0.13;

impl Panel for Curves {
    fn sketch(&self) -> Sketch {
        let bands = self.lines.iter().map(|curve| self.band(curve));
        let lines = self.lines.iter().flat_map(|curve| std::iter::once(line(curve)).chain(marks(curve)));
        let plots: Vec<Plot> = bands.chain(lines).collect();
        let (x, y) = (Edge { label: &self.x_label, range: self.x }, Edge { label: &self.y_label, range: self.y });
        let layout = with_axes(titled(&plots, &self.title, self.size), &x, &y);
        let mut layout = layout.with_x_tick_step(self.x_step).with_grid_line_width(0.6);
        if self.y_axis == Axis::Logarithmic {
            let plainly = TickFormat::Custom(Arc::new(power));
            layout = layout.with_log_y().with_y_tick_format(plainly);
        }
        Sketch::new(render_multiple(plots, layout))
    }
}

/// A value of a logarithmic axis: plainly, or where that is long as a power of ten.
fn power(tick: f64) -> String {
    let exponent = tick.log10().round();
    if exponent.abs() <= 3.0 || (tick / 10_f64.powf(exponent) - 1.0).abs() > 1e-9 {
        return tick.to_string();
    }
    let raised = |letter: char| match letter {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
}

impl Curves {
    /// The band around a curve, as far as the axis goes.
    fn band(&self, curve: &Curve) -> Plot {
        let edge = |end: usize| {
            let at = move |&(_, mean, sd): &(f64, f64, f64)| self.y_axis.band(mean, sd)[end];
            curve.points.iter().map(at).map(|value| value.clamp(self.y[0], self.y[1]))
        };
        let band = BandPlot::new(curve.points.iter().map(|point| point.0), edge(0), edge(1));
        Plot::Band(band.with_color(curve.stroke.color).with_opacity(BAND))
    }
}

fn line(curve: &Curve) -> Plot {
    let line = LinePlot::new().with_data(curve.points.iter().map(|&(x, y, ..)| (x, y)));
    let line = line.with_color(curve.stroke.color).with_stroke_width(curve.stroke.width);
    Plot::Line(line.with_line_style(curve.stroke.dash.into()))
}

fn marks(curve: &Curve) -> Vec<Plot> {
    let points: Vec<_> = curve.points.iter().map(|&(x, mean, _)| (x, mean)).collect();
    curve.sign.plots(&points, curve.stroke.color)
}

#[cfg(test)]
mod tests {
    use kuva::render::render::Primitive;
    use proptest::prelude::*;

    use super::*;
    use crate::{Dash, Filling, Mark};

    proptest! {
        #[test]
        fn a_band_is_as_wide_on_either_side_and_never_reaches_0_on_a_logarithmic_axis(mean in 1e-6..1e6, share in 0.0..1e3) {
            let sd = mean * share;
            let [low, high] = Axis::Linear.band(mean, sd);
            prop_assert!(((mean - low) - (high - mean)).abs() <= 1e-12 * high);
            let [low, high] = Axis::Logarithmic.band(mean, sd);
            prop_assert!(low > 0.0 && high == mean + sd);
            prop_assert!((mean / low - high / mean).abs() <= 1e-9 * (high / mean));
        }
    }

    #[test]
    fn ticks_are_short() {
        let texts = [1e-10, 1e-4, 1e-3, 0.1, 1.0, 1000.0, 1e4, 0.00002].map(power);
        assert_eq!(texts, ["10⁻¹⁰", "10⁻⁴", "0.001", "0.1", "1", "1000", "10⁴", "0.00002"]);
    }

    #[test]
    fn every_point_has_its_mark_where_the_axis_has_its_value() {
        let points = vec![(0.0, 0.01, 0.05), (50.0, 0.1, 0.0), (100.0, 1.0, 20.0)];
        let stroke = Stroke { color: "#d55e00", width: 1.8, dash: Dash::Solid };
        let sign = Sign { mark: Mark::Circle, filling: Filling::Hollow };
        let (x, y, size) = ([0.0, 100.0], [1e-3, 10.0], (500.0, 400.0));
        let lines = vec![Curve { points, stroke, sign }];
        let (title, x_label, y_label) = (String::new(), "x".to_owned(), "y".to_owned());
        let y_axis = Axis::Logarithmic;
        let scene = Curves { title, x_label, y_label, y_axis, x, y, x_step: 20.0, lines, size }.sketch().scene;
        let circles = |element: &Primitive| match element {
            Primitive::CircleBatch { cx, cy, .. } => cx.iter().copied().zip(cy.iter().copied()).collect(),
            _ => vec![],
        };
        let circles: Vec<(f64, f64)> = scene.elements.iter().flat_map(circles).collect();
        assert_eq!(circles.len(), 6);
        assert_eq!(circles[..3], circles[3..]);
        // A decade each: equal steps to the right and up.
        let [a, b, c] = circles[..3] else { unreachable!() };
        assert!((b.0 - a.0 - (c.0 - b.0)).abs() < 0.05 && b.0 > a.0 + 100.0, "{circles:?}");
        assert!((b.1 - a.1 - (c.1 - b.1)).abs() < 0.05 && b.1 < a.1 - 50.0, "{circles:?}");
    }
}
