use nalgebra::{IsometryMatrix3, Point3, Vector3};

use crate::Stroke;

/// The appearance of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// Colour under full light, in HTML notation, `#rrggbb`.
    pub color: &'static str,
    /// From 0 to 1; transparent bodies are not shaded.
    pub opacity: f64,
}

impl Paint {
    /// A paint that hides everything behind it.
    pub fn opaque(color: &'static str) -> Self {
        Paint { color, opacity: 1.0 }
    }
}

/// An item of the scene. Lengths are in the units of the scene; widths and radii of strokes and dots are in pixels.
#[derive(Debug, Clone)]
pub enum Item {
    /// A line through points. A label adds it to the legend.
    Path {
        /// From start to end.
        points: Vec<Point3<f64>>,
        /// Its style.
        stroke: Stroke,
        /// Name in the legend.
        label: Option<String>,
    },
    /// A straight line with an arrowhead.
    Arrow {
        /// Its start.
        from: Point3<f64>,
        /// Its tip.
        to: Point3<f64>,
        /// Style of its shaft, which determines the size of the head.
        stroke: Stroke,
    },
    /// Dots.
    Dots {
        /// Their centres.
        points: Vec<Point3<f64>>,
        /// In HTML notation.
        color: &'static str,
        /// Radius in pixels.
        radius: f64,
    },
    /// A flat convex polygon.
    Plate {
        /// Corners in order.
        corners: Vec<Point3<f64>>,
        /// Its appearance.
        paint: Paint,
    },
    /// A ball.
    Ball {
        /// Its centre.
        centre: Point3<f64>,
        /// Its radius.
        radius: f64,
        /// Its appearance.
        paint: Paint,
    },
    /// A cylinder between two points with a hemisphere at each.
    Capsule {
        /// Centres of the hemispheres.
        ends: [Point3<f64>; 2],
        /// Radius of the hemispheres.
        radius: f64,
        /// Its appearance.
        paint: Paint,
    },
    /// A cylinder between two points.
    Cylinder {
        /// Centres of its end faces.
        ends: [Point3<f64>; 2],
        /// Radius of its end faces.
        radius: f64,
        /// Its appearance.
        paint: Paint,
    },
    /// A box centred at the origin of its pose.
    Block {
        /// From the box's axes to the scene's.
        pose: IsometryMatrix3<f64>,
        /// Full lengths along x, y, z.
        size: Vector3<f64>,
        /// Its appearance.
        paint: Paint,
    },
    /// A text shifted from a point, with a line to the point if it is far away. The text is centred if it is shifted
    /// neither to the right nor to the left.
    Note {
        /// The point.
        at: Point3<f64>,
        /// The text.
        text: String,
        /// Shift to the right and down, pixels.
        shift: (f64, f64),
        /// In HTML notation.
        color: &'static str,
    },
    /// A short text in a disc.
    Mark {
        /// The centre of the disc.
        at: Point3<f64>,
        /// The text.
        text: String,
        /// Colour of the disc, in HTML notation.
        color: &'static str,
    },
}

/// Font size, pixels.
pub(super) const WORDS: u32 = 12;
/// Radius of the disc of a mark, pixels.
pub(super) const DISC: f64 = 9.5;

impl Item {
    /// The paint of a body; `None` for other items.
    pub(super) fn paint(&self) -> Option<Paint> {
        match self {
            Item::Plate { paint, .. }
            | Item::Ball { paint, .. }
            | Item::Capsule { paint, .. }
            | Item::Cylinder { paint, .. }
            | Item::Block { paint, .. } => Some(*paint),
            Item::Path { .. } | Item::Arrow { .. } | Item::Dots { .. } | Item::Note { .. } | Item::Mark { .. } => None,
        }
    }
}
