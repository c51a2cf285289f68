//! The extents that must be on the panel for an item to be completely visible.

use nalgebra::Point3;

use super::item::{DISC, WORDS};
use super::view::{Extent, Room, corners};
use super::{Camera, Item, legend, stroke};

impl Item {
    /// The points, with margins, that must be on the panel for the whole item to be visible.
    pub(super) fn extents(&self, camera: &Camera) -> Vec<Extent> {
        let around = |radius| Room { left: radius, right: radius, up: radius, down: radius };
        let bare = |points: &[Point3<f64>]| points.iter().copied().map(Extent::bare).collect();
        match self {
            Item::Path { points, stroke, .. } => with_room(points, around(stroke.width / 2.0)),
            Item::Arrow { from, to, stroke } => with_room(&[*from, *to], around(stroke::head(stroke))),
            Item::Dots { points, radius, .. } => with_room(points, around(*radius)),
            Item::Plate { corners, .. } => bare(corners),
            Item::Ball { centre, radius, .. } => bare(&square(centre, *radius, camera)),
            Item::Capsule { ends, radius, .. } | Item::Cylinder { ends, radius, .. } => {
                ends.iter().flat_map(|end| square(end, *radius, camera)).map(Extent::bare).collect()
            }
            Item::Block { pose, size, .. } => {
                let half = Point3::from(size / 2.0);
                corners([-half, half]).map(|corner| Extent::bare(pose * corner)).to_vec()
            }
            Item::Note { at, text, shift, .. } => vec![Extent { at: *at, room: note_room(text, *shift) }],
            Item::Mark { at, .. } => with_room(&[*at], around(DISC + 1.0)),
        }
    }
}

fn with_room(points: &[Point3<f64>], room: Room) -> Vec<Extent> {
    points.iter().map(|&at| Extent { at, room }).collect()
}

/// Points to the right, left, above and below that enclose a ball.
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
