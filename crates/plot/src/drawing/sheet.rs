use kuva::render::layout::Layout;
use kuva::render::plots::Plot;

/// A layout of this title and size, pixels.
pub(crate) fn titled(plots: &[Plot], title: &str, (width, height): (f64, f64)) -> Layout {
    Layout::auto_from_plots(plots).with_title(title).with_title_size(15).with_width(width).with_height(height)
}

/// A quantity along an edge of a panel.
pub(crate) struct Edge<'a> {
    pub(crate) label: &'a str,
    /// From and to.
    pub(crate) range: [f64; 2],
}

/// The layout with both axes named and bounded.
pub(crate) fn with_axes(layout: Layout, x: &Edge<'_>, y: &Edge<'_>) -> Layout {
    layout
        .with_label_size(12)
        .with_x_label(x.label)
        .with_y_label(y.label)
        .with_x_axis_min(x.range[0])
        .with_x_axis_max(x.range[1])
        .with_y_axis_min(y.range[0])
        .with_y_axis_max(y.range[1])
}
