use constraints::{Barrier, ConstraintError, Plate};
use nalgebra::{DVector, Point3, Vector3};
use serde::Serialize;

use crate::Parabola;

/// Number of hands.
const N_HANDS: usize = 2;

/// The scene of Section 4.2: a ball on a table behind a wall, in the heel's frame (x forward, y left, z up), metres.
///
/// The state consists of the positions of the left and the right palm, (6).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GraspScene {
    /// Centre of the ball. Default (0.7, 0, 0.65).
    pub ball: Point3<f64>,
    /// Diameter of the ball. Default 0.15.
    pub ball_diameter: f64,
    /// Height of the table's top. Default 0.575: the ball lies on it. The table affects start states and pictures, but does not
    /// constrain the movement.
    pub table_top: f64,
    /// Nearest and farthest x of the table. Default 0.45, 1.05.
    pub table_depth: [f64; 2],
    /// Half the width of the table, |y|. Default 0.6.
    pub table_half_width: f64,
    /// The wall, or another obstacle between robot and ball, is in the plane of this x. Default 0.35, half way to the ball.
    pub wall: f64,
    /// Distance to its plane within which the wall constrains hands. Default 0.09.
    pub wall_influence: f64,
    /// Half the width of the obstacle that no demonstration contains, around the middle. Default 0.125, so that it is as wide as the
    /// mean gap.
    pub obstacle_half_width: f64,
}

impl Default for GraspScene {
    fn default() -> Self {
        GraspScene {
            ball: Point3::new(0.7, 0.0, 0.65),
            ball_diameter: 0.15,
            table_top: 0.575,
            table_depth: [0.45, 1.05],
            table_half_width: 0.6,
            wall: 0.35,
            wall_influence: 0.09,
            obstacle_half_width: 0.125,
        }
    }
}

impl GraspScene {
    /// The target positions of the palms at the ball, (6): at its left and its right.
    pub fn target(&self) -> DVector<f64> {
        let side = Vector3::y() * (self.ball_diameter / 2.0);
        let [left, right] = [self.ball + side, self.ball - side];
        DVector::from_iterator(6, left.iter().chain(right.iter()).copied())
    }

    /// `φ(x) = w‖x − x_c‖²` (24) around the [target](Self::target), with the paper's w = 0.05.
    pub fn potential(&self) -> Parabola {
        Parabola { weight: 0.05, centre: self.target() }
    }

    /// The wall of the demonstrations: two plates, with a gap (metres, 0 or more) between them around the middle. A hand
    /// beside the gap that is within the wall's influence cannot move along x.
    ///
    /// # Errors
    /// Those of [`Barrier::new`], for a wall or gap that is not finite or an influence distance that is not positive.
    pub fn wall_with_gap(&self, gap: f64) -> Result<Barrier, ConstraintError> {
        let edge = gap / 2.0;
        self.barrier(&[[edge, f64::INFINITY], [f64::NEG_INFINITY, -edge]])
    }

    /// The obstacle that no demonstration contains: one plate in the wall's plane, around the middle.
    ///
    /// # Errors
    /// Those of [`Barrier::new`], for an obstacle without width or an influence distance that is not positive.
    pub fn central_obstacle(&self) -> Result<Barrier, ConstraintError> {
        self.barrier(&[[-self.obstacle_half_width, self.obstacle_half_width]])
    }

    fn barrier(&self, edges: &[[f64; 2]]) -> Result<Barrier, ConstraintError> {
        let plate = |&edges| Plate { normal: Vector3::x_axis(), distance: self.wall, along: Vector3::y_axis(), edges };
        Barrier::new(edges.iter().map(plate).collect(), self.wall_influence, N_HANDS)
    }

    /// Whether a point is under or in the table: within its area, but not above its top.
    pub fn is_below_the_table(&self, point: &Point3<f64>) -> bool {
        let [nearest, farthest] = self.table_depth;
        let over = (nearest..=farthest).contains(&point.x) && point.y.abs() <= self.table_half_width;
        over && point.z <= self.table_top
    }
}
