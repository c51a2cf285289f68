//! Pictures: rows of panels, written as SVG and PNG. The only place that knows the plotting crate.
//!
//! - [`Plane`]: things in the plane, both axes alike.
//! - [`Curves`]: quantities against a quantity, linear or logarithmic, with bands; [`Key`] names them.
//! - [`Relief`]: a scalar field or dots in perspective.
//! - [`Space`]: things in space, the nearer ones before the others.
//!
//! [`Who`] and [`Stroke`] give every picture the same colours and lines.

mod colour_scale;
mod curves;
mod dashes;
mod decimals;
mod key;
mod plane;
mod relief;
mod samples;
mod sheet;
mod sign;
mod space;
mod style;

use kuva::backend::raster::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::render::{Primitive, Scene};

pub(crate) use curves::{Axis, Curve, Curves};
pub(crate) use key::{Entry, Key};
pub(crate) use plane::{Layer, Plane};
pub(crate) use relief::Relief;
pub(crate) use sign::{Filling, Sign};
pub(crate) use space::{Camera, Frame, Item, Paint, Space};
pub(crate) use style::{Dash, Mark, Stroke, Who};

/// A scalar field on a grid: `values[row][column]` at (`x[column]`, `y[row]`).
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Field {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) values: Vec<Vec<f64>>,
}

/// One part of a picture.
pub(crate) trait Panel {
    /// Draws it on a sheet of its own.
    fn scene(&self) -> Scene;
}

/// Pixels between panels.
const GAP: f64 = 10.0;

/// Dots of the PNG for each pixel of the SVG.
const PNG_SCALE: f32 = 2.0;

/// A picture, ready to be written in either form.
pub(crate) struct Picture(Scene);

impl Picture {
    /// Rows of panels, one below the other.
    pub(crate) fn rows(rows: &[&[&dyn Panel]]) -> Picture {
        let mut sheet = Scene::new(0.0, GAP);
        let mut number = 0;
        for row in rows {
            let (mut x, mut height) = (GAP, 0.0_f64);
            for panel in *row {
                let scene = panel.scene();
                let (width, panel_height) = (scene.width, scene.height);
                let corner = (x, sheet.height);
                place(&mut sheet, scene, corner, number);
                number += 1;
                x += width + GAP;
                height = height.max(panel_height);
            }
            sheet.width = sheet.width.max(x);
            sheet.height += height + GAP;
        }
        Picture(sheet)
    }

    /// As scalable vector graphics.
    pub(crate) fn svg(&self) -> String {
        decimals::shortened(&SvgBackend::new().render_scene(&self.0))
    }

    /// As pixels.
    pub(crate) fn png(&self) -> anyhow::Result<Vec<u8>> {
        let mut sheet = Scene::new(self.0.width, self.0.height);
        sheet.font_family.clone_from(&self.0.font_family);
        sheet.elements = self.0.elements.iter().flat_map(dashes::drawn).collect();
        RasterBackend::new().with_scale(PNG_SCALE).render_scene(&sheet).map_err(anyhow::Error::msg)
    }
}

/// Puts a panel's scene on the sheet. Clipping areas get names of their own: the crate counts them over all pictures of
/// the program, in whatever order they are drawn, and a picture stands beside others in one page.
fn place(sheet: &mut Scene, scene: Scene, (x, y): (f64, f64), number: usize) {
    let names: Vec<String> = scene.defs.iter().filter_map(|def| name(def)).map(str::to_owned).collect();
    let own = |name: &str| names.iter().position(|other| other == name).map(|at| format!("panel-{number}-clip-{at}"));
    sheet.font_family = scene.font_family.or(sheet.font_family.take());
    let renamed = |def: &String| name(def).and_then(|name| Some(def.replace(name, &own(name)?)));
    sheet.defs.extend(scene.defs.iter().map(|def| renamed(def).unwrap_or_else(|| def.clone())));
    sheet.add(Primitive::GroupStart { transform: Some(format!("translate({x},{y})")), title: None, extra_attrs: None });
    for mut element in scene.elements {
        if let Primitive::ClipStart { id, .. } = &mut element
            && let Some(own) = own(id)
        {
            *id = own;
        }
        sheet.add(element);
    }
    sheet.add(Primitive::GroupEnd);
}

/// The name that a definition gives.
fn name(definition: &str) -> Option<&str> {
    definition.split_once("id=\"")?.1.split_once('"').map(|(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_the_same_whatever_was_drawn_before() {
        let plane = || Plane {
            title: String::new(),
            x_label: "x",
            y_label: "y",
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
}
