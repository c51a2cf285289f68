use kuva::render::color::Color;
use nalgebra::{Point2, Point3};

use super::front::{Front, Half};
use super::outline::{common, edges, hull, inside};

/// An area in one colour.
#[derive(Debug, Clone)]
pub(super) struct Fill {
    /// Convex, turning as hulls do.
    pub(super) outline: Vec<Point2<f64>>,
    pub(super) color: Color,
}

/// A convex body on the panel, before it is drawn.
#[derive(Debug, Clone)]
pub(super) struct Body {
    /// Lines on its surface, dense enough that their hull is its outline, also where it is cut.
    pub(super) wires: Vec<[Point3<f64>; 2]>,
    pub(super) front: Front,
    /// From the lowest to the topmost.
    pub(super) fills: Vec<Fill>,
    /// Edges within the outline.
    pub(super) creases: Vec<[Point2<f64>; 2]>,
    pub(super) opacity: f64,
    /// Colour of outline and creases.
    pub(super) ink: Color,
    /// Plates that it was cut at.
    pub(super) cuts: Vec<Slab>,
}

/// A flat convex area that cuts what passes through it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slab {
    corners: Vec<Point3<f64>>,
    /// What is behind it, from the viewer.
    pub(super) behind: Half,
}

/// Bodies that reach through a plate by less than this, pixels, are not cut.
const SLIVER: f64 = 0.5;
/// What is nearer to a plane than this, pixels, is on it.
const ON: f64 = 1e-6;

impl Slab {
    /// From its corners in order; none of three corners in a line.
    pub(super) fn new(corners: Vec<Point3<f64>>) -> Option<Self> {
        let [a, b, c, ..] = corners[..] else { return None };
        let normal = (b - a).cross(&(c - b)).try_normalize(1e-12)?;
        let normal = if normal.z < 0.0 { -normal } else { normal };
        Some(Slab { behind: Half::behind(&a, normal), corners })
    }

    /// Where a line passes through.
    pub(super) fn crossing(&self, wire: &[Point3<f64>; 2]) -> Option<Point3<f64>> {
        self.on_plane(wire).filter(|point| self.holds(point))
    }

    /// Where a line passes through the plane.
    fn on_plane(&self, [a, b]: &[Point3<f64>; 2]) -> Option<Point3<f64>> {
        let (at_a, at_b) = (self.behind.outside(a), self.behind.outside(b));
        (at_a * at_b < 0.0).then(|| a + (b - a) * (at_a / (at_a - at_b)))
    }

    /// Whether a point of its plane is within its corners.
    fn holds(&self, point: &Point3<f64>) -> bool {
        let side = |[a, b]: [Point3<f64>; 2]| (b - a).cross(&(point - a)).dot(&self.behind.normal);
        let (mut left, mut right) = (true, true);
        for edge in edges(&self.corners) {
            let side = side(edge);
            (left, right) = (left && side >= -ON, right && side <= ON);
        }
        left || right
    }
}

impl Body {
    /// What is seen of it, flat.
    pub(super) fn outline(&self) -> Vec<Point3<f64>> {
        hull(self.wires.iter().flatten().copied().collect())
    }

    /// Its parts behind and before a plate, where it passes through.
    pub(super) fn cut(&self, slab: &Slab) -> Option<[Body; 2]> {
        let outside = self.wires.iter().flatten().map(|point| slab.behind.outside(point));
        let [low, high] = outside.fold([0.0_f64; 2], |[low, high], out| [low.min(out), high.max(out)]);
        let apart = low > -SLIVER || high < SLIVER;
        if apart || !self.wires.iter().any(|wire| slab.crossing(wire).is_some()) {
            return None;
        }
        Some([slab.behind, slab.behind.reversed()].map(|half| self.within(half, slab)))
    }

    fn within(&self, half: Half, slab: &Slab) -> Body {
        let mut part = self.clone();
        part.wires = self.wires.iter().filter_map(|wire| kept(*wire, &half, slab)).collect();
        part.front.halves.push(half);
        part.cuts.push(slab.clone());
        let outline: Vec<_> = part.outline().iter().map(Point3::xy).collect();
        for fill in &mut part.fills {
            fill.outline = common(&fill.outline, &outline);
        }
        part.creases = self.creases.iter().filter_map(|crease| inside(*crease, &outline)).collect();
        part
    }

    /// The lines of the outline that are drawn: all but the edges of cuts beside the plate that made them.
    pub(super) fn rim(&self) -> Vec<[Point2<f64>; 2]> {
        let unseen = |[a, b]: [Point3<f64>; 2]| {
            let on = |slab: &Slab| slab.behind.outside(&a).abs() < ON && slab.behind.outside(&b).abs() < ON;
            self.cuts.iter().any(|slab| on(slab) && !slab.holds(&nalgebra::center(&a, &b)))
        };
        let outline = self.outline();
        edges(&outline).filter(|&edge| !unseen(edge)).map(|[a, b]| [a.xy(), b.xy()]).collect()
    }
}

/// The part of a line that is in a half.
fn kept([a, b]: [Point3<f64>; 2], half: &Half, slab: &Slab) -> Option<[Point3<f64>; 2]> {
    match (half.outside(&a) <= 0.0, half.outside(&b) <= 0.0) {
        (true, true) => Some([a, b]),
        (false, false) => None,
        (true, false) => Some([a, slab.on_plane(&[a, b]).unwrap_or(a)]),
        (false, true) => Some([slab.on_plane(&[a, b]).unwrap_or(b), b]),
    }
}
