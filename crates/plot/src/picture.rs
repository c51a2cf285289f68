use kuva::backend::raster::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::render::{Primitive, Scene};

use crate::drawing::raster::{DOTS, Raster, with_density};
use crate::drawing::style_sheet::with_style_sheet;
use crate::drawing::{dashes, turned};
use crate::{Panel, PlotError, Sketch, decimals};

/// Distance between panels, pixels.
const GAP: f64 = 10.0;

/// A picture that can be written in either format. The same panels give the same bytes.
#[derive(Debug)]
pub struct Picture(Sketch);

impl Picture {
    /// Rows of panels, one below the other.
    pub fn rows(rows: &[&[&dyn Panel]]) -> Picture {
        let mut sheet = Sketch::new(Scene::new(0.0, GAP));
        let mut number = 0;
        for row in rows {
            let (mut x, mut height) = (GAP, 0.0_f64);
            for panel in *row {
                let sketch = panel.sketch();
                let (width, panel_height) = (sketch.scene.width, sketch.scene.height);
                let corner = (x, sheet.scene.height);
                place(&mut sheet, sketch, corner, number);
                number += 1;
                x += width + GAP;
                height = height.max(panel_height);
            }
            sheet.scene.width = sheet.scene.width.max(x);
            sheet.scene.height += height + GAP;
        }
        Picture(sheet)
    }

    /// The picture as SVG; bodies in space and fields in colours are embedded pixels. The background is white, or dark if
    /// the reader prefers that.
    pub fn svg(&self) -> String {
        let mut svg = with_style_sheet(&decimals::shortened(&SvgBackend::new().render_scene(&self.0.scene)));
        for (number, raster) in self.0.rasters.iter().enumerate() {
            let group = format!("<g {}>", Sketch::mark(number));
            svg = svg.replacen(&group, &format!("<g>{}", raster.svg()), 1);
        }
        svg
    }

    /// The picture as a PNG file, with two dots per pixel of the SVG, at 96 pixels per inch.
    ///
    /// # Errors
    ///
    /// [`PlotError::Pixels`], if it is too large for the plotting crate.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        let Sketch { scene, rasters } = &self.0;
        let mut sheet = Scene::new(scene.width, scene.height);
        sheet.font_family.clone_from(&scene.font_family);
        let font = scene.font_family.as_ref();
        let elements = scene.elements.iter().flat_map(|element| dotted(element, rasters));
        sheet.elements = elements.flat_map(|element| turned::drawn(element, font)).collect();
        let backend = RasterBackend::new().with_scale(DOTS as f32);
        let file = backend.render_scene(&sheet).map_err(|reason| PlotError::Pixels { reason })?;
        Ok(with_density(file))
    }
}

/// An element, prepared for pixels.
fn dotted(element: &Primitive, rasters: &[Raster]) -> Vec<Primitive> {
    match (Sketch::number(element), element) {
        (Some(number), _) => std::iter::once(element.clone()).chain(rasters[number].areas()).collect(),
        _ => dashes::drawn(element),
    }
}

/// Puts a panel on the sheet. Clipping areas get new ids: the crate numbers them over all pictures of the program, in
/// drawing order, and one page may contain several pictures.
fn place(sheet: &mut Sketch, Sketch { scene, rasters }: Sketch, (x, y): (f64, f64), number: usize) {
    let names: Vec<String> = scene.defs.iter().filter_map(|def| name(def)).map(str::to_owned).collect();
    let own = |name: &str| names.iter().position(|other| other == name).map(|at| format!("panel-{number}-clip-{at}"));
    sheet.scene.font_family = scene.font_family.or(sheet.scene.font_family.take());
    let renamed = |def: &String| name(def).and_then(|name| Some(def.replace(name, &own(name)?)));
    sheet.scene.defs.extend(scene.defs.iter().map(|def| renamed(def).unwrap_or_else(|| def.clone())));
    let corner = Some(format!("translate({x},{y})"));
    sheet.scene.add(Primitive::GroupStart { transform: corner, title: None, extra_attrs: None });
    for mut element in scene.elements {
        if let Some(within) = Sketch::number(&element) {
            element = Sketch::group(sheet.rasters.len() + within);
        }
        if let Primitive::ClipStart { id, .. } = &mut element
            && let Some(own) = own(id)
        {
            *id = own;
        }
        sheet.scene.add(element);
    }
    sheet.rasters.extend(rasters);
    sheet.scene.add(Primitive::GroupEnd);
}

/// The id of a definition.
fn name(definition: &str) -> Option<&str> {
    definition.split_once("id=\"")?.1.split_once('"').map(|(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Layer, Plane};

    #[test]
    fn a_picture_is_the_same_whatever_was_drawn_before() {
        let plane = || Plane {
            title: String::new(),
            x_label: "x".to_owned(),
            y_label: "y".to_owned(),
            x: [0.0, 1.0],
            y: [0.0, 1.0],
            layers: vec![Layer::Arrows {
                arrows: vec![(0.2, 0.2, 0.5, 0.5)],
                color: "#000000",
                scale: 1.0,
                width: 1.0,
                label: None,
            }],
            size: Plane::SQUARE,
        };
        let [first, second] = [0, 1].map(|_| Picture::rows(&[&[&plane(), &plane()]]).svg());
        assert_eq!(first, second);
        for clip in ["panel-0-clip-0", "panel-1-clip-0"] {
            assert_eq!(first.matches(&format!("id=\"{clip}\"")).count(), 1);
            assert!(first.contains(&format!("url(#{clip})")));
        }
        assert!(!first.contains("kuva-"), "{first}");
    }

    #[cfg(feature = "space")]
    #[test]
    fn pixels_are_placed_in_their_panel() {
        use crate::{Camera, Item, Paint, Space};
        use nalgebra::Point3;

        let ball = |color| Space {
            title: String::new(),
            camera: Camera::ABOVE,
            items: vec![Item::Ball { centre: Point3::origin(), radius: 1.0, paint: Paint::opaque(color) }],
            over: vec![],
            frame: None,
            extent: None,
            size: (40.0, 30.0),
        };
        let svg = Picture::rows(&[&[&ball("#ff0000"), &ball("#0000ff")]]).svg();
        let images: Vec<&str> = svg.split("<image").skip(1).collect();
        assert_eq!(images.len(), 2);
        let at = [svg.find("translate(10,10)"), svg.find("<image"), svg.find("translate(60,10)"), svg.rfind("<image")];
        assert!(at.is_sorted() && at.iter().all(Option::is_some), "{at:?}");
        assert!(images[0] != images[1] && !svg.contains("data-raster"));
        let png = Picture::rows(&[&[&ball("#ff0000"), &ball("#0000ff")]]).png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        let density = reader.info().pixel_dims.unwrap();
        assert_eq!((density.xppu, density.yppu, density.unit), (7559, 7559, png::Unit::Meter));
        let mut dots = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut dots).unwrap();
        let dot = |x: usize, y: usize| dots[4 * (y * frame.width as usize + x)..][..3].to_vec();
        let [red, blue] = [dot(2 * 30, 2 * 25), dot(2 * 80, 2 * 25)];
        assert!(red[0] > 150 && red[1..] == [0, 0] && blue[2] > 150 && blue[..2] == [0, 0], "{red:?} {blue:?}");
    }
}
