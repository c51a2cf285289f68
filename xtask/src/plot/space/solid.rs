//! Bodies of the items: wires, faces, shading.

use std::f64::consts::{PI, TAU};

use kuva::render::color::Color;
use nalgebra::{Point2, Point3, Rotation3, Unit, Vector3};

use super::Paint;
use super::body::{Body, Fill, Slab};
use super::front::{Front, Half, Round};
use super::outline::{edges, hull};
use super::shade::{ink, light, lit, shade};
use super::view::corners;

/// Lines along a round body.
const RIBS: usize = 36;
/// Great circles of a ball.
const MERIDIANS: usize = 12;
/// Steps of shading on a round body: how far each is drawn together, and how much light it gets.
const STEPS: [(f64, f64); 6] = [(0.0, 0.25), (0.13, 0.42), (0.27, 0.58), (0.42, 0.73), (0.58, 0.87), (0.75, 1.0)];

/// All points nearer than `radius` to the line between two points; all in pixels.
pub(super) fn capsule(ends: [Point3<f64>; 2], radius: f64, paint: &Paint) -> Body {
    let mut wires: Vec<_> = ends.iter().flat_map(|end| ball(end, radius)).collect();
    let axis = ends[1] - ends[0];
    if let Some(axis) = Unit::try_new(axis, 1e-9) {
        let [near, far] = ends.map(|end| ring(&end, &axis, radius));
        wires.extend(near.into_iter().zip(far).map(|(a, b)| [a, b]));
    }
    // Light falls on a long body across its axis.
    let across = Unit::try_new(axis, 1e-9).map_or(light(), |axis| light() - *axis * axis.dot(&light()));
    let fill = |&(step, lit): &(f64, f64)| {
        let shift = across * (radius * step);
        let discs = ends.iter().flat_map(|end| disc(&(end + shift), radius * (1.0 - step)));
        Fill { outline: flat(&hull(discs.collect())), color: shade(paint.color, lit) }
    };
    let fills = if paint.opacity < 1.0 { vec![fill(&(0.0, 1.0))] } else { STEPS.iter().map(fill).collect() };
    let front = Front { round: Round::Capsule { ends, radius }, halves: vec![] };
    body(wires, front, fills, vec![], paint)
}

/// A cylinder between two points; all in pixels.
pub(super) fn cylinder(ends: [Point3<f64>; 2], radius: f64, paint: &Paint) -> Body {
    let axis = Unit::new_normalize(ends[1] - ends[0]);
    let rings = ends.map(|end| ring(&end, &axis, radius));
    let rounds = rings.iter().flat_map(|ring| edges(ring));
    let ribs = rings[0].iter().zip(&rings[1]).map(|(a, b)| [*a, *b]);
    let wires: Vec<_> = rounds.chain(ribs).collect();
    let sides = rings[0].iter().map(|point| Half::behind(point, (point - ends[0]).normalize()));
    let caps = [Half::behind(&ends[0], -*axis), Half::behind(&ends[1], *axis)];
    let front = Front { round: Round::None, halves: sides.chain(caps).collect() };
    let whole = flat(&hull(wires.iter().flatten().copied().collect()));
    let mut fills =
        vec![Fill { outline: whole, color: shade(paint.color, if paint.opacity < 1.0 { 1.0 } else { 0.2 }) }];
    if paint.opacity >= 1.0 {
        fills.extend(bands(&rings, ends[0], &axis, paint));
    }
    let near = usize::from(axis.z > 0.0);
    if paint.opacity >= 1.0 && axis.z != 0.0 {
        fills.push(Fill {
            outline: flat(&hull(rings[near].clone())),
            color: shade(paint.color, lit(&caps[near].normal)),
        });
    }
    let seen = if paint.opacity < 1.0 { &rings[..] } else { &rings[near..=near] };
    let creases = seen.iter().flat_map(|ring| edges(ring)).map(|edge| edge.map(|p| p.xy()));
    body(wires, front, fills, creases.collect(), paint)
}

/// Stripes along a cylinder, one within the other, towards the light.
fn bands(rings: &[Vec<Point3<f64>>; 2], centre: Point3<f64>, axis: &Vector3<f64>, paint: &Paint) -> Vec<Fill> {
    let Some(across) = (light() - axis * axis.dot(&light())).try_normalize(1e-9) else { return vec![] };
    let band = |&(step, lit): &(f64, f64)| {
        let within = |rib: &usize| {
            let out = (rings[0][*rib] - centre).normalize();
            out.z > -1e-9 && out.dot(&across) > (PI * (0.5 - step / 2.0)).cos()
        };
        let ribs: Vec<_> = (0..RIBS).filter(within).flat_map(|rib| [rings[0][rib], rings[1][rib]]).collect();
        Fill { outline: flat(&hull(ribs)), color: shade(paint.color, lit) }
    };
    STEPS[1..].iter().map(band).filter(|fill| fill.outline.len() > 2).collect()
}

/// A box from the places of its corners; bits of the index say on which side: x, y, z.
pub(super) fn block(corner: [Point3<f64>; 8], paint: &Paint) -> Body {
    let mut wires = vec![];
    let mut faces: Vec<(Half, [usize; 4])> = vec![];
    for axis in [1, 2, 4] {
        let [u, v] = [[2, 4], [1, 4], [1, 2]][axis / 2];
        wires.extend([0, u, v, u + v].map(|base| [corner[base], corner[base + axis]]));
        let out = (corner[axis] - corner[0]).normalize();
        for (base, normal) in [(0, -out), (axis, out)] {
            faces.push((Half::behind(&corner[base], normal), [base, base + u, base + u + v, base + v]));
        }
    }
    let seen: Vec<_> = faces.iter().filter(|(half, _)| half.normal.z > 1e-9).collect();
    let face = |(half, of): &&(Half, [usize; 4])| Fill {
        outline: flat(&hull(of.map(|i| corner[i]).to_vec())),
        color: shade(paint.color, if paint.opacity < 1.0 { 1.0 } else { lit(&half.normal) }),
    };
    let fills = seen.iter().map(face).collect();
    let drawn = seen.iter().flat_map(|(_, of)| edges(of).collect::<Vec<_>>());
    let creases = drawn.map(|edge| edge.map(|i| corner[i].xy())).collect();
    let front = Front { round: Round::None, halves: faces.iter().map(|face| face.0).collect() };
    body(wires, front, fills, creases, paint)
}

/// A flat area from the places of its corners, in order.
pub(super) fn plate(corners: &[Point3<f64>], paint: &Paint) -> Body {
    let wires: Vec<_> = edges(corners).collect();
    let nearest = corners.iter().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
    let front = match Slab::new(corners.to_vec()) {
        Some(slab) if slab.behind.normal.z > 1e-3 => Front { round: Round::None, halves: vec![slab.behind] },
        _ => Front { round: Round::Level(nearest), halves: vec![] },
    };
    let fill = Fill { outline: flat(&hull(corners.to_vec())), color: Color::from(paint.color) };
    body(wires, front, vec![fill], vec![], paint)
}

fn body(
    wires: Vec<[Point3<f64>; 2]>,
    front: Front,
    fills: Vec<Fill>,
    creases: Vec<[Point2<f64>; 2]>,
    paint: &Paint,
) -> Body {
    Body { wires, front, fills, creases, opacity: paint.opacity, ink: ink(paint), cuts: vec![] }
}

fn flat(outline: &[Point3<f64>]) -> Vec<Point2<f64>> {
    outline.iter().map(Point3::xy).collect()
}

/// A circle that faces the viewer.
fn disc(centre: &Point3<f64>, radius: f64) -> Vec<Point3<f64>> {
    ring(centre, &Vector3::z_axis(), radius)
}

/// A circle about an axis; which of its points is the first depends on the axis alone.
fn ring(centre: &Point3<f64>, axis: &Unit<Vector3<f64>>, radius: f64) -> Vec<Point3<f64>> {
    let aside = if axis.x.abs() < 0.8 { Vector3::x() } else { Vector3::y() };
    let first = axis.cross(&aside).normalize() * radius;
    let at = |rib: usize| centre + Rotation3::from_axis_angle(axis, TAU * rib as f64 / RIBS as f64) * first;
    (0..RIBS).map(at).collect()
}

/// The outline of a ball and great circles through its nearest point.
fn ball(centre: &Point3<f64>, radius: f64) -> Vec<[Point3<f64>; 2]> {
    let meridian = |i: usize| {
        let (s, c) = (PI * i as f64 / MERIDIANS as f64).sin_cos();
        ring(centre, &Unit::new_unchecked(Vector3::new(c, s, 0.0)), radius)
    };
    let circles = std::iter::once(disc(centre, radius)).chain((0..MERIDIANS).map(meridian));
    circles.flat_map(|circle| edges(&circle).collect::<Vec<_>>()).collect()
}

/// The corners of a box of these whole lengths about the origin.
pub(super) fn about_origin(size: &Vector3<f64>) -> [Point3<f64>; 8] {
    let half = Point3::from(size / 2.0);
    corners([-half, half])
}
