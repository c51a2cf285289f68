use nalgebra::{Matrix3, Point3, Vector3};

use super::Camera;

/// Space around a point for a word or a dot, pixels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Room {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) up: f64,
    pub(super) down: f64,
}

/// A point that must be on the panel, with space around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub(super) at: Point3<f64>,
    pub(super) room: Room,
}

impl Extent {
    pub(super) fn bare(at: Point3<f64>) -> Self {
        Extent { at, room: Room::default() }
    }
}

/// A part of a panel, pixels, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
}

/// The projection from the scene to the panel. A point on the panel has three coordinates, in pixels: to the right,
/// down, and towards the viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// Rows: right, down, towards the viewer.
    axes: Matrix3<f64>,
    scale: f64,
    shift: Vector3<f64>,
}

/// Number of bisections in the search for the scale.
const HALVINGS: usize = 60;

impl View {
    /// The largest view that shows all extents, centred in an area.
    ///
    /// Words too long for the area are cut off; the scene is then as large as without them.
    pub(super) fn fit(camera: &Camera, extents: &[Extent], area: Area) -> Self {
        let view = Self::fit_all(camera, extents, area);
        if view.scale > 0.0 {
            return view;
        }
        let bare: Vec<_> = extents.iter().map(|extent| Extent::bare(extent.at)).collect();
        Self::fit_all(camera, &bare, area)
    }

    fn fit_all(camera: &Camera, extents: &[Extent], area: Area) -> Self {
        let mut axes = camera.axes();
        axes.row_mut(1).neg_mut();
        let spans = |scale| {
            let across = extents.iter().map(|r| ((axes.row(0) * r.at.coords)[0] * scale, r.room.left, r.room.right));
            let down = extents.iter().map(|r| ((axes.row(1) * r.at.coords)[0] * scale, r.room.up, r.room.down));
            [span(across), span(down)]
        };
        let sides = [area.x[1] - area.x[0], area.y[1] - area.y[0]];
        let fits = |scale: f64| spans(scale).iter().zip(sides).all(|([low, high], side)| high - low <= side);
        let size = extents.iter().map(|r| (r.at - extents[0].at).norm()).fold(0.0, f64::max);
        let [mut scale, mut above] = [0.0, 4.0 * (sides[0] + sides[1]) / size.max(1e-9)];
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(scale, above);
            if fits(middle) { scale = middle } else { above = middle }
        }
        let [across, down] = spans(scale);
        let shift = |area: [f64; 2], span: [f64; 2]| f64::midpoint(area[0], area[1]) - f64::midpoint(span[0], span[1]);
        View { axes, scale, shift: Vector3::new(shift(area.x, across), shift(area.y, down), 0.0) }
    }

    /// Position of a point of the scene on the panel.
    pub(super) fn place(&self, point: &Point3<f64>) -> Point3<f64> {
        Point3::from(self.direction(&point.coords) * self.scale + self.shift)
    }

    /// A direction of the scene on the panel, with the same length.
    pub(super) fn direction(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        self.axes * direction
    }

    /// Pixels of a length across the line of sight.
    pub(super) fn length(&self, length: f64) -> f64 {
        length * self.scale
    }
}

/// First and last pixel that items cover, given (position, space before, space after).
fn span(things: impl Iterator<Item = (f64, f64, f64)>) -> [f64; 2] {
    let widen =
        |[low, high]: [f64; 2], (at, before, after): (f64, f64, f64)| [low.min(at - before), high.max(at + after)];
    let [low, high] = things.fold([f64::INFINITY, f64::NEG_INFINITY], widen);
    if low <= high { [low, high] } else { [0.0, 0.0] }
}

/// The corners of a box from its lowest and highest; the bits of the index select the sides of x, y, z.
pub(super) fn corners([low, high]: [Point3<f64>; 2]) -> [Point3<f64>; 8] {
    std::array::from_fn(|corner| {
        Point3::from(Vector3::from_fn(|i, _| if corner >> i & 1 == 0 { low[i] } else { high[i] }))
    })
}
