use kuva::plot::{ContourPlot, LegendPosition, LinePlot, MarkerShape, QuiverPlot, ScatterPlot};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::{Scene, render_multiple};

use super::{Field, Panel, Stroke};

/// One thing drawn in the plane; later layers lie on top.
#[derive(Debug, Clone)]
pub(crate) enum Layer {
    /// Lines of equal value.
    Contours(Field),
    /// A line through points. A label puts it in the legend.
    Path { points: Vec<(f64, f64)>, stroke: Stroke, label: Option<&'static str> },
    /// Crosses.
    Crosses { points: Vec<(f64, f64)>, color: &'static str },
    /// Dots with this radius in pixels.
    Dots { points: Vec<(f64, f64)>, color: &'static str, radius: f64 },
    /// Arrows (x, y, u, v), in data units, `scale` times as long as they are. A label puts them in the legend.
    Arrows {
        arrows: Vec<(f64, f64, f64, f64)>,
        color: &'static str,
        scale: f64,
        width: f64,
        label: Option<&'static str>,
    },
}

/// Things in the plane, one unit as long on either axis.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    pub(crate) title: String,
    pub(crate) x_label: &'static str,
    pub(crate) y_label: &'static str,
    /// From and to.
    pub(crate) x: [f64; 2],
    pub(crate) y: [f64; 2],
    pub(crate) layers: Vec<Layer>,
    /// Pixels.
    pub(crate) size: (f64, f64),
}

impl Plane {
    /// Width and height in pixels that suit a square of the plane.
    pub(crate) const SQUARE: (f64, f64) = (400.0, 420.0);
}

impl Panel for Plane {
    fn scene(&self) -> Scene {
        let plots: Vec<Plot> = self.layers.iter().map(plot).collect();
        let layout = Layout::auto_from_plots(&plots)
            .with_title(self.title.clone())
            .with_title_size(15)
            .with_x_label(self.x_label)
            .with_y_label(self.y_label)
            .with_x_axis_min(self.x[0])
            .with_x_axis_max(self.x[1])
            .with_y_axis_min(self.y[0])
            .with_y_axis_max(self.y[1])
            .with_show_grid(false)
            .with_legend_position(LegendPosition::OutsideBottomColumns)
            .with_equal_aspect()
            .with_width(self.size.0)
            .with_height(self.size.1);
        render_multiple(plots, layout)
    }
}

fn plot(layer: &Layer) -> Plot {
    match layer.clone() {
        Layer::Contours(Field { x, y, values }) => {
            let contours = ContourPlot::new().with_grid(values, x, y).with_n_levels(12);
            Plot::Contour(contours.with_line_color("#b8b8b8").with_line_width(0.8))
        }
        Layer::Path { points, stroke, label } => {
            let line = LinePlot::new().with_data(points).with_color(stroke.color).with_stroke_width(stroke.width);
            let line = line.with_line_style(stroke.dash.into());
            Plot::Line(if let Some(label) = label { line.with_legend(label) } else { line })
        }
        Layer::Crosses { points, color } => Plot::Scatter(
            ScatterPlot::new().with_data(points).with_color(color).with_size(2.5).with_marker(MarkerShape::Cross),
        ),
        Layer::Dots { points, color, radius } => {
            Plot::Scatter(ScatterPlot::new().with_data(points).with_color(color).with_size(radius))
        }
        Layer::Arrows { arrows, color, scale, width, label } => {
            let quiver = QuiverPlot::new().with_arrows(arrows).with_color(color).with_scale(scale);
            let quiver = quiver.with_shaft_width(width).with_clip_to_plot_area();
            Plot::Quiver(if let Some(label) = label { quiver.with_legend(label) } else { quiver })
        }
    }
}
