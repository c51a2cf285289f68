use kuva::plot::{ColorMap, Surface3DPlot};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::{Scene, render_multiple};

use super::{Field, Panel};

/// A scalar field in perspective; light is high.
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
        let surface = Surface3DPlot::new(self.field.values.clone())
            .with_x_coords(self.field.x.clone())
            .with_y_coords(self.field.y.clone())
            .with_z_colormap(ColorMap::Cividis)
            .with_x_label(self.x_label)
            .with_y_label(self.y_label)
            .with_z_label(self.z_label);
        let plots = vec![Plot::Surface3D(surface)];
        let layout = Layout::auto_from_plots(&plots)
            .with_title(self.title.clone())
            .with_title_size(15)
            .with_width(self.size.0)
            .with_height(self.size.1);
        render_multiple(plots, layout)
    }
}
