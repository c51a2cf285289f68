//! Intersections of lines of sight with bodies, in closed form. Coordinates are on the panel, in pixels: right, down,
//! and towards the viewer. A line of sight is therefore a position (right, down), and close points have a large third
//! coordinate.

use nalgebra::{Matrix3, Point2, Point3, Vector2, Vector3};

use super::item::Item;
use super::view::{View, corners};

/// A convex body.
#[derive(Debug, Clone)]
pub(super) enum Solid {
    /// Flat, with corners in order, and the normal of the visible side.
    Plate {
        corners: Vec<Point3<f64>>,
        normal: Vector3<f64>,
    },
    /// All points closer than the radius to a line segment; a ball if its ends coincide.
    Capsule {
        ends: [Point3<f64>; 2],
        radius: f64,
    },
    Cylinder {
        ends: [Point3<f64>; 2],
        radius: f64,
    },
    /// Axes are unit columns.
    Block {
        centre: Point3<f64>,
        axes: Matrix3<f64>,
        half: Vector3<f64>,
    },
}

/// The first intersection of a line of sight with a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hit {
    /// Its depth; larger is closer.
    pub(super) depth: f64,
    /// Outward unit normal.
    pub(super) normal: Vector3<f64>,
}

/// The interval of a line of sight within a shape, from its entry to its exit.
#[derive(Debug, Clone, Copy)]
struct Span {
    enters: Hit,
    leaves: f64,
}

/// A surface steeper than this relative to the panel is seen edge on.
const EDGE_ON: f64 = 1e-6;

impl Solid {
    /// The body of an item; `None` for other items.
    pub(super) fn of(item: &Item, view: &View) -> Option<Solid> {
        Some(match item {
            Item::Plate { corners, .. } => {
                let corners: Vec<_> = corners.iter().map(|corner| view.place(corner)).collect();
                let [a, b, c, ..] = corners[..] else { return None };
                let normal = (b - a).cross(&(c - b)).try_normalize(1e-12)?;
                let normal = if normal.z < 0.0 { -normal } else { normal };
                Solid::Plate { corners, normal }
            }
            Item::Ball { centre, radius, .. } => {
                Solid::Capsule { ends: [view.place(centre); 2], radius: view.length(*radius) }
            }
            Item::Capsule { ends, radius, .. } => {
                Solid::Capsule { ends: ends.map(|end| view.place(&end)), radius: view.length(*radius) }
            }
            Item::Cylinder { ends, radius, .. } => {
                Solid::Cylinder { ends: ends.map(|end| view.place(&end)), radius: view.length(*radius) }
            }
            Item::Block { pose, size, .. } => {
                let axis = |i: usize| view.direction(&pose.rotation.matrix().column(i).into_owned());
                let axes = Matrix3::from_columns(&[axis(0), axis(1), axis(2)]);
                let half = size.map(|side| view.length(side / 2.0));
                Solid::Block { centre: view.place(&pose.translation.vector.into()), axes, half }
            }
            _ => return None,
        })
    }

    /// The first intersection with the line of sight through a position of the panel.
    pub(super) fn hit(&self, at: &Point2<f64>) -> Option<Hit> {
        match self {
            Solid::Plate { corners, normal } => plate(at, corners, normal),
            Solid::Capsule { ends, radius } => {
                let balls = ends.map(|end| ball(at, &end, *radius));
                let nearer = |a: Option<Hit>, b: Option<Hit>| match (a, b) {
                    (Some(a), Some(b)) => Some(if a.depth < b.depth { b } else { a }),
                    (a, b) => a.or(b),
                };
                nearer(nearer(balls[0], balls[1]), cylinder(at, ends, *radius))
            }
            Solid::Cylinder { ends, radius } => cylinder(at, ends, *radius),
            Solid::Block { centre, axes, half } => {
                let side = |i: usize| slab(at, centre, &axes.column(i).into_owned(), half[i]);
                common([side(0)?, side(1)?, side(2)?])
            }
        }
    }

    /// Corners of its bounding rectangle on the panel.
    pub(super) fn bounds(&self) -> [Point2<f64>; 2] {
        let around = |points: &[Point3<f64>], radius: f64| {
            let radius = Vector2::repeat(radius);
            let first = [Point2::from([f64::INFINITY; 2]), Point2::from([f64::NEG_INFINITY; 2])];
            points
                .iter()
                .map(Point3::xy)
                .fold(first, |[low, high], point| [low.inf(&(point - radius)), high.sup(&(point + radius))])
        };
        match self {
            Solid::Plate { corners, .. } => around(corners, 0.0),
            Solid::Capsule { ends, radius } | Solid::Cylinder { ends, radius } => around(ends, *radius),
            Solid::Block { centre, axes, half } => {
                let half = Point3::from(*half);
                around(&corners([-half, half]).map(|corner| centre + axes * corner.coords), 0.0)
            }
        }
    }
}

fn ball(at: &Point2<f64>, centre: &Point3<f64>, radius: f64) -> Option<Hit> {
    let aside = at - centre.xy();
    let rise = (radius * radius - aside.norm_squared()).max(-1.0);
    (rise >= 0.0).then(|| {
        let normal = Vector3::new(aside.x, aside.y, rise.sqrt()) / radius;
        Hit { depth: centre.z + rise.sqrt(), normal }
    })
}

fn plate(at: &Point2<f64>, corners: &[Point3<f64>], normal: &Vector3<f64>) -> Option<Hit> {
    if normal.z < EDGE_ON {
        return None;
    }
    let (mut left, mut right) = (true, true);
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let side = (b.xy() - a.xy()).perp(&(at - a.xy()));
        (left, right) = (left && side >= 0.0, right && side <= 0.0);
    }
    let from = at - corners[0].xy();
    let depth = corners[0].z - (normal.x * from.x + normal.y * from.y) / normal.z;
    (left || right).then_some(Hit { depth, normal: *normal })
}

fn cylinder(at: &Point2<f64>, [from, to]: &[Point3<f64>; 2], radius: f64) -> Option<Hit> {
    let length = (to - from).norm();
    let axis = (to - from).try_normalize(1e-12)?;
    common([tube(at, from, &axis, radius)?, slab(at, &nalgebra::center(from, to), &axis, length / 2.0)?])
}

/// The interval within an infinite cylinder: |b + z a| = r, where a and b are the components across the axis.
fn tube(at: &Point2<f64>, from: &Point3<f64>, axis: &Vector3<f64>, radius: f64) -> Option<Span> {
    let start = Point3::new(at.x, at.y, 0.0) - from;
    let (a, b) = (Vector3::z() - axis * axis.z, start - axis * axis.dot(&start));
    let (square, middle) = (a.norm_squared(), a.dot(&b));
    let inside = radius * radius - b.norm_squared();
    if square < EDGE_ON * EDGE_ON {
        return (inside >= 0.0).then_some(Span::ENDLESS);
    }
    let root = middle * middle + square * inside;
    (root >= 0.0).then(|| {
        let [depth, leaves] = [root.sqrt(), -root.sqrt()].map(|root| (root - middle) / square);
        Span { enters: Hit { depth, normal: (b + a * depth) / radius }, leaves }
    })
}

/// The interval between two planes at this distance from their centre.
fn slab(at: &Point2<f64>, middle: &Point3<f64>, axis: &Vector3<f64>, half: f64) -> Option<Span> {
    let start = axis.dot(&(Point3::new(at.x, at.y, 0.0) - middle));
    if axis.z.abs() < EDGE_ON {
        return (start.abs() <= half).then_some(Span::ENDLESS);
    }
    let (centre, half_length) = (-start / axis.z, half / axis.z.abs());
    Some(Span {
        enters: Hit { depth: centre + half_length, normal: axis * axis.z.signum() },
        leaves: centre - half_length,
    })
}

/// The entry of a line of sight into the intersection of several shapes: its entry into the last of them.
fn common<const N: usize>(spans: [Span; N]) -> Option<Hit> {
    let last = spans.iter().map(|span| span.enters).min_by(|a, b| a.depth.total_cmp(&b.depth))?;
    spans.iter().all(|span| span.leaves <= last.depth).then_some(last)
}

impl Span {
    /// The interval of a line of sight that never leaves.
    const ENDLESS: Span =
        Span { enters: Hit { depth: f64::INFINITY, normal: Vector3::new(0.0, 0.0, 1.0) }, leaves: f64::NEG_INFINITY };
}
