//! Things in space, drawn as lines and flat areas from the back to the front.
//!
//! - [`Camera`], `view`: from where, and how that becomes pixels.
//! - [`Item`], `solid`, `line`: what there is, as bodies and strokes.
//! - `body`, `front`, `order`: what hides what; bodies that pass through a plate are cut by it.
//! - [`Frame`], `legend`: axes with ticks, and names of lines.

mod body;
mod camera;
mod draw;
mod frame;
mod front;
mod item;
mod legend;
mod line;
mod order;
mod outline;
mod pieces;
mod shade;
mod solid;
mod view;

use kuva::render::render::{Primitive, Scene, TextAnchor};
use nalgebra::Point3;

pub(crate) use camera::Camera;
pub(crate) use frame::Frame;
pub(crate) use item::{Item, Paint};

use super::Panel;
use view::{Area, Reach, View};

/// Pixels kept free at the edges.
const MARGIN: f64 = 10.0;
/// Pixels for the title, where there is one.
const TITLE: f64 = 28.0;

/// As in the other panels.
const FONT: &str = "DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif";

/// A scene in space, seen from far away.
#[derive(Debug, Clone)]
pub(crate) struct Space {
    pub(crate) title: String,
    pub(crate) camera: Camera,
    /// What hides and is hidden.
    pub(crate) items: Vec<Item>,
    /// What is drawn over all that, in this order.
    pub(crate) over: Vec<Item>,
    /// A box of axes behind it all.
    pub(crate) frame: Option<Frame>,
    /// Lowest and highest corner of what is fitted to the panel, so that several have one scale; without it all items.
    pub(crate) extent: Option<[Point3<f64>; 2]>,
    /// Pixels.
    pub(crate) size: (f64, f64),
}

impl Panel for Space {
    fn scene(&self) -> Scene {
        let mut scene = Scene::new(self.size.0, self.size.1);
        scene.font_family = Some(FONT.to_owned());
        let smooth = Some(r#"stroke-linecap="round" stroke-linejoin="round""#.to_owned());
        scene.add(Primitive::GroupStart { transform: None, title: None, extra_attrs: smooth });
        let view = self.view();
        if let Some(frame) = &self.frame {
            frame.draw(&view, &mut scene);
        }
        draw::pieces(&order::sorted(pieces::pieces(&self.items, &view)), &mut scene);
        for item in &self.over {
            draw::pieces(&pieces::pieces(std::slice::from_ref(item), &view), &mut scene);
        }
        for item in self.items.iter().chain(&self.over) {
            draw::words(item, &view, &mut scene);
        }
        let names = legend::names(self.items.iter().chain(&self.over));
        legend::draw(&names, self.size, &mut scene);
        scene.add(Primitive::GroupEnd);
        self.add_title(&mut scene);
        scene
    }
}

impl Space {
    /// Where things come to lie on the panel.
    fn view(&self) -> View {
        let items = || self.items.iter().chain(&self.over);
        let mut reaches: Vec<Reach> = match self.extent {
            Some(corners) => view::corners(corners).map(Reach::bare).to_vec(),
            None => items().flat_map(|item| item.reaches(&self.camera)).collect(),
        };
        reaches.extend(self.frame.iter().flat_map(Frame::reaches));
        let top = MARGIN + if self.title.is_empty() { 0.0 } else { TITLE };
        let bottom = self.size.1 - MARGIN - legend::height(&legend::names(items()), self.size.0);
        let area = Area { x: [MARGIN, self.size.0 - MARGIN], y: [top, bottom] };
        View::fit(&self.camera, &reaches, area)
    }

    fn add_title(&self, scene: &mut Scene) {
        if !self.title.is_empty() {
            scene.add(Primitive::Text {
                x: self.size.0 / 2.0,
                y: MARGIN + 14.0,
                content: self.title.clone(),
                size: 15,
                anchor: TextAnchor::Middle,
                rotate: None,
                bold: false,
                color: None,
            });
        }
    }
}

#[cfg(test)]
mod tests;
