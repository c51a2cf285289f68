use nalgebra::{IsometryMatrix3, Point3, Vector3};

use crate::Stroke;

/// How a body looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// Where it is fully lit; as in HTML, `#rrggbb`.
    pub color: &'static str,
    /// From 0 to 1; what is not opaque is not shaded.
    pub opacity: f64,
}

impl Paint {
    /// Nothing behind it can be seen.
    pub fn opaque(color: &'static str) -> Self {
        Paint { color, opacity: 1.0 }
    }
}

/// One thing in space; lengths in the units of the scene, widths and radii of strokes and dots in pixels.
#[derive(Debug, Clone)]
pub enum Item {
    /// A line through points. A label puts it in the legend.
    Path {
        /// From its start to its end.
        points: Vec<Point3<f64>>,
        /// How it looks.
        stroke: Stroke,
        /// In the legend.
        label: Option<String>,
    },
    /// A straight line with a head at its end.
    Arrow {
        /// Its foot.
        from: Point3<f64>,
        /// Its tip.
        to: Point3<f64>,
        /// How its shaft looks; the head is as broad as suits it.
        stroke: Stroke,
    },
    /// Dots with this radius.
    Dots {
        /// Their middles.
        points: Vec<Point3<f64>>,
        /// As in HTML.
        color: &'static str,
        /// Pixels.
        radius: f64,
    },
    /// A flat convex area: its corners in order.
    Plate {
        /// In order.
        corners: Vec<Point3<f64>>,
        /// How it looks.
        paint: Paint,
    },
    /// All that is near to a point.
    Ball {
        /// The point.
        centre: Point3<f64>,
        /// How near.
        radius: f64,
        /// How it looks.
        paint: Paint,
    },
    /// A cylinder between two points with a half ball at each.
    Capsule {
        /// The middles of the half balls.
        ends: [Point3<f64>; 2],
        /// Of the half balls.
        radius: f64,
        /// How it looks.
        paint: Paint,
    },
    /// A cylinder between two points.
    Cylinder {
        /// The middles of its end faces.
        ends: [Point3<f64>; 2],
        /// Of its end faces.
        radius: f64,
        /// How it looks.
        paint: Paint,
    },
    /// A box about the origin of its pose: whole lengths along x, y, z.
    Block {
        /// From its own axes to the scene's.
        pose: IsometryMatrix3<f64>,
        /// Whole lengths.
        size: Vector3<f64>,
        /// How it looks.
        paint: Paint,
    },
    /// A word, this many pixels right of and below a point, with a line to the point where it is far; its middle is
    /// there where it is neither to the right nor to the left.
    Note {
        /// The point.
        at: Point3<f64>,
        /// The word.
        text: String,
        /// Pixels to the right and down.
        shift: (f64, f64),
        /// As in HTML.
        color: &'static str,
    },
    /// A short word in a disc.
    Mark {
        /// The middle of the disc.
        at: Point3<f64>,
        /// The word.
        text: String,
        /// Of the disc; as in HTML.
        color: &'static str,
    },
}

/// Size of words, pixels.
pub(super) const WORDS: u32 = 12;
/// Radius of the disc of a mark.
pub(super) const DISC: f64 = 9.5;

impl Item {
    /// How it looks, if it is a body.
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
