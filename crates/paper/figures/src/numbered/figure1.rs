//! The robot: its links, and the positions of its 22 joints.

use experiments::upper_body;
use kinematics::{LinkId, MotionKind, Workspace};
use nalgebra::{IsometryMatrix3, Point3, Vector3};
use plot::{Camera, Dash, Item, Paint, Picture, Space, Stroke};
use serde::{Deserialize, Serialize};

use crate::scene::items::items;
use crate::scene::shapes::{self, Kind, Shape};
use crate::sound::{self, Sound, some};
use crate::{Drawing, Sources, rounded};

/// The robot in the posture "ready", metres in the heel's frame.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Robot {
    shapes: Vec<Shape>,
    joints: Vec<Joint>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Joint {
    name: String,
    slides: bool,
    at: [f64; 3],
    /// Unit vector.
    axis: [f64; 3],
}

impl Sound for Robot {
    const LARGEST: f64 = 10.0;

    fn check(&self) -> anyhow::Result<()> {
        some("joints", &self.joints)?;
        self.shapes.iter().try_for_each(|shape| sound::size(shape.kind, &shape.size))
    }
}

pub(crate) fn ready() -> anyhow::Result<Robot> {
    let body = upper_body()?;
    let robot = body.robot();
    let mut workspace = Workspace::new();
    let poses = robot.forward_kinematics(body.ready().as_view(), &mut workspace)?;
    let joint = |(index, joint): (usize, &kinematics::Joint)| {
        let hangs_on_it =
            |link: LinkId| Some((link, robot.attachment(link)?.joint.filter(|motion| motion.column == index)?));
        let (link, motion) = robot.links().find_map(hangs_on_it)?;
        let axis = poses.pose(link).rotation * motion.axis;
        Some(Joint {
            name: joint.name().to_owned(),
            slides: motion.kind == MotionKind::Translation,
            at: poses.position(link).coords.map(|value| rounded(value, 5)).into(),
            axis: axis.map(|value| rounded(value, 6)).into(),
        })
    };
    let joints = robot.joints().iter().enumerate().filter_map(joint).collect();
    Ok(Robot { shapes: shapes::posed(robot, &poses)?, joints })
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let robot: Robot = sources.document("figure1")?;
    let title = format!("{} joints", robot.joints.len());
    let view = |title: &str, width, over: Vec<Item>| Space {
        title: title.to_owned(),
        camera: Camera { azimuth: 38.0, elevation: 14.0 },
        items: items(&robot.shapes, &IsometryMatrix3::identity(), |link| Part::of(link).paint()),
        over,
        frame: None,
        extent: None,
        size: (width, 560.0),
    };
    let counted = view(&title, 700.0, heel().into_iter().chain(counts(&robot.joints)).collect());
    let axes = axes(&robot.joints).into_iter().chain(height(&robot.shapes));
    let axes = view("Their axes", 480.0, heel().into_iter().chain(axes).collect());
    Ok(Drawing { picture: Picture::rows(&[&[&counted, &axes]]), tables: vec![] })
}

/// Distance of the height scale to the robot's left, metres.
const BESIDE: f64 = 0.55;

/// Parts of the body, by the names of links and joints.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Arm,
    Head,
    Torso,
    Leg,
}

impl Part {
    fn of(name: &str) -> Self {
        match name {
            _ if name.starts_with("l_") || name.starts_with("r_") => Part::Arm,
            _ if name.starts_with("neck") || name.starts_with("head") => Part::Head,
            _ if name.starts_with("torso") => Part::Torso,
            _ => Part::Leg,
        }
    }

    fn paint(self) -> Paint {
        Paint::opaque(match self {
            Part::Arm => "#dbe9f4",
            Part::Head => "#f3e3ee",
            Part::Torso => "#fafaf6",
            Part::Leg => "#d4d4d0",
        })
    }

    fn color(self) -> &'static str {
        match self {
            Part::Arm => "#0072b2",
            Part::Head => "#9a4a7c",
            Part::Torso | Part::Leg => "#1a1a1a",
        }
    }
}

/// The frame of the heel, on the ground.
fn heel() -> Vec<Item> {
    let axis = |(name, direction): (&str, Vector3<f64>)| {
        let (from, to) = (Point3::origin(), Point3::from(direction * 0.32));
        let stroke = Stroke { color: "#1a1a1a", width: 1.8, dash: Dash::Solid };
        let text = name.to_owned();
        let name = Item::Note { at: Point3::from(direction * 0.36), text, shift: (0.0, 0.0), color: "#1a1a1a" };
        [Item::Arrow { from, to, stroke }, name]
    };
    let name = Item::Note { at: Point3::origin(), text: "heel".to_owned(), shift: (46.0, 46.0), color: "#1a1a1a" };
    let axes = [("x", Vector3::x()), ("y", Vector3::y()), ("z", Vector3::z())].into_iter().flat_map(axis);
    axes.chain([name]).collect()
}

/// A scale beside the robot that shows the height of its head, metres.
fn height(shapes: &[Shape]) -> Vec<Item> {
    let top = |shape: &Shape| (shape.kind == Kind::Sphere).then(|| shape.translation[2] + shape.size[0]);
    let top = shapes.iter().filter_map(top).fold(0.0, f64::max);
    let at = |z| Point3::new(0.0, BESIDE, z);
    let stroke = Stroke { color: "#5a5a5a", width: 1.2, dash: Dash::Solid };
    let end = |z| {
        let points = vec![Point3::new(0.0, BESIDE - 0.03, z), Point3::new(0.0, BESIDE + 0.03, z)];
        Item::Path { points, stroke, label: None }
    };
    let line = Item::Path { points: vec![at(0.0), at(top)], stroke, label: None };
    let words = Item::Note { at: at(0.25 * top), text: format!("{top:.1} m"), shift: (6.0, 0.0), color: "#5a5a5a" };
    vec![line, end(0.0), end(top), words]
}

/// Number and names of the joints at each point.
fn counts(joints: &[Joint]) -> Vec<Item> {
    let mut places: Vec<(Point3<f64>, Vec<&Joint>)> = vec![];
    for joint in joints {
        let at = Point3::from(joint.at);
        match places.iter_mut().find(|(place, _)| (*place - at).norm() < 1e-3) {
            Some((_, there)) => there.push(joint),
            None => places.push((at, vec![joint])),
        }
    }
    let items = |(at, there): &(Point3<f64>, Vec<&Joint>)| {
        let (part, name) = (Part::of(&there[0].name), there[0].name.as_str());
        let right = if name.starts_with("r_") { -1.0 } else { 1.0 };
        let shift = match part {
            Part::Arm => (right * 62.0, -20.0),
            Part::Head => (105.0, -14.0),
            Part::Torso | Part::Leg => (-84.0, 66.0),
        };
        let mark = Item::Mark { at: *at, text: there.len().to_string(), color: part.color() };
        [Item::Note { at: *at, text: spelled(there), shift, color: part.color() }, mark]
    };
    places.iter().flat_map(items).collect()
}

/// `shoulder: pitch, roll, yaw` for joints named `l_shoulder_pitch` and so on.
fn spelled(joints: &[&Joint]) -> String {
    let bare = |joint: &&Joint| joint.name.trim_start_matches("l_").trim_start_matches("r_").to_owned();
    let names: Vec<String> = joints.iter().map(bare).collect();
    let parts: Vec<_> = names.iter().filter_map(|name| name.split_once('_')).collect();
    match parts.first() {
        Some((place, _)) => format!("{place}: {}", parts.iter().map(|part| part.1).collect::<Vec<_>>().join(", ")),
        None => names.join(", "),
    }
}

/// The axis of each joint; the axis of a sliding joint is dashed.
fn axes(joints: &[Joint]) -> Vec<Item> {
    let axis = |joint: &Joint| {
        let (at, along) = (Point3::from(joint.at), Vector3::from(joint.axis));
        let (from, to, dash) = if joint.slides { (0.0, 0.26, Dash::Dashed) } else { (-0.05, 0.13, Dash::Solid) };
        let stroke = Stroke { color: Part::of(&joint.name).color(), width: 1.8, dash };
        Item::Arrow { from: at + along * from, to: at + along * to, stroke }
    };
    let points = joints.iter().map(|joint| Point3::from(joint.at)).collect();
    joints.iter().map(axis).chain([Item::Dots { points, color: "#1a1a1a", radius: 3.0 }]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_are_those_of_the_paper() {
        let robot = ready().unwrap();
        let count = |part| robot.joints.iter().filter(|joint| Part::of(&joint.name) == part).count();
        assert_eq!([Part::Arm, Part::Head, Part::Torso, Part::Leg].map(count), [14, 2, 6, 0]);
        let sliding: Vec<_> =
            robot.joints.iter().filter(|joint| joint.slides).map(|joint| joint.name.as_str()).collect();
        assert_eq!(sliding, ["torso_x", "torso_y", "torso_z"]);
    }

    #[test]
    fn axes_are_where_the_file_has_them() {
        let robot = ready().unwrap();
        let joint = |name: &str| robot.joints.iter().find(|joint| joint.name == name).unwrap();
        assert_eq!((joint("torso_z").at, joint("torso_z").axis), ([0.05, 0.0, 0.62], [0.0, 0.0, 1.0]));
        assert_eq!((joint("neck_pitch").at, joint("neck_pitch").axis), ([0.05, 0.0, 1.0], [0.0, 1.0, 0.0]));
        assert_eq!(
            (joint("l_shoulder_pitch").at, joint("l_shoulder_pitch").axis),
            ([0.05, 0.18, 0.92], [0.0, 1.0, 0.0])
        );
        // Upper arm: 0.2 down, rotated by roll 0.3 about x, then by pitch 0.3 about y.
        let elbow = [
            0.05 - 0.2 * 0.3_f64.cos() * 0.3_f64.sin(),
            0.18 + 0.2 * 0.3_f64.sin(),
            0.92 - 0.2 * 0.3_f64.cos().powi(2),
        ];
        let far = (Point3::from(joint("l_elbow").at) - Point3::from(elbow)).norm();
        assert!(far < 2e-5, "{:?} is not {elbow:?}", joint("l_elbow").at);
    }

    #[test]
    fn joints_in_one_point_are_named_together() {
        let robot = ready().unwrap();
        let words: Vec<String> = counts(&robot.joints)
            .into_iter()
            .filter_map(|item| if let Item::Note { text, .. } = item { Some(text) } else { None })
            .collect();
        let arm = ["shoulder: pitch, roll, yaw", "elbow", "wrist: yaw, roll, pitch"];
        let whole = [&["torso: x, y, z, yaw, pitch, roll", "neck: yaw, pitch"], &arm[..], &arm[..]].concat();
        assert_eq!(words, whole);
    }
}
