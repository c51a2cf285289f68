use kuva::plot::{LegendPosition, LinePlot};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::{Scene, render_multiple};

use super::{Panel, Stroke};

/// How values are spaced on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    Linear,
    Logarithmic,
}

/// A line through (x, y), with a band from lowest to highest around it.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pub(crate) label: String,
    /// (x, y, lowest, highest); on a logarithmic axis all positive.
    pub(crate) points: Vec<(f64, f64, f64, f64)>,
    pub(crate) stroke: Stroke,
}

/// Quantities against a quantity.
#[derive(Debug, Clone)]
pub(crate) struct Curves {
    pub(crate) title: String,
    pub(crate) x_label: &'static str,
    pub(crate) y_label: &'static str,
    pub(crate) y_axis: Axis,
    /// From and to.
    pub(crate) y: [f64; 2],
    pub(crate) lines: Vec<Curve>,
    /// Pixels.
    pub(crate) size: (f64, f64),
}

impl Panel for Curves {
    fn scene(&self) -> Scene {
        let plots: Vec<Plot> = self.lines.iter().map(plot).collect();
        let mut layout = Layout::auto_from_plots(&plots)
            .with_title(self.title.clone())
            .with_title_size(15)
            .with_x_label(self.x_label)
            .with_y_label(self.y_label)
            .with_y_axis_min(self.y[0])
            .with_y_axis_max(self.y[1])
            .with_legend_position(LegendPosition::OutsideBottomColumns)
            .with_width(self.size.0)
            .with_height(self.size.1);
        if self.y_axis == Axis::Logarithmic {
            layout = layout.with_log_y();
        }
        render_multiple(plots, layout)
    }
}

fn plot(curve: &Curve) -> Plot {
    let line = LinePlot::new()
        .with_data(curve.points.iter().map(|&(x, y, ..)| (x, y)))
        .with_band(curve.points.iter().map(|point| point.2), curve.points.iter().map(|point| point.3))
        .with_color(curve.stroke.color)
        .with_stroke_width(curve.stroke.width)
        .with_line_style(curve.stroke.dash.into());
    Plot::Line(line.with_legend(curve.label.clone()))
}
