use nalgebra::{IsometryMatrix3, Point3, Vector3};

use super::super::Stroke;
use super::view::{Reach, Room, corners};
use super::{Camera, legend, line};

/// How a body looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Paint {
    /// Where it is fully lit; as in HTML, `#rrggbb`.
    pub(crate) color: &'static str,
    /// From 0 to 1; what is not opaque is not shaded.
    pub(crate) opacity: f64,
}

impl Paint {
    pub(crate) fn opaque(color: &'static str) -> Self {
        Paint { color, opacity: 1.0 }
    }
}

/// One thing in space; lengths in the units of the scene, widths and radii of strokes and dots in pixels.
#[derive(Debug, Clone)]
pub(crate) enum Item {
    /// A line through points. A label puts it in the legend.
    Path {
        points: Vec<Point3<f64>>,
        stroke: Stroke,
        label: Option<&'static str>,
    },
    /// A straight line with a head at its end.
    Arrow {
        from: Point3<f64>,
        to: Point3<f64>,
        stroke: Stroke,
    },
    /// Dots with this radius.
    Dots {
        points: Vec<Point3<f64>>,
        color: &'static str,
        radius: f64,
    },
    /// A flat convex area: its corners in order.
    Plate {
        corners: Vec<Point3<f64>>,
        paint: Paint,
    },
    Ball {
        centre: Point3<f64>,
        radius: f64,
        paint: Paint,
    },
    /// A cylinder between two points with a half ball at each.
    Capsule {
        ends: [Point3<f64>; 2],
        radius: f64,
        paint: Paint,
    },
    /// A cylinder between two points.
    Cylinder {
        ends: [Point3<f64>; 2],
        radius: f64,
        paint: Paint,
    },
    /// A box about the origin of its pose: whole lengths along x, y, z.
    Block {
        pose: IsometryMatrix3<f64>,
        size: Vector3<f64>,
        paint: Paint,
    },
    /// A word, this many pixels right of and below a point, with a line to the point where it is far; its middle is
    /// there where it is neither to the right nor to the left.
    Note {
        at: Point3<f64>,
        text: String,
        shift: (f64, f64),
        color: &'static str,
    },
    /// A short word in a disc.
    Mark {
        at: Point3<f64>,
        text: String,
        color: &'static str,
    },
}

/// Size of words, pixels.
pub(super) const WORDS: u32 = 12;
/// Radius of the disc of a mark.
pub(super) const DISC: f64 = 9.5;

impl Item {
    /// What must be on the panel for all of it to be there.
    pub(super) fn reaches(&self, camera: &Camera) -> Vec<Reach> {
        let around = |radius| Room { left: radius, right: radius, up: radius, down: radius };
        let bare = |points: &[Point3<f64>]| points.iter().copied().map(Reach::bare).collect();
        match self {
            Item::Path { points, stroke, .. } => with_room(points, around(stroke.width / 2.0)),
            Item::Arrow { from, to, stroke } => with_room(&[*from, *to], around(line::head(stroke))),
            Item::Dots { points, radius, .. } => with_room(points, around(*radius)),
            Item::Plate { corners, .. } => bare(corners),
            Item::Ball { centre, radius, .. } => bare(&square(centre, *radius, camera)),
            Item::Capsule { ends, radius, .. } | Item::Cylinder { ends, radius, .. } => {
                ends.iter().flat_map(|end| square(end, *radius, camera)).map(Reach::bare).collect()
            }
            Item::Block { pose, size, .. } => {
                let half = Point3::from(size / 2.0);
                corners([-half, half]).map(|corner| Reach::bare(pose * corner)).to_vec()
            }
            Item::Note { at, text, shift, .. } => vec![Reach { at: *at, room: note_room(text, *shift) }],
            Item::Mark { at, .. } => with_room(&[*at], around(DISC + 1.0)),
        }
    }
}

fn with_room(points: &[Point3<f64>], room: Room) -> Vec<Reach> {
    points.iter().map(|&at| Reach { at, room }).collect()
}

/// Points right, left, above and below that hold a ball in between.
fn square(centre: &Point3<f64>, radius: f64, camera: &Camera) -> [Point3<f64>; 4] {
    let axes = camera.axes();
    let [right, up] = [0, 1].map(|row| axes.row(row).transpose() * radius);
    [centre + right, centre - right, centre + up, centre - up]
}

fn note_room(text: &str, (right, down): (f64, f64)) -> Room {
    let (width, height) = (legend::width(text, WORDS), f64::from(WORDS));
    let (left, right) = match right {
        0.0 => (width / 2.0, width / 2.0),
        _ if right < 0.0 => (width - right, 0.0),
        _ => (0.0, width + right),
    };
    Room { left, right, up: (height / 2.0 - down).max(0.0), down: (height / 2.0 + down).max(0.0) }
}
