//! The surroundings of the robot.

use demo_gen::GraspScene;
use serde::{Deserialize, Serialize};

/// Ball, table, the plane of the plates, and the target places of the palms.
#[derive(Serialize, Deserialize)]
pub(crate) struct Scene {
    pub(crate) ball: Ball,
    pub(crate) table: Table,
    pub(crate) wall: Wall,
    /// Left palm, then right.
    pub(crate) target: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
pub(crate) struct Ball {
    pub(crate) centre: [f64; 3],
    pub(crate) diameter: f64,
}

/// A board from x = `near` to `far`, symmetric in y.
#[derive(Serialize, Deserialize)]
pub(crate) struct Table {
    pub(crate) top: f64,
    pub(crate) near: f64,
    pub(crate) far: f64,
    pub(crate) half_width: f64,
}

/// The plates are in the plane of this x; they act within `reach` of it.
#[derive(Serialize, Deserialize)]
pub(crate) struct Wall {
    pub(crate) x: f64,
    pub(crate) reach: f64,
}

pub(super) fn scene(scene: &GraspScene) -> Scene {
    let [near, far] = scene.table_depth;
    Scene {
        ball: Ball { centre: scene.ball.coords.into(), diameter: scene.ball_diameter },
        table: Table { top: scene.table_top, near, far, half_width: scene.table_half_width },
        wall: Wall { x: scene.wall, reach: scene.wall_influence },
        target: scene.target().iter().copied().collect(),
    }
}
