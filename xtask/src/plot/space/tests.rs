use kuva::render::color::Color;
use nalgebra::{IsometryMatrix3, Point2, Rotation3, Translation3, Vector3};
use proptest::{collection::vec, prelude::*};

use super::pieces::{Look, Piece};
use super::*;
use crate::plot::{Dash, Stroke, Who};

const SIZE: (f64, f64) = (400.0, 300.0);

fn point() -> impl Strategy<Value = Point3<f64>> {
    let side = || -2.0..2.0_f64;
    (side(), side(), side()).prop_map(|(x, y, z)| Point3::new(x, y, z))
}

fn camera() -> impl Strategy<Value = Camera> {
    (-180.0..180.0, -90.0..=90.0).prop_map(|(azimuth, elevation)| Camera { azimuth, elevation })
}

fn stroke() -> impl Strategy<Value = Stroke> {
    let dash = prop_oneof![Just(Dash::Solid), Just(Dash::Dashed), Just(Dash::Dotted)];
    (dash, 0.5..4.0).prop_map(|(dash, width)| Stroke { color: "#0072b2", width, dash })
}

fn paint() -> impl Strategy<Value = Paint> {
    prop_oneof![Just(1.0), 0.1..0.9].prop_map(|opacity| Paint { color: "#e0e0d8", opacity })
}

fn item() -> impl Strategy<Value = Item> {
    let pose = (point(), point()).prop_map(|(at, turn)| {
        IsometryMatrix3::from_parts(Translation3::from(at.coords), Rotation3::from_scaled_axis(turn.coords))
    });
    let triangle = vec(point(), 3);
    prop_oneof![
        (vec(point(), 2..6), stroke()).prop_map(|(points, stroke)| Item::Path { points, stroke, label: Some("path") }),
        (point(), point(), stroke()).prop_map(|(from, to, stroke)| Item::Arrow { from, to, stroke }),
        vec(point(), 1..5).prop_map(|points| Item::Dots { points, color: "#000000", radius: 3.0 }),
        (triangle, paint()).prop_map(|(corners, paint)| Item::Plate { corners, paint }),
        (point(), 0.1..1.0, paint()).prop_map(|(centre, radius, paint)| Item::Ball { centre, radius, paint }),
        ([point(), point()], 0.1..1.0, paint()).prop_map(|(ends, radius, paint)| Item::Capsule { ends, radius, paint }),
        ([point(), point()], 0.1..1.0, paint()).prop_map(|(ends, radius, paint)| Item::Cylinder {
            ends,
            radius,
            paint
        }),
        (pose, paint()).prop_map(|(pose, paint)| Item::Block { pose, size: Vector3::new(0.3, 0.8, 0.5), paint }),
        (point(), -40.0..40.0, -40.0..40.0).prop_map(|(at, right, down)| Item::Note {
            at,
            text: "a word".to_owned(),
            shift: (right, down),
            color: "#000000"
        }),
        point().prop_map(|at| Item::Mark { at, text: "22".to_owned(), color: "#000000" }),
    ]
}

fn space(camera: Camera, items: Vec<Item>) -> Space {
    let (lowest, highest) = (Point3::new(-1.0, -1.0, 0.0), Point3::new(1.0, 2.0, 0.5));
    let frame = Some(Frame { lowest, highest, labels: ["x (m)", "y (m)", "z (m)"] });
    Space { title: "scene".to_owned(), camera, items, over: vec![], frame, extent: None, size: SIZE }
}

/// Left, right, top, bottom of what a primitive draws; words only roughly.
fn bounds(primitive: &Primitive) -> Vec<[f64; 4]> {
    match primitive {
        Primitive::PolyLine { points, stroke_width, .. } => {
            let half = stroke_width / 2.0;
            points.iter().map(|(x, y)| [x - half, x + half, y - half, y + half]).collect()
        }
        Primitive::Path(path) => {
            let numbers = path.d.split(['M', 'L', 'Z', ' ']).filter(|part| !part.is_empty());
            let numbers: Vec<f64> = numbers.map(|number| number.parse().unwrap()).collect();
            numbers.chunks(2).map(|at| [at[0], at[0], at[1], at[1]]).collect()
        }
        Primitive::Circle { cx, cy, r, .. } => vec![[cx - r, cx + r, cy - r, cy + r]],
        Primitive::Text { x, y, content, anchor, rotate: None, size, .. } => {
            let width = 0.6 * f64::from(*size) * content.chars().count() as f64;
            let left = match anchor {
                TextAnchor::Start => *x,
                TextAnchor::Middle => x - width / 2.0,
                TextAnchor::End => x - width,
            };
            vec![[left, left + width, y - 0.7 * f64::from(*size), *y]]
        }
        Primitive::Text { x, y, .. } => vec![[*x, *x, *y, *y]],
        Primitive::GroupStart { .. } | Primitive::GroupEnd => vec![],
        other => panic!("{other:?} is not expected"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn everything_is_on_the_panel(camera in camera(), items in vec(item(), 1..8)) {
        for primitive in &space(camera, items).scene().elements {
            for [left, right, top, bottom] in bounds(primitive) {
                let within = left > 0.0 && right < SIZE.0 && top > 0.0 && bottom < SIZE.1;
                prop_assert!(within, "{primitive:?} leaves the panel");
            }
        }
    }

    #[test]
    fn of_balls_apart_the_nearer_is_drawn_later(camera in camera(), balls in vec((point(), 0.2..0.8), 2..12)) {
        let mut apart: Vec<(Point3<f64>, f64)> = vec![];
        for ball in balls {
            if apart.iter().all(|other| (other.0 - ball.0).norm() > other.1 + ball.1) {
                apart.push(ball);
            }
        }
        let item = |&(centre, radius): &(_, f64)| Item::Ball { centre, radius, paint: Paint::opaque("#ffffff") };
        let items: Vec<_> = apart.iter().map(item).collect();
        let pieces = order::sorted(pieces::pieces(&items, &space(camera, items.clone()).view()));
        for (later, piece) in pieces.iter().enumerate() {
            for earlier in &pieces[..later] {
                let both = outline::common(&piece.outline, &earlier.outline);
                if outline::area(&both) > 1.0 {
                    let at = outline::middle(&both);
                    prop_assert!(piece.front.nearness(&at) > earlier.front.nearness(&at));
                }
            }
        }
    }

    #[test]
    fn a_capsule_covers_the_discs_at_its_ends_and_its_axis(a in point(), b in point(), radius in 0.1..1.0, turn in 0.0..6.3) {
        let place = |p: Point3<f64>| Point3::from(p.coords * 50.0);
        let ends = [place(a), place(b)];
        let radius = radius * 50.0;
        let body = solid::capsule(ends, radius, &Paint::opaque("#ffffff"));
        let outline: Vec<Point2<f64>> = body.outline().iter().map(Point3::xy).collect();
        let aside = nalgebra::Vector2::new(f64::cos(turn), f64::sin(turn)) * (0.995 * radius);
        for end in ends {
            prop_assert!(outline::holds(&outline, &(end.xy() + aside)));
            let beside = body.front.nearness(&(end.xy() + aside * 0.5));
            prop_assert!(beside >= end.z + 0.86 * radius);
        }
        prop_assert!(outline::holds(&outline, &nalgebra::center(&ends[0], &ends[1]).xy()));
        // Light and shadow stay within it, but for what the hull rounds off.
        let outside = |point: &Point2<f64>, [p, q]: [Point2<f64>; 2]| -(q - p).perp(&(point - p)) / (q - p).norm();
        for corner in body.fills.iter().flat_map(|fill| &fill.outline) {
            prop_assert!(outline::edges(&outline).all(|edge| outside(corner, edge) < 0.01));
        }
    }

    #[test]
    fn the_front_of_a_flat_faced_body_is_its_nearest_side(camera in camera(), a in point(), b in point(), u in 0.05..0.95, v in 0.0..6.3) {
        prop_assume!((b - a).norm() > 0.2);
        let item = Item::Cylinder { ends: [a, b], radius: 0.4, paint: Paint::opaque("#ffffff") };
        let view = space(camera, vec![item.clone()]).view();
        let piece = pieces::pieces(&[item], &view).remove(0);
        // A point inside is never nearer than the front before it.
        let axis = nalgebra::Unit::new_normalize(b - a);
        let aside = Rotation3::from_axis_angle(&axis, v) * axis.cross(&Vector3::new(0.6, 0.64, 0.48)).normalize();
        let inside = view.place(&(a + (b - a) * u + aside * (0.98 * 0.4)));
        prop_assert!(piece.front.nearness(&inside.xy()) >= inside.z);
    }

    #[test]
    fn a_stroke_through_a_plate_is_hidden_behind_it_only(azimuth in 10.0..80.0, height in -0.8..0.8) {
        let plate = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = plate.map(|(y, z)| Point3::new(0.0, y, z)).to_vec();
        let points = vec![Point3::new(-1.0, 0.0, height), Point3::new(1.0, 0.0, height)];
        let items = [
            Item::Plate { corners, paint: Paint { color: "#56b4e9", opacity: 0.4 } },
            Item::Path { points, stroke: Who::Expert.stroke(2.0), label: None },
        ];
        let space = space(Camera { azimuth, elevation: 20.0 }, items.to_vec());
        let view = space.view();
        let pieces = order::sorted(pieces::pieces(&items, &view));
        let plate = pieces.iter().position(|piece| matches!(piece.look, Look::Body { .. })).unwrap();
        let through = view.place(&Point3::new(0.0, 0.0, height)).xy();
        let towards = view.direction(&Vector3::x()).xy();
        let covered = |piece: &Piece| outline::area(&outline::common(&piece.outline, &pieces[plate].outline)) > 0.1;
        prop_assert!(pieces.iter().filter(|piece| covered(piece)).count() > 2);
        for (at, piece) in pieces.iter().enumerate().filter(|(at, piece)| *at != plate && covered(piece)) {
            let before = (middle_of(piece) - through).dot(&towards) > 0.0;
            prop_assert_eq!(at > plate, before);
        }
    }

    #[test]
    fn a_body_through_a_plate_is_drawn_in_two_parts_that_make_it_up(y in -0.4..0.4, turn in -0.6..0.6, azimuth in -70.0..70.0) {
        let plate = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = plate.map(|(y, z)| Point3::new(0.0, y, z)).to_vec();
        let ends = [Point3::new(-0.5, y, 0.0), Point3::new(0.5, y + turn, 0.3)];
        let limb = Item::Capsule { ends, radius: 0.1, paint: Paint::opaque("#ffffff") };
        let wall = Item::Plate { corners, paint: Paint { color: "#56b4e9", opacity: 0.4 } };
        let view = space(Camera { azimuth, elevation: 15.0 }, vec![limb.clone()]).view();
        let whole = pieces::pieces(std::slice::from_ref(&limb), &view).remove(0);
        let pieces = order::sorted(pieces::pieces(&[limb, wall], &view));
        prop_assert_eq!(pieces.len(), 3);
        let opaque = |piece: &Piece| matches!(piece.look, Look::Body { opacity, .. } if opacity == 1.0);
        prop_assert!(opaque(&pieces[0]) && !opaque(&pieces[1]) && opaque(&pieces[2]));
        let shared = outline::area(&outline::common(&pieces[0].outline, &pieces[2].outline));
        let sum = outline::area(&pieces[0].outline) + outline::area(&pieces[2].outline) - shared;
        let whole = outline::area(&whole.outline);
        prop_assert!(sum <= whole * 1.0001 && sum > whole * 0.98, "{sum} of {whole}");
    }

    #[test]
    fn dashes_draw_their_share_of_a_line(points in vec(point(), 2..6), stroke in stroke()) {
        let points: Vec<_> = points.iter().map(|p| Point3::from(p.coords * 100.0)).collect();
        let length = |line: &[Point3<f64>]| line.windows(2).map(|pair| (pair[1].xy() - pair[0].xy()).norm()).sum::<f64>();
        let drawn: f64 = line::pieces(&points, &stroke, &[]).iter().map(|dash| length(dash)).sum();
        let share = match stroke.dash {
            Dash::Solid => 1.0,
            Dash::Dashed => 4.0 / 7.2,
            Dash::Dotted => 0.05 / 2.45,
        };
        let most = 6.0 * stroke.width.max(1.0);
        prop_assert!((drawn - share * length(&points)).abs() < most);
    }
}

fn middle_of(piece: &Piece) -> Point2<f64> {
    match &piece.look {
        Look::Stroke { ends: [a, b], .. } => nalgebra::center(a, b),
        other => panic!("{other:?} is not a stroke"),
    }
}

#[test]
fn a_whole_stroke_is_one_line() {
    let points: Vec<_> =
        (0..100).map(|i| Point3::new(f64::from(i).sin(), f64::from(i) * 0.1, f64::from(i % 7))).collect();
    let path = Item::Path { points, stroke: Who::Expert.stroke(1.0), label: None };
    let mut space = space(Camera { azimuth: 30.0, elevation: 20.0 }, vec![path]);
    space.frame = None;
    let lines = space.scene().elements.iter().filter(|e| matches!(e, Primitive::PolyLine { .. })).count();
    // From its farthest piece to its end, and then what comes before.
    assert!(lines <= 2, "{lines} lines");
}

#[test]
fn the_side_towards_the_light_is_lighter() {
    let brightness = |normal: Vector3<f64>| match shade::shade("#ffffff", shade::lit(&normal)) {
        Color::Rgb(red, ..) => red,
        other => panic!("{other:?} is not a colour"),
    };
    assert_eq!(brightness(shade::light()), 255);
    let [top, front, right] = [-Vector3::y(), Vector3::z(), Vector3::x()].map(brightness);
    assert!(top > front - 3 && front > right && right > 150);
}
