use kuva::plot::Surface3DPlot;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::{Scene, render_multiple};

use super::style::heights;
use super::{Field, Panel};

/// A scalar field in perspective, x to the right and y away from the reader; light is high.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    pub(crate) title: String,
    pub(crate) x_label: &'static str,
    pub(crate) y_label: &'static str,
    pub(crate) z_label: &'static str,
    pub(crate) field: Field,
    /// Pixels.
    pub(crate) size: (f64, f64),
}

impl Panel for Surface {
    fn scene(&self) -> Scene {
        let Field { x, y, values } = &self.field;
        // The crate's axes are left-handed from this side: with x and y exchanged the picture is no mirror image.
        let columns = (0..x.len()).map(|column| values.iter().map(|row| row[column]).collect()).collect();
        let surface = Surface3DPlot::new(columns)
            .with_x_coords(y.clone())
            .with_y_coords(x.clone())
            .with_x_label(self.y_label)
            .with_y_label(self.x_label)
            .with_z_label(self.z_label)
            .with_z_colormap(heights())
            .with_wireframe_width(0.25);
        let plots = vec![Plot::Surface3D(surface)];
        let mut layout = Layout::auto_from_plots(&plots)
            .with_title(self.title.clone())
            .with_title_size(15)
            .with_width(self.size.0)
            .with_height(self.size.1);
        // Heights are at the axis.
        layout.show_colorbar = false;
        render_multiple(plots, layout)
    }
}
