use kinematics::{Chain, RobotModel, SelfCollision, Workspace};
use nalgebra::{DVector, DVectorView, Point3};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::DemoGenError;

/// The posture from which movements start: hands in front of the body. All other joints are at 0.
const READY: [(&str, f64); 6] = [
    ("l_shoulder_pitch", 0.3),
    ("l_shoulder_roll", 0.3),
    ("l_elbow", -1.6),
    ("r_shoulder_pitch", 0.3),
    ("r_shoulder_roll", -0.3),
    ("r_elbow", -1.6),
];

/// The hands' frames.
const PALMS: [&str; 2] = ["l_palm", "r_palm"];

/// Number of successive draws in collision after which the posture itself must be at fault.
const MOST_DRAWS: usize = 10_000;

/// One of the two hands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The left.
    Left,
    /// The right.
    Right,
}

impl Side {
    /// Left, then right.
    pub const BOTH: [Side; 2] = [Side::Left, Side::Right];
}

/// The humanoid of Sections 4.2 and 4.3: a robot with the joints and palms of `robots/asimo_upper_body.urdf`, its pairs
/// of links that must not touch, and the posture "ready".
#[derive(Debug, Clone)]
pub struct UpperBody {
    robot: RobotModel,
    collision: SelfCollision,
    palms: [Chain; 2],
    ready: DVector<f64>,
}

impl UpperBody {
    /// The body given by the texts of a URDF and an SRDF. Links `l_palm` and `r_palm` are the hands; the posture
    /// "ready" has the joints `{l,r}_shoulder_pitch` at 0.3, `{l,r}_shoulder_roll` at ±0.3 (outwards), `{l,r}_elbow`
    /// at −1.6, and all others at 0, in radians and metres.
    ///
    /// # Errors
    /// [`DemoGenError::Robot`] for texts that cannot be read, and for missing links or joints.
    pub fn new(urdf: &str, srdf: &str) -> Result<Self, DemoGenError> {
        let robot = RobotModel::from_urdf(urdf)?;
        let mut collision = SelfCollision::new(&robot, |_| None)?;
        collision.disable_srdf(srdf)?;
        let [left, right] = PALMS.map(|name| Ok::<_, DemoGenError>(robot.chain(robot.link(name)?)));
        let palms = [left?, right?];
        let mut ready = DVector::zeros(robot.n_joints());
        for (joint, value) in READY {
            ready[robot.joint(joint)?] = value;
        }
        Ok(UpperBody { robot, collision, palms, ready })
    }

    /// The robot. Poses are in its root's frame: the heel, x forward, y left, z up.
    pub fn robot(&self) -> &RobotModel {
        &self.robot
    }

    /// The pairs of links that must not touch.
    pub fn collision(&self) -> &SelfCollision {
        &self.collision
    }

    /// The posture "ready", (n).
    pub fn ready(&self) -> &DVector<f64> {
        &self.ready
    }

    /// The joints that lead to a hand.
    pub fn palm(&self, side: Side) -> &Chain {
        &self.palms[side as usize]
    }

    /// Positions of the left and the right palm at a configuration q (n), metres in the heel's frame.
    ///
    /// # Errors
    /// [`DemoGenError::Robot`] for a configuration of another length or with values that are not finite.
    pub fn palms(&self, q: DVectorView<'_, f64>) -> Result<[Point3<f64>; 2], DemoGenError> {
        let mut workspace = Workspace::new();
        let [left, right] = &self.palms;
        let mut origin = |chain: &Chain| chain.pose(q, &mut workspace).map(|pose| pose.translation.vector.into());
        Ok([origin(left)?, origin(right)?])
    }

    /// A start configuration (n): drawn from N(ready, `variance`·I), clipped to the joints' limits, and redrawn
    /// until it is free of self-collision. The paper's variance is 0.1.
    ///
    /// Each draw takes n normal numbers from the generator, in the order of the joints.
    ///
    /// # Errors
    /// [`DemoGenError::StartVariance`], or [`DemoGenError::NoFreeStart`] after ten thousand draws in collision.
    pub fn start<R: Rng + ?Sized>(&self, variance: f64, rng: &mut R) -> Result<DVector<f64>, DemoGenError> {
        if !(variance.is_finite() && variance >= 0.0) {
            return Err(DemoGenError::StartVariance { variance });
        }
        let deviation = variance.sqrt();
        let mut workspace = Workspace::new();
        for _ in 0..MOST_DRAWS {
            let mut q = self.ready.map(|value| value + deviation * rng.sample::<f64, _>(StandardNormal));
            self.robot.clip(q.as_view_mut())?;
            if !self.collision.collides(&self.robot.forward_kinematics(q.as_view(), &mut workspace)?) {
                return Ok(q);
            }
        }
        Err(DemoGenError::NoFreeStart { draws: MOST_DRAWS })
    }
}
