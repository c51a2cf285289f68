use kuva::plot::{Scatter3DPlot, Surface3DPlot};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, render_multiple};

use crate::drawing::sheet::titled;
use crate::drawing::style::{heights, heights_of_dots};
use crate::{Field, Panel, Sketch};

/// Heights above the plane in perspective, with x to the right and y away from the viewer; lighter colours are higher.
#[derive(Debug, Clone)]
pub struct Relief {
    /// Title above the panel.
    pub title: String,
    /// Axis labels, with units.
    pub labels: [String; 3],
    /// Lowest and highest corner of the box; colours refer to its range of heights.
    pub extent: [(f64, f64, f64); 2],
    /// Heights on a grid; values that are not finite are left out.
    pub surface: Option<Field>,
    /// Points (x, y, z).
    pub dots: Vec<(f64, f64, f64)>,
    /// Size in pixels.
    pub size: (f64, f64),
}

/// Radius of dots, pixels.
const DOT: f64 = 2.0;

/// Font size along axes, pixels.
const WORDS: u32 = 12;

/// Margins beside and below the box, and above it, pixels.
const ROOM: (f64, f64) = (24.0, 18.0);
const TITLE: f64 = 36.0;

impl Panel for Relief {
    // The plotting crate's axes are left-handed from this side; exchanging x and y avoids a mirror image.
    fn sketch(&self) -> Sketch {
        let [x_label, y_label, z_label] = self.labels.each_ref().map(String::as_str);
        let points = |points: &[(f64, f64, f64)]| points.iter().map(|&(x, y, z)| (y, x, z)).collect::<Vec<_>>();
        // The plotting crate fits its box to the contents; corners of size zero fix its extent.
        let corners = Scatter3DPlot::new().with_data(points(&self.extent)).with_size(0.0);
        let corners = corners.with_x_label(y_label).with_y_label(x_label).with_z_label(z_label);
        let corners = corners.with_z_axis_right(false);
        let mut plots = vec![Plot::Scatter3D(corners)];
        if let Some(field) = &self.surface {
            let (x, y, values) = (field.x(), field.y(), field.values());
            let columns = (0..x.len()).map(|column| values.iter().map(|row| row[column]).collect()).collect();
            let surface = Surface3DPlot::new(columns).with_x_coords(y.to_vec()).with_y_coords(x.to_vec());
            plots.push(Plot::Surface3D(surface.with_z_colormap(heights()).with_wireframe_width(0.25)));
        }
        if !self.dots.is_empty() {
            let dots = Scatter3DPlot::new().with_data(points(&self.dots)).with_size(DOT);
            plots.push(Plot::Scatter3D(dots.with_z_colormap(heights_of_dots())));
        }
        let layout = titled(&plots, &self.title, self.size);
        let mut layout = layout.with_force_margins(ROOM.0, ROOM.0).with_force_margins_y(TITLE, ROOM.1);
        // The axis already shows the heights.
        layout.show_colorbar = false;
        let mut scene = render_multiple(plots, layout);
        scene.elements.iter_mut().for_each(upright);
        Sketch::new(scene)
    }
}

/// Text along axes as in `Space`: horizontal, and not bold.
fn upright(element: &mut Primitive) {
    if let Primitive::Text { size, rotate: rotate @ Some(_), bold, .. } = element {
        (*size, *rotate, *bold) = (WORDS, None, false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relief_is_right_handed_with_z_up() {
        let dots = vec![(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)];
        let extent = [(-1.0, -2.0, -1.0), (3.0, 2.0, 1.0)];
        let labels = ["x", "y", "z"].map(str::to_owned);
        let (title, surface, size) = (String::new(), None, (400.0, 400.0));
        let scene = Relief { title, labels, extent, surface, dots, size }.sketch().scene;
        // The farthest is drawn first, so points are identified by their positions.
        let circle = |element: &Primitive| match element {
            Primitive::Circle { cx, cy, r, .. } if *r > 0.0 => Some((*cx, -*cy)),
            _ => None,
        };
        let mut places: Vec<(f64, f64)> = scene.elements.iter().filter_map(circle).collect();
        places.sort_by(|a, b| a.1.total_cmp(&b.1));
        let [x, origin, y, z] = places[..] else { panic!("{places:?}") };
        let from_origin = |(right, up): (f64, f64)| (right - origin.0, up - origin.1);
        let (x, y, z) = (from_origin(x), from_origin(y), from_origin(z));
        assert!(x.0 > 1.0 && y.0 > 1.0 && z.0.abs() < 0.1 && z.1 > 1.0, "{x:?} {y:?} {z:?}");
        assert!(x.0 * y.1 - x.1 * y.0 > 1.0, "seen from above y is to the left of x: {x:?} {y:?}");
        let words = scene.elements.iter().filter(|element| matches!(element, Primitive::Text { .. }));
        assert!(words.clone().count() > 10);
        assert!(words.into_iter().all(|word| matches!(word, Primitive::Text { rotate: None, bold: false, .. })));
    }
}
