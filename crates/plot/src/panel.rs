use kuva::render::render::{Primitive, Scene};

use crate::drawing::raster::Raster;
use crate::drawing::style_sheet::BACKDROP;

/// One part of a picture.
pub trait Panel {
    /// Draws it on a separate sheet.
    fn sketch(&self) -> Sketch;
}

/// A drawn panel: lines, areas and words, with pixels behind some of them.
#[derive(Debug)]
pub struct Sketch {
    pub(crate) scene: Scene,
    pub(crate) rasters: Vec<Raster>,
}

/// The attribute of a group for pixels; their number follows.
const MARK: &str = "data-raster=\"";

impl Sketch {
    pub(crate) fn new(scene: Scene) -> Sketch {
        Sketch { scene, rasters: vec![] }
    }

    /// Adds pixels on top of everything drawn so far.
    #[cfg(feature = "space")]
    pub(crate) fn add_raster(&mut self, raster: Option<Raster>) {
        if let Some(raster) = raster {
            self.scene.add(Sketch::group(self.rasters.len()));
            self.scene.add(Primitive::GroupEnd);
            self.rasters.push(raster);
        }
    }

    /// The attribute of the group that contains these pixels.
    pub(crate) fn mark(number: usize) -> String {
        format!("{MARK}{number}\"")
    }

    /// The beginning of that group.
    pub(crate) fn group(number: usize) -> Primitive {
        Primitive::GroupStart { transform: None, title: None, extra_attrs: Some(Sketch::mark(number)) }
    }

    /// The beginning of a group behind lines and words.
    pub(crate) fn backdrop() -> Primitive {
        Primitive::GroupStart { transform: None, title: None, extra_attrs: Some(BACKDROP.to_owned()) }
    }

    /// The number of the pixels whose group begins here.
    pub(crate) fn number(element: &Primitive) -> Option<usize> {
        let Primitive::GroupStart { extra_attrs: Some(attribute), .. } = element else { return None };
        attribute.strip_prefix(MARK)?.strip_suffix('"')?.parse().ok()
    }
}
