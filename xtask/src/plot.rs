//! Pictures in the plane. The only place that knows the plotting crate.

use kuva::backend::svg::SvgBackend;
use kuva::plot::{ContourPlot, LinePlot, MarkerShape, QuiverPlot, ScatterPlot};
use kuva::render::figure::Figure;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::Scene;

/// Who moves: one colour and line each in every picture, distinct in grey and for colour-blind people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Who {
    /// The true policy.
    Expert,
    /// Direct policy learning.
    Naive,
    /// Aligned potentials.
    PolicyAlign,
}

impl Who {
    /// The colour, as in HTML.
    pub(crate) fn color(self) -> &'static str {
        match self {
            Who::Expert => "#1a1a1a",
            Who::Naive => "#009e73",
            Who::PolicyAlign => "#d55e00",
        }
    }
}

/// A scalar field on a grid: `values[row][column]` at (`x[column]`, `y[row]`).
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) values: Vec<Vec<f64>>,
}

/// One thing drawn in a panel; later layers lie on top.
#[derive(Debug, Clone)]
pub(crate) enum Layer {
    /// Lines of equal value.
    Contours(Field),
    /// A movement.
    Path { points: Vec<(f64, f64)>, color: &'static str, width: f64 },
    /// Crosses.
    Crosses { points: Vec<(f64, f64)>, color: &'static str },
    /// Dots.
    Dots { points: Vec<(f64, f64)>, color: &'static str },
    /// Arrows (x, y, u, v), in data units, `scale` times as long as they are.
    Arrows { arrows: Vec<(f64, f64, f64, f64)>, color: &'static str, scale: f64, width: f64 },
}

/// One coordinate system.
#[derive(Debug, Clone)]
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) x_label: &'static str,
    pub(crate) y_label: &'static str,
    /// Both axes reach from −extent to extent.
    pub(crate) extent: f64,
    pub(crate) layers: Vec<Layer>,
}

/// A picture, ready to be written in either form.
pub(crate) struct Picture(Scene);

/// Width and height of a panel in pixels.
const PANEL: (f64, f64) = (400.0, 420.0);

impl Picture {
    /// Panels side by side.
    pub(crate) fn row(panels: &[Panel]) -> Picture {
        let figure = Figure::new(1, panels.len())
            .with_plots(panels.iter().map(|panel| panel.layers.iter().map(plot).collect()).collect())
            .with_layouts(panels.iter().map(layout).collect())
            .with_cell_size(PANEL.0, PANEL.1);
        Picture(figure.render())
    }

    /// As scalable vector graphics.
    pub(crate) fn svg(&self) -> String {
        SvgBackend::new().render_scene(&self.0)
    }
}

fn layout(panel: &Panel) -> Layout {
    let plots: Vec<Plot> = panel.layers.iter().map(plot).collect();
    Layout::auto_from_plots(&plots)
        .with_title(panel.title.clone())
        .with_title_size(15)
        .with_x_label(panel.x_label)
        .with_y_label(panel.y_label)
        .with_x_axis_min(-panel.extent)
        .with_x_axis_max(panel.extent)
        .with_y_axis_min(-panel.extent)
        .with_y_axis_max(panel.extent)
        .with_show_grid(false)
        .with_equal_aspect()
}

fn plot(layer: &Layer) -> Plot {
    match layer.clone() {
        Layer::Contours(Field { x, y, values }) => {
            let contours = ContourPlot::new().with_grid(values, x, y).with_n_levels(12);
            Plot::Contour(contours.with_line_color("#b8b8b8").with_line_width(0.8))
        }
        Layer::Path { points, color, width } => {
            Plot::Line(LinePlot::new().with_data(points).with_color(color).with_stroke_width(width))
        }
        Layer::Crosses { points, color } => Plot::Scatter(
            ScatterPlot::new().with_data(points).with_color(color).with_size(2.5).with_marker(MarkerShape::Cross),
        ),
        Layer::Dots { points, color } => {
            Plot::Scatter(ScatterPlot::new().with_data(points).with_color(color).with_size(2.5))
        }
        Layer::Arrows { arrows, color, scale, width } => {
            let quiver = QuiverPlot::new().with_arrows(arrows).with_color(color).with_scale(scale);
            Plot::Quiver(quiver.with_shaft_width(width).with_clip_to_plot_area())
        }
    }
}
