use constraints::ConstraintError;
use kinematics::{Chain, RobotModel};
use nalgebra::{DVector, Rotation3, Vector3};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use serde::Serialize;

use super::{Surface, TaskConstraint, WipingPolicy};
use crate::instant::{Actor, System};
use crate::recording::record_each;
use crate::robots::hand::hand_in_plane;
use crate::{DemoGenError, Recording, RollOut};

/// Elbow bent, tool downwards, 0.55 m in front of the base and 0.40 m above its foot.
const READY: [f64; 7] = [0.0, 0.5, 0.0, -1.6, 0.0, std::f64::consts::PI - 2.1, 0.0];

/// Number of Newton steps that move the tool onto its surface.
const STEPS_TO_SURFACE: usize = 10;

/// The degrees of freedom of the tool that a surface constrains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Contact {
    /// The tool's height: nᵀJ_v(q) u = 0, one row.
    Height,
    /// Flat contact: [`Surface`], three rows that also correct deviations.
    Flat,
}

/// An arm with seven joints that follows a [`WipingPolicy`] on a surface, whose tilt differs between movements.
#[derive(Debug, Clone, Serialize)]
pub struct Wiping {
    /// The arm's policy. It is not serialised with the rest; the arm's URDF describes it.
    #[serde(skip)]
    pub policy: WipingPolicy,
    #[serde(skip)]
    robot: RobotModel,
    /// The degrees of freedom that a surface constrains.
    pub contact: Contact,
    /// Surfaces are tilted about x and then about y by angles uniform in [−`largest_tilt`, `largest_tilt`), in radians, below a right angle.
    /// Default π/6.
    pub largest_tilt: f64,
    /// Standard deviation of the starts about "ready" in each joint, in radians. Default 0.1.
    pub start_deviation: f64,
    /// Flat contact: standard deviation of the displacement of each joint from the start on the surface, in radians. Default 0.03.
    pub off_surface: f64,
    /// Flat contact: κ of [`Surface`], in 1/s. Default 2.
    pub task_rate: f64,
    /// Number of trajectories K. Default 50.
    pub n_trajectories: usize,
    /// Parameters of the simulation. Default 100 samples at 20 Hz, one Euler step from one to the next.
    pub roll_out: RollOut,
}

impl Wiping {
    /// The arm given by the text of a URDF with seven joints and a link `tool`.
    ///
    /// # Errors
    /// [`DemoGenError::Robot`] for a URDF that cannot be read, [`DemoGenError::Joints`] for another number of joints.
    pub fn new(urdf: &str, contact: Contact) -> Result<Self, DemoGenError> {
        let robot = RobotModel::from_urdf(urdf)?;
        if robot.n_joints() != READY.len() {
            return Err(DemoGenError::Joints { found: robot.n_joints(), expected: READY.len() });
        }
        let tool = robot.chain(robot.link("tool")?);
        let (posture, centre) = (DVector::from_row_slice(&READY), Vector3::new(0.55, 0.0, 0.4));
        let policy = WipingPolicy { tool, centre, radius: 0.15, rate: 1.0, posture, posture_rate: 0.5 };
        Ok(Wiping {
            policy,
            robot,
            contact,
            largest_tilt: std::f64::consts::FRAC_PI_6,
            start_deviation: 0.1,
            off_surface: 0.03,
            task_rate: 2.0,
            n_trajectories: 50,
            roll_out: RollOut { time_step: 0.05, n_samples: 100, sub_steps: 1 },
        })
    }

    /// The robot.
    pub fn robot(&self) -> &RobotModel {
        &self.robot
    }

    /// The joints that lead to its tool.
    pub fn tool(&self) -> &Chain {
        &self.policy.tool
    }

    /// One data set. For each trajectory, draws from the generator both tilts, the start, joint by joint, and, for flat
    /// contact, its displacement.
    ///
    /// # Errors
    /// [`DemoGenError::Tilt`], [`DemoGenError::Deviation`], [`DemoGenError::TaskRate`], [`DemoGenError::NoTrajectory`], or
    /// [`DemoGenError::InTrajectory`] with those of [`RollOut::record`].
    pub fn record<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<Recording>, DemoGenError> {
        self.check()?;
        record_each(self.n_trajectories, || self.record_one(rng))
    }

    fn record_one<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Recording, DemoGenError> {
        let mut tilt = || self.largest_tilt * rng.random_range(-1.0..1.0);
        let (about_x, about_y) = (tilt(), tilt());
        let normal = Rotation3::from_euler_angles(about_x, about_y, 0.0) * Vector3::z();
        let start = &self.policy.posture + scatter(self.start_deviation, rng);
        let actor = Actor::OfPolicy(&self.policy);
        match self.contact {
            Contact::Height => {
                let constraint = hand_in_plane(&self.robot, &self.policy.tool, normal)?;
                self.roll_out.recording(&System::constrained(actor, &constraint), start.as_view())
            }
            Contact::Flat => {
                let surface =
                    Surface::new(self.policy.tool.clone(), READY.len(), normal, self.policy.centre, self.task_rate);
                let start = self.on(&surface, start)? + scatter(self.off_surface, rng);
                self.roll_out.recording(&System::with_task(actor, &surface), start.as_view())
            }
        }
    }

    /// The start, moved onto the surface by Newton's method: b = 0.
    fn on(&self, surface: &Surface, mut start: DVector<f64>) -> Result<DVector<f64>, DemoGenError> {
        let at_start = |source: ConstraintError| DemoGenError::Constraint { sample: 0, source };
        for _ in 0..STEPS_TO_SURFACE {
            start += surface.task_velocity(start.as_view(), 0.0).map_err(at_start)? / self.task_rate;
        }
        Ok(start)
    }

    fn check(&self) -> Result<(), DemoGenError> {
        let tilt = self.largest_tilt;
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&tilt) {
            return Err(DemoGenError::Tilt { largest: tilt });
        }
        for (name, value) in
            [("start deviation", self.start_deviation), ("deviation off the surface", self.off_surface)]
        {
            if !(value.is_finite() && value >= 0.0) {
                return Err(DemoGenError::Deviation { name, value });
            }
        }
        let rate = self.task_rate;
        if rate.is_finite() && rate > 0.0 { Ok(()) } else { Err(DemoGenError::TaskRate { rate }) }
    }
}

/// Random displacements of all joints, (n).
fn scatter<R: Rng + ?Sized>(deviation: f64, rng: &mut R) -> DVector<f64> {
    DVector::from_fn(READY.len(), |_, _| deviation * rng.sample::<f64, _>(StandardNormal))
}
