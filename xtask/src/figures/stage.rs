//! Robot, ball, table and plates of the grasp as things in space.

use nalgebra::{IsometryMatrix3, Point3, Translation3, Vector3};
use plot::{Item, Paint, Stroke};

use super::grasp_playback::{Motion, Robot, Scene};
use super::shapes::{self, Shape};

/// Plates reach from the ground to this height, metres.
pub(crate) const PLATE_TOP: f64 = 1.0;
/// The board of the table, and its legs, metres.
pub(crate) const BOARD: f64 = 0.03;
pub(crate) const LEG: f64 = 0.05;
/// Colours, as in HTML.
pub(crate) const BALL: &str = "#f0e442";
pub(crate) const TABLE: &str = "#efe6d6";
pub(crate) const PLATE: &str = "#56b4e9";

/// Poses of all links in a configuration.
pub(super) fn poses(robot: &Robot, joints: &[f64]) -> Vec<IsometryMatrix3<f64>> {
    let mut poses: Vec<IsometryMatrix3<f64>> = Vec::with_capacity(robot.links.len());
    for link in &robot.links {
        let parent = link.parent.map_or_else(IsometryMatrix3::identity, |parent| poses[parent]);
        let axis = Vector3::from(link.axis);
        let value = link.joint.map_or(0.0, |joint| joints[joint]);
        let moved = match link.motion {
            Motion::Fixed => IsometryMatrix3::identity(),
            Motion::Turn => IsometryMatrix3::rotation(axis * value),
            Motion::Slide => Translation3::from(axis * value).into(),
        };
        poses.push(parent * shapes::pose(&link.translation, &link.rotation) * moved);
    }
    poses
}

/// The robot in a configuration.
pub(super) fn robot(robot: &Robot, joints: &[f64], paint: impl Fn(&str) -> Paint) -> Vec<Item> {
    let poses = poses(robot, joints);
    let posed = robot.shapes.iter().map(|shape| {
        let pose = poses[shape.link] * shapes::pose(&shape.translation, &shape.rotation);
        let (translation, rotation) = shapes::seen(&pose);
        let link = robot.links[shape.link].name.clone();
        Shape { link, kind: shape.kind, size: shape.size.clone(), translation, rotation }
    });
    shapes::items(&posed.collect::<Vec<_>>(), paint)
}

/// The ball, and the table that it lies on.
pub(super) fn ball_and_table(scene: &Scene) -> Vec<Item> {
    let table = &scene.table;
    let paint = Paint::opaque(TABLE);
    let block = |low: [f64; 3], high: [f64; 3]| {
        let (low, high) = (Vector3::from(low), Vector3::from(high));
        let pose = Translation3::from((low + high) / 2.0).into();
        Item::Block { pose, size: high - low, paint }
    };
    let (side, under) = (table.half_width, table.top - BOARD);
    let leg = |(x, y): (f64, f64)| block([x, y, 0.0], [x + LEG, y + LEG, under]);
    let legs = [(table.near, -side), (table.near, side - LEG), (table.far - LEG, -side), (table.far - LEG, side - LEG)];
    let board = block([table.near, -side, under], [table.far, side, table.top]);
    let ball = &scene.ball;
    let ball =
        Item::Ball { centre: Point3::from(ball.centre), radius: ball.diameter / 2.0, paint: Paint::opaque(BALL) };
    legs.map(leg).into_iter().chain([board, ball]).collect()
}

/// The plates that stand in the plane of the wall, no wider than the table.
pub(super) fn plates(scene: &Scene, plates: &[[Option<f64>; 2]]) -> Vec<Item> {
    let side = scene.table.half_width;
    let plate = |[from, to]: &[Option<f64>; 2]| {
        let (from, to) = (from.unwrap_or(-side).max(-side), to.unwrap_or(side).min(side));
        let corner = |(y, z)| Point3::new(scene.wall.x, y, z);
        let corners = [(from, 0.0), (to, 0.0), (to, PLATE_TOP), (from, PLATE_TOP)].map(corner).to_vec();
        Item::Plate { corners, paint: Paint { color: PLATE, opacity: 0.32 } }
    };
    plates.iter().map(plate).collect()
}

/// The way of both hands: of the left palm, then of the right one.
pub(super) fn ways(palms: &[Vec<f64>], stroke: Stroke) -> [Item; 2] {
    let way = |hand: usize| {
        let points = palms.iter().map(|palms| Point3::from_slice(&palms[3 * hand..3 * hand + 3])).collect();
        Item::Path { points, stroke, label: None }
    };
    [way(0), way(1)]
}

#[cfg(test)]
mod tests {
    use demo_gen::Side;
    use kinematics::Workspace;
    use nalgebra::DVector;

    use super::super::grasp_playback::robot as tree;
    use super::*;
    use crate::robots::upper_body;

    #[test]
    fn links_are_where_forward_kinematics_has_them() {
        let body = upper_body().unwrap();
        let tree = tree(&body).unwrap();
        let q = DVector::from_fn(body.robot().n_joints(), |i, _| {
            0.02 * (i as f64 + 1.0) * if i % 2 == 0 { 1.0 } else { -1.0 }
        });
        let poses = poses(&tree, q.as_slice());
        for (side, hand) in Side::BOTH.into_iter().zip(tree.hands) {
            let expected = body.palm(side).pose(q.as_view(), &mut Workspace::new()).unwrap();
            assert!((poses[hand].to_homogeneous() - expected.to_homogeneous()).norm() < 1e-12);
        }
    }

    #[test]
    fn a_robot_of_the_document_is_drawn_as_that_of_the_file() {
        let body = upper_body().unwrap();
        let mut workspace = Workspace::new();
        let paint = |_: &str| Paint::opaque("#ffffff");
        let poses = body.robot().forward_kinematics(body.ready().as_view(), &mut workspace).unwrap();
        let expected = shapes::items(&shapes::posed(body.robot(), &poses).unwrap(), paint);
        let drawn = robot(&tree(&body).unwrap(), body.ready().as_slice(), paint);
        assert_eq!(format!("{drawn:.3?}"), format!("{expected:.3?}"));
    }
}
