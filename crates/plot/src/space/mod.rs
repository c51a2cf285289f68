//! 3-D scenes: bodies as pixels under lines and words, with exact hidden surfaces.
//!
//! - [`Camera`], `view`: the point of view, and the projection to pixels.
//! - [`Item`]: the contents. `solid`, `cast`: ray casting of bodies; `stroke`: lines and dots.
//! - [`Frame`], `legend`, `words`: axes with ticks, names of lines, text.

mod camera;
mod cast;
mod extents;
mod frame;
mod item;
mod legend;
mod shade;
mod solid;
mod stroke;
mod view;
mod words;

use kuva::render::render::{Primitive, Scene, TextAnchor};
use nalgebra::Point3;

pub use camera::Camera;
pub use frame::Frame;
pub use item::{Item, Paint};

use crate::drawing::elements;
use crate::drawing::raster::Raster;
use crate::{Panel, Sketch};
use view::{Area, Extent, View};

/// Margin at the edges, pixels.
const MARGIN: f64 = 10.0;
/// Height of the title, if there is one, pixels.
const TITLE: f64 = 28.0;

/// The same font as in the other panels.
const FONT: &str = "DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif";

/// A 3-D scene in orthographic projection.
#[derive(Debug, Clone)]
pub struct Space {
    /// Title above the panel.
    pub title: String,
    /// The viewing direction.
    pub camera: Camera,
    /// Items that hide each other.
    pub items: Vec<Item>,
    /// Items drawn on top: bodies, then lines and dots in this order.
    pub over: Vec<Item>,
    /// A box of axes behind the scene.
    pub frame: Option<Frame>,
    /// Lowest and highest corner of the region that is fitted to the panel, so that several panels have the same scale;
    /// by default all items are fitted.
    pub extent: Option<[Point3<f64>; 2]>,
    /// Size in pixels.
    pub size: (f64, f64),
}

impl Panel for Space {
    fn sketch(&self) -> Sketch {
        let mut sketch = Sketch::new(Scene::new(self.size.0, self.size.1));
        let scene = &mut sketch.scene;
        scene.font_family = Some(FONT.to_owned());
        let smooth = Some(r#"stroke-linecap="round" stroke-linejoin="round""#.to_owned());
        scene.add(Primitive::GroupStart { transform: None, title: None, extra_attrs: smooth });
        let view = self.view();
        if let Some(frame) = &self.frame {
            frame.draw(&view, scene);
        }
        self.draw_items(&view, &mut sketch);
        let scene = &mut sketch.scene;
        let names = legend::names(self.items.iter().chain(&self.over));
        legend::draw(&names, self.size, scene);
        scene.add(Primitive::GroupEnd);
        self.add_title(scene);
        sketch
    }
}

impl Space {
    /// The projection onto the panel.
    fn view(&self) -> View {
        let items = || self.items.iter().chain(&self.over);
        let mut extents: Vec<Extent> = match self.extent {
            Some(corners) => view::corners(corners).map(Extent::bare).to_vec(),
            None => items().flat_map(|item| item.extents(&self.camera)).collect(),
        };
        extents.extend(self.frame.iter().flat_map(Frame::extents));
        let top = MARGIN + if self.title.is_empty() { 0.0 } else { TITLE };
        let bottom = self.size.1 - MARGIN - legend::height(&legend::names(items()), self.size.0);
        let area = Area { x: [MARGIN, self.size.0 - MARGIN], y: [top, bottom] };
        View::fit(&self.camera, &extents, area)
    }

    /// Draws bodies, then items that they may hide, then items on top, then text.
    fn draw_items(&self, view: &View, sketch: &mut Sketch) {
        for (items, hidden_by) in [(&self.items, &self.items[..]), (&self.over, &[][..])] {
            let raster: Option<Raster> = cast::raster(&cast::bodies(items, view), self.size);
            sketch.add_raster(raster);
            let bodies = cast::bodies(hidden_by, view);
            for item in items {
                stroke::draw(item, &bodies, view, &mut sketch.scene);
            }
        }
        for item in self.items.iter().chain(&self.over) {
            words::draw(item, view, &mut sketch.scene);
        }
    }

    fn add_title(&self, scene: &mut Scene) {
        if !self.title.is_empty() {
            scene.add(elements::words((self.size.0 / 2.0, MARGIN + 14.0), &self.title, 15, TextAnchor::Middle));
        }
    }
}

#[cfg(test)]
mod tests;
