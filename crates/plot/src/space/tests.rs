use kuva::render::render::Primitive;
use nalgebra::{IsometryMatrix3, Point2, Rotation3, Translation3, Vector3};
use proptest::{collection::vec, prelude::*};

use super::solid::Solid;
use super::*;
use crate::{Dash, Stroke};

const SIZE: (f64, f64) = (300.0, 220.0);

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

fn pose() -> impl Strategy<Value = IsometryMatrix3<f64>> {
    (point(), point()).prop_map(|(at, turn)| {
        IsometryMatrix3::from_parts(Translation3::from(at.coords), Rotation3::from_scaled_axis(turn.coords))
    })
}

fn body() -> impl Strategy<Value = Item> {
    prop_oneof![
        (vec(point(), 3), paint()).prop_map(|(corners, paint)| Item::Plate { corners, paint }),
        (point(), 0.1..1.0, paint()).prop_map(|(centre, radius, paint)| Item::Ball { centre, radius, paint }),
        ([point(), point()], 0.1..1.0, paint()).prop_map(|(ends, radius, paint)| Item::Capsule { ends, radius, paint }),
        ([point(), point()], 0.1..1.0, paint()).prop_map(|(ends, radius, paint)| Item::Cylinder {
            ends,
            radius,
            paint
        }),
        (pose(), paint()).prop_map(|(pose, paint)| Item::Block { pose, size: Vector3::new(0.3, 0.8, 0.5), paint }),
    ]
}

fn item() -> impl Strategy<Value = Item> {
    let label = || Some("path".to_owned());
    prop_oneof![
        body(),
        (vec(point(), 2..6), stroke()).prop_map(move |(points, stroke)| Item::Path { points, stroke, label: label() }),
        (point(), point(), stroke()).prop_map(|(from, to, stroke)| Item::Arrow { from, to, stroke }),
        vec(point(), 1..5).prop_map(|points| Item::Dots { points, color: "#000000", radius: 3.0 }),
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
    let labels = ["x (m)", "y (m)", "z (m)"].map(str::to_owned);
    let frame = Some(Frame { lowest, highest, labels });
    Space { title: "scene".to_owned(), camera, items, over: vec![], frame, extent: None, size: SIZE }
}

/// Left, right, top, bottom of a primitive; approximate for text.
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

/// Whether a point is within a body, by its definition; units of the scene.
fn holds(item: &Item, point: &Point3<f64>) -> bool {
    let along = |[a, b]: &[Point3<f64>; 2]| (point - a).dot(&(b - a)) / (b - a).norm_squared();
    let off = |ends: &[Point3<f64>; 2], share: f64| (ends[0] + (ends[1] - ends[0]) * share - point).norm();
    match item {
        Item::Ball { centre, radius, .. } => (centre - point).norm() <= *radius,
        Item::Capsule { ends, radius, .. } => off(ends, along(ends).clamp(0.0, 1.0)) <= *radius,
        Item::Cylinder { ends, radius, .. } => (0.0..=1.0).contains(&along(ends)) && off(ends, along(ends)) <= *radius,
        Item::Block { pose, size, .. } => {
            let own = pose.inverse() * point;
            (0..3).all(|axis| own[axis].abs() <= size[axis] / 2.0)
        }
        _ => false,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn everything_is_on_the_panel(camera in camera(), items in vec(item(), 1..6)) {
        let sketch = space(camera, items).sketch();
        for primitive in &sketch.scene.elements {
            for [left, right, top, bottom] in bounds(primitive) {
                let within = left > 0.0 && right < SIZE.0 && top > 0.0 && bottom < SIZE.1;
                prop_assert!(within, "{primitive:?} leaves the panel");
            }
        }
        for raster in &sketch.rasters {
            let ((x, y), scale) = (raster.corner, crate::drawing::raster::DOTS as f64);
            let (right, below) = (x + raster.width as f64 / scale, y + (raster.dots.len() / raster.width) as f64 / scale);
            prop_assert!(x >= 0.0 && y >= 0.0 && right <= SIZE.0 && below <= SIZE.1);
        }
    }

    #[test]
    fn a_line_of_sight_meets_a_body_where_it_enters(camera in camera(), item in body(), across in 0.0..1.0, down in 0.0..1.0) {
        let view = space(camera, vec![item.clone()]).view();
        let solid = Solid::of(&item, &view).unwrap();
        let [low, high] = solid.bounds();
        let at = Point2::new(low.x + across * (high.x - low.x), low.y + down * (high.y - low.y));
        // From the panel back to the scene; the rows of the view are orthogonal.
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| view.direction(&axis));
        let origin = view.place(&Point3::origin());
        let back = |depth: f64| {
            let from = Point3::new(at.x, at.y, depth) - origin;
            Point3::from(Vector3::from(axes.map(|axis| axis.dot(&from) / view.length(1.0))))
        };
        let pixel = 1.0 / view.length(1.0);
        match solid.hit(&at) {
            Some(hit) => {
                prop_assert!((hit.normal.norm() - 1.0).abs() < 1e-9 && hit.normal.z > -1e-9);
                if let Item::Plate { corners, .. } = &item {
                    let across = (corners[1] - corners[0]).cross(&(corners[2] - corners[1])).normalize();
                    prop_assert!((back(hit.depth) - corners[0]).dot(&across).abs() < 1e-6);
                } else {
                    // No point of the body is closer, and the body is just behind the intersection along the normal.
                    let inside = |depth: f64| holds(&item, &back(depth));
                    prop_assert!((1..400).all(|step| !inside(hit.depth + 0.01 + f64::from(step))));
                    let place = Point3::new(at.x, at.y, hit.depth) - hit.normal * 0.01 - origin;
                    let place = Point3::from(Vector3::from(axes.map(|axis| axis.dot(&place) * pixel)));
                    prop_assert!(holds(&item, &place), "{place} is not within {item:?}");
                }
            }
            None => prop_assert!((-600..600).all(|step| !holds(&item, &back(origin.z + f64::from(step))))),
        }
    }

    #[test]
    fn the_nearer_of_two_balls_is_visible(camera in camera(), apart in 0.1..3.0, radius in 0.2..1.0) {
        let axes = camera.axes();
        let towards = axes.row(2).transpose() * apart;
        let paint = |color| Paint::opaque(color);
        let far = Item::Ball { centre: Point3::origin(), radius, paint: paint("#ff0000") };
        let near = Item::Ball { centre: Point3::from(towards), radius: 0.9 * radius, paint: paint("#0000ff") };
        let middle = |items: Vec<Item>| {
            let mut space = space(camera, items);
            (space.frame, space.size, space.title) = (None, (60.0, 50.0), String::new());
            let at = space.view().place(&Point3::origin());
            let raster = cast::raster(&cast::bodies(&space.items, &space.view()), space.size).unwrap();
            let dot = |place: f64, corner: f64| ((place - corner) * crate::drawing::raster::DOTS as f64) as usize;
            raster.dots[dot(at.y, raster.corner.1) * raster.width + dot(at.x, raster.corner.0)]
        };
        for items in [vec![far.clone(), near.clone()], vec![near, far]] {
            let [red, green, blue, share] = middle(items);
            prop_assert!((red, green, share) == (0, 0, 255) && blue > 100);
        }
    }

    #[test]
    fn a_line_through_a_plate_is_hidden_behind_it_only(azimuth in 10.0..45.0, height in -0.6..0.6, opaque in any::<bool>()) {
        let plate = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = plate.map(|(y, z)| Point3::new(0.0, y, z)).to_vec();
        let points = vec![Point3::new(-0.5, 0.0, height), Point3::new(0.5, 0.0, height)];
        let stroke = Stroke { color: "#1a1a1a", width: 2.0, dash: Dash::Solid };
        let items = vec![
            Item::Plate { corners, paint: Paint { color: "#56b4e9", opacity: if opaque { 1.0 } else { 0.4 } } },
            Item::Path { points, stroke, label: None },
        ];
        let mut space = space(Camera { azimuth, elevation: 20.0 }, items);
        space.frame = None;
        let through = space.view().place(&Point3::new(0.0, 0.0, height));
        let end = space.view().place(&Point3::new(0.5, 0.0, height));
        let lines: Vec<_> = space.sketch().scene.elements.into_iter().filter_map(|element| match element {
            Primitive::PolyLine { points, stroke, .. } => Some((points, format!("{stroke:?}"))),
            _ => None,
        }).collect();
        prop_assert_eq!(lines.len(), if opaque { 1 } else { 2 });
        // The last part is before the plate, up to the end of the line.
        let (points, color) = &lines[lines.len() - 1];
        let (from, to) = (points[0], points[points.len() - 1]);
        prop_assert!((from.0 - through.x).hypot(from.1 - through.y) < 4.0, "{from:?} {through}");
        prop_assert!((to.0 - end.x).hypot(to.1 - end.y) < 0.01);
        prop_assert!(color.contains("26, 26, 26"), "{color}");
        prop_assert!(lines[..lines.len() - 1].iter().all(|(_, tinted)| tinted != color));
    }

    #[test]
    fn dashes_draw_their_share_of_a_line(points in vec(point(), 2..6), stroke in stroke()) {
        let points: Vec<_> = points.iter().map(|p| Point3::from(p.coords * 100.0)).collect();
        let mut scene = Scene::new(SIZE.0, SIZE.1);
        super::stroke::line(&points, &stroke, &[], &mut scene);
        let length = |line: &[(f64, f64)]| line.windows(2).map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1)).sum::<f64>();
        let drawn: f64 = scene.elements.iter().map(|element| match element {
            Primitive::PolyLine { points, .. } => length(points),
            other => panic!("{other:?} is no line"),
        }).sum();
        let share = match stroke.dash {
            Dash::Solid => 1.0,
            Dash::Dashed => 4.0 / 7.2,
            Dash::Dotted => 0.05 / 2.45,
        };
        let whole: Vec<_> = points.iter().map(|point| (point.x, point.y)).collect();
        let most = 6.0 * stroke.width.max(1.0) + 0.01 * length(&whole);
        prop_assert!((drawn - share * length(&whole)).abs() < most);
    }
}

#[test]
fn a_line_that_nothing_hides_is_one_line() {
    let points: Vec<_> =
        (0..100).map(|i| Point3::new(f64::from(i).sin(), f64::from(i) * 0.1, f64::from(i % 7))).collect();
    let stroke = Stroke { color: "#1a1a1a", width: 1.0, dash: Dash::Solid };
    let path = Item::Path { points, stroke, label: None };
    let mut space = space(Camera { azimuth: 30.0, elevation: 20.0 }, vec![path]);
    space.frame = None;
    let sketch = space.sketch();
    let lines = sketch.scene.elements.iter().filter(|e| matches!(e, Primitive::PolyLine { .. })).count();
    assert_eq!((lines, sketch.rasters.len()), (1, 0));
}
