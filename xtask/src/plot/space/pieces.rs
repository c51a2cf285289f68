use kuva::render::color::Color;
use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::super::{Dash, Stroke};
use super::body::{Body, Fill, Slab};
use super::front::{Front, Half, Round};
use super::outline::{area, edges, hull};
use super::view::View;
use super::{Item, line, solid};

/// What is put in order: convex, and drawn at once.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Where it is on the panel; convex, turning as hulls do.
    pub(super) outline: Vec<Point2<f64>>,
    pub(super) front: Front,
    /// How near its middle is.
    pub(super) depth: f64,
    pub(super) look: Look,
}

/// How a piece is drawn.
#[derive(Debug, Clone)]
pub(super) enum Look {
    /// A piece of a stroke: which stroke, and the how many-eth of it.
    Stroke {
        stroke: usize,
        place: usize,
        ends: [Point2<f64>; 2],
        style: Stroke,
    },
    Dot {
        centre: Point2<f64>,
        radius: f64,
        color: &'static str,
    },
    Body {
        fills: Vec<Fill>,
        lines: Vec<[Point2<f64>; 2]>,
        opacity: f64,
        ink: Color,
    },
}

/// Strokes and dots that lie on a surface are before it, by this many pixels.
const LIFT: f64 = 0.75;

/// All pieces of the items.
pub(super) fn pieces(items: &[Item], view: &View) -> Vec<Piece> {
    let place = |points: &[Point3<f64>]| points.iter().map(|point| view.place(point)).collect::<Vec<_>>();
    let plates =
        items.iter().filter_map(|item| if let Item::Plate { corners, .. } = item { Some(corners) } else { None });
    let slabs: Vec<Slab> = plates.filter_map(|corners| Slab::new(place(corners))).collect();
    let mut pieces = Pieces { slabs, done: vec![], strokes: 0 };
    for item in items {
        match item {
            Item::Path { points, stroke, .. } => pieces.add_line(&place(points), stroke),
            Item::Arrow { from, to, stroke } => pieces.add_arrow(view.place(from), view.place(to), stroke),
            Item::Dots { points, color, radius } => {
                for at in place(points) {
                    pieces.add_dot(&at, color, *radius);
                }
            }
            Item::Plate { corners, paint } => pieces.add_body(solid::plate(&place(corners), paint)),
            Item::Ball { centre, radius, paint } => {
                pieces.add_body(solid::capsule([view.place(centre); 2], view.length(*radius), paint));
            }
            Item::Capsule { ends, radius, paint } => {
                pieces.add_body(solid::capsule(ends.map(|end| view.place(&end)), view.length(*radius), paint));
            }
            Item::Cylinder { ends, radius, paint } => {
                pieces.add_body(solid::cylinder(ends.map(|end| view.place(&end)), view.length(*radius), paint));
            }
            Item::Block { pose, size, paint } => {
                let corners = solid::about_origin(size).map(|corner| view.place(&(pose * corner)));
                pieces.add_body(solid::block(corners, paint));
            }
            Item::Note { .. } | Item::Mark { .. } => {}
        }
    }
    pieces.done
}

struct Pieces {
    slabs: Vec<Slab>,
    done: Vec<Piece>,
    strokes: usize,
}

impl Pieces {
    fn add_line(&mut self, points: &[Point3<f64>], style: &Stroke) {
        if points.len() < 2 {
            return;
        }
        for stroke in line::pieces(points, style, &self.slabs) {
            for (place, pair) in stroke.windows(2).enumerate() {
                let (outline, front) = strip([pair[0], pair[1]], style.width);
                let look = Look::Stroke {
                    stroke: self.strokes,
                    place,
                    ends: [pair[0].xy(), pair[1].xy()],
                    style: Stroke { dash: Dash::Solid, ..*style },
                };
                let depth = f64::midpoint(pair[0].z, pair[1].z) + LIFT;
                self.done.push(Piece { outline, front, depth, look });
            }
            self.strokes += 1;
        }
    }

    /// A line that ends in a flat head, turned towards the viewer.
    fn add_arrow(&mut self, from: Point3<f64>, to: Point3<f64>, style: &Stroke) {
        let seen = (to.xy() - from.xy()).norm();
        if seen < 1.0 {
            return;
        }
        let head = line::head(style).min(0.6 * seen);
        let foot = to - (to - from) * (head / seen);
        self.add_line(&[from, foot], style);
        let aside = Vector3::new(from.y - to.y, to.x - from.x, 0.0) * (0.38 * head / seen);
        let outline: Vec<_> = hull(vec![to, foot + aside, foot - aside]).iter().map(Point3::xy).collect();
        let fill = Fill { outline: outline.clone(), color: Color::from(style.color) };
        let lines = edges(&outline).collect();
        let look = Look::Body { fills: vec![fill], lines, opacity: 1.0, ink: Color::from(style.color) };
        let depth = f64::midpoint(foot.z, to.z) + LIFT;
        self.done.push(Piece { outline, front: level(depth), depth, look });
    }

    fn add_dot(&mut self, at: &Point3<f64>, color: &'static str, radius: f64) {
        let corner = |(x, y): (f64, f64)| at.xy() + Vector2::new(x, y) * radius;
        let outline = [(-0.7, -0.7), (0.7, -0.7), (0.7, 0.7), (-0.7, 0.7)].map(corner).to_vec();
        let depth = at.z + LIFT;
        let look = Look::Dot { centre: at.xy(), radius, color };
        self.done.push(Piece { outline, front: level(depth), depth, look });
    }

    /// A body, cut at every plate that it passes through.
    fn add_body(&mut self, body: Body) {
        let mut parts = vec![body];
        for slab in &self.slabs {
            parts = parts.into_iter().flat_map(|part| part.cut(slab).map_or_else(|| vec![part], Vec::from)).collect();
        }
        self.done.extend(parts.into_iter().map(piece));
    }
}

fn piece(body: Body) -> Piece {
    let corners = body.outline();
    let mut outline: Vec<_> = corners.iter().map(Point3::xy).collect();
    if area(&outline) < 1.0
        && let [first, .., last] = corners[..]
    {
        outline = strip([first, last], 1.0).0;
    }
    let depth = corners.iter().map(|corner| corner.z).sum::<f64>() / corners.len() as f64;
    let mut lines = body.creases.clone();
    lines.extend(body.rim());
    Piece {
        outline,
        front: body.front,
        depth,
        look: Look::Body { fills: body.fills, lines, opacity: body.opacity, ink: body.ink },
    }
}

fn level(depth: f64) -> Front {
    Front { round: Round::Level(depth), halves: vec![] }
}

/// The area of a straight stroke, and how near it is.
fn strip([a, b]: [Point3<f64>; 2], width: f64) -> (Vec<Point2<f64>>, Front) {
    let along = (b.xy() - a.xy()).try_normalize(1e-6).unwrap_or_else(Vector2::x);
    let side = Vector2::new(-along.y, along.x) * (width / 2.0);
    let outline = vec![a.xy() - side, b.xy() - side, b.xy() + side, a.xy() + side];
    let length = (b.xy() - a.xy()).norm();
    if length < 1e-6 {
        let end = along * (width / 2.0);
        let square = vec![a.xy() - side - end, a.xy() - side + end, a.xy() + side + end, a.xy() + side - end];
        return (square, level(a.z.max(b.z) + LIFT));
    }
    let rise = (b.z - a.z) / length;
    let normal = Vector3::new(-rise * along.x, -rise * along.y, 1.0);
    let surface = Half::behind(&(a + Vector3::z() * LIFT), normal);
    (outline, Front { round: Round::None, halves: vec![surface] })
}
