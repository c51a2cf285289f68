//! Robot, ball, table and plates of the grasp as items of a 3-D scene.

use anyhow::ensure;
use demo_gen::UpperBody;
use experiments::upper_body;
use kinematics::{Joint, LinkId, Workspace};
use nalgebra::{DVector, DVectorView, IsometryMatrix3, Point3, Translation3, Vector3};
use plot::{Item, Paint, Stroke};

use crate::grasp_playback::Scene;
use crate::scene::items::items;
use crate::scene::shapes;

/// Height of the plates, from the ground, metres.
pub(crate) const PLATE_TOP: f64 = 1.0;
/// Thickness of the table's board, and of its legs, metres.
pub(crate) const BOARD: f64 = 0.03;
pub(crate) const LEG: f64 = 0.05;
/// Colours in HTML notation.
pub(crate) const BALL: &str = "#f0e442";
pub(crate) const TABLE: &str = "#efe6d6";
pub(crate) const PLATE: &str = "#56b4e9";

/// The robot of the model, in configurations of these joints. Only a document about this robot can be drawn.
pub(crate) struct Actor {
    body: UpperBody,
    trunk: LinkId,
    /// The trunk's pose with all joints at 0.
    at_rest: IsometryMatrix3<f64>,
}

impl Actor {
    pub(crate) fn new(joints: &[String]) -> anyhow::Result<Self> {
        let body = upper_body()?;
        let same = body.robot().joints().iter().map(Joint::name).eq(joints.iter().map(String::as_str));
        ensure!(same, "the figure data are of a robot with other joints; the command of their run writes them again");
        let trunk = body.robot().link("torso")?;
        let rest = DVector::zeros(joints.len());
        let at_rest = body.robot().forward_kinematics(rest.as_view(), &mut Workspace::new())?.pose(trunk);
        Ok(Actor { body, trunk, at_rest })
    }

    /// The robot's shapes; the link determines the paint.
    pub(crate) fn items(&self, joints: &[f64], paint: impl Fn(&str) -> Paint) -> anyhow::Result<Vec<Item>> {
        let mut workspace = Workspace::new();
        let robot = self.body.robot();
        let poses = robot.forward_kinematics(DVectorView::from_slice(joints, joints.len()), &mut workspace)?;
        let moved = poses.pose(self.trunk) * self.at_rest.inverse();
        Ok(items(&shapes::posed(robot, &poses)?, &moved, paint))
    }
}

/// The ball and the table under it.
pub(crate) fn ball_and_table(scene: &Scene) -> Vec<Item> {
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

/// The plates in the plane of the wall, no wider than the table.
pub(crate) fn plates(scene: &Scene, plates: &[[Option<f64>; 2]]) -> Vec<Item> {
    let side = scene.table.half_width;
    let plate = |[from, to]: &[Option<f64>; 2]| {
        let (from, to) = (from.unwrap_or(-side).max(-side), to.unwrap_or(side).min(side));
        let corner = |(y, z)| Point3::new(scene.wall.x, y, z);
        let corners = [(from, 0.0), (to, 0.0), (to, PLATE_TOP), (from, PLATE_TOP)].map(corner).to_vec();
        Item::Plate { corners, paint: Paint { color: PLATE, opacity: 0.32 } }
    };
    plates.iter().map(plate).collect()
}

/// The paths of the left and the right palm.
pub(crate) fn ways(palms: &[Vec<f64>], stroke: Stroke) -> [Item; 2] {
    let way = |hand: usize| {
        let points = palms.iter().map(|palms| Point3::from_slice(&palms[3 * hand..3 * hand + 3])).collect();
        Item::Path { points, stroke, label: None }
    };
    [way(0), way(1)]
}
