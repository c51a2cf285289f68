//! Movements in joint space: their ends, and the distances along the line of ends and from it.

use experiments::line;
use nalgebra::{Point3, Vector3};
use plot::{Camera, Dash, Frame, Item, Paint, Space, Stroke};

use crate::Agent;

/// Number of movements that are drawn.
const SHOWN: usize = 50;

/// Half the side of the frame: [−1, 1]³, the region of the starts, with room for the cylinder.
const EXTENT: f64 = 1.3;

/// The distance of the planes from 0, and the radius of the cylinder, radians.
const PLANE_AT: f64 = 0.5;
const RADIUS: f64 = 0.5;

/// Half the side of a plane that is drawn, radians.
const HALF_SIDE: f64 = 0.75;

const LINE: &str = "#1a1a1a";
const BOUND: &str = "#e69f00";
const GOAL: &str = "#cc79a7";

/// Labels of the lines, which appear only under the first of the three scenes.
const NAMES: [Option<&str>; 2] = [Some("movement"), Some("line l")];
const NAMELESS: [Option<&str>; 2] = [None; 2];

/// View along q₃: q₁ to the right, q₂ upwards.
const ABOVE: Camera = Camera { azimuth: -90.0, elevation: 90.0 };

/// (a) in perspective; (b), (c) projected onto the first two joints, with planes across the line and a cylinder around
/// it.
pub(super) fn scenes(movements: &[Vec<(f64, f64, f64)>]) -> [Space; 3] {
    let shown = &movements[..SHOWN.min(movements.len())];
    let perspective = Camera { azimuth: -50.0, elevation: 20.0 };
    [
        scene("(a) Movements in joint space", perspective, NAMES, shown, vec![], vec![]),
        scene("(b) Seen along q₃: planes at a distance d", ABOVE, NAMELESS, shown, planes(), depth()),
        scene("(c) Seen along q₃: a cylinder of radius r", ABOVE, NAMELESS, shown, vec![cylinder()], radius()),
    ]
}

fn scene(
    title: &str,
    camera: Camera,
    [movement_name, along]: [Option<&str>; 2],
    movements: &[Vec<(f64, f64, f64)>],
    bounds: Vec<Item>,
    measured: Vec<Item>,
) -> Space {
    let point = |&(x, y, z): &(f64, f64, f64)| Point3::new(x, y, z);
    let mut items = bounds;
    for movement in movements {
        let points = movement.iter().map(point).collect();
        items.push(Item::Path {
            points,
            stroke: Agent::Demonstration.stroke(1.0),
            label: movement_name.map(str::to_owned),
        });
    }
    let ends = movements.iter().filter_map(|movement| movement.last().map(point)).collect();
    let far = Point3::from(line() * 1.3);
    let line = Stroke { color: LINE, width: 1.4, dash: Dash::Dashed };
    let over = vec![
        Item::Path { points: vec![-far, far], stroke: line, label: along.map(str::to_owned) },
        Item::Dots { points: ends, color: Agent::Demonstration.color(), radius: 2.4 },
    ];
    let goal = Item::Mark { at: Point3::origin(), text: "0".to_owned(), color: GOAL };
    let over = over.into_iter().chain(measured).chain([goal]).collect();
    let (lowest, highest) = (Point3::from([-EXTENT; 3]), Point3::from([EXTENT; 3]));
    let frame = Frame { lowest, highest, labels: ["q₁ (rad)", "q₂ (rad)", "q₃ (rad)"].map(str::to_owned) };
    Space { title: title.to_owned(), camera, items, over, frame: Some(frame), extent: None, size: (410.0, 430.0) }
}

/// The planes q·l = ±d.
fn planes() -> Vec<Item> {
    let across = line().cross(&Vector3::z()).normalize() * HALF_SIDE;
    let up = across.cross(&line()).normalize() * HALF_SIDE;
    let plane = |at: f64| {
        let centre = Point3::from(line() * at);
        let corners = vec![centre + across + up, centre - across + up, centre - across - up, centre + across - up];
        Item::Plate { corners, paint: Paint { color: BOUND, opacity: 0.45 } }
    };
    vec![plane(-PLANE_AT), plane(PLANE_AT)]
}

/// An arrow from 0, with the distance's letter `shift` pixels from its end.
fn distance(letter: &str, to: Vector3<f64>, shift: (f64, f64)) -> Vec<Item> {
    let stroke = Stroke { color: LINE, width: 2.4, dash: Dash::Solid };
    let to = Point3::from(to);
    let note = Item::Note { at: to, text: letter.to_owned(), shift, color: LINE };
    vec![Item::Arrow { from: Point3::origin(), to, stroke }, note]
}

/// The distance along the line; the letter is where no movement ends.
fn depth() -> Vec<Item> {
    distance("d", line() * PLANE_AT, (-8.0, -11.0))
}

/// The distance across the line, as seen from above.
fn radius() -> Vec<Item> {
    distance("r", line().cross(&Vector3::z()).normalize() * RADIUS, (4.0, 12.0))
}

fn cylinder() -> Item {
    let end = Point3::from(line() * 1.15);
    Item::Cylinder { ends: [-end, end], radius: RADIUS, paint: Paint { color: BOUND, opacity: 0.3 } }
}
