use kinematics::RobotModel;
use nalgebra::{DVector, Vector3};
use rand::{Rng, RngExt};
use rand_distr::UnitCircle;
use serde::Serialize;

use crate::recording::{check_start_range, record_each};
use crate::robots::hand::hand_in_plane;
use crate::{DemoGenError, Parabola, Recording, RollOut};

/// The planar arm of Section 4.4, whose constraints all hide the same direction: in each trajectory the link
/// `hand` stays on a line in the plane z = 0, with a normal uniform on the circle.
///
/// ```
/// use demo_gen::{ThreeLinkArm, demonstrations};
/// use rand::SeedableRng;
///
/// // The text of a URDF; this one is of two links.
/// let urdf = r#"<robot name="arm"><link name="base"/><link name="upper_arm"/><link name="forearm"/><link name="hand"/>
///   <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper_arm"/><axis xyz="0 0 1"/></joint>
///   <joint name="elbow" type="continuous"><parent link="upper_arm"/><child link="forearm"/>
///     <origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
///   <joint name="tip" type="fixed"><parent link="forearm"/><child link="hand"/><origin xyz="1 0 0"/></joint></robot>"#;
/// let arm = ThreeLinkArm { n_trajectories: 8, ..ThreeLinkArm::new(urdf)? };
/// let recordings = arm.record(&mut rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
/// assert_eq!(demonstrations(&recordings)?.dim(), 2);
/// # Ok::<(), demo_gen::DemoGenError>(())
/// ```
#[derive(Debug, Clone, Serialize)]
pub struct ThreeLinkArm {
    /// The arm, whose link `hand` is constrained. It is not serialised with the rest; its URDF describes it.
    #[serde(skip)]
    pub robot: RobotModel,
    /// φ. The paper has w = 0.05 and centre 0: the arm stretched along x.
    pub potential: Parabola,
    /// Starts are uniform in [−`start_range`, `start_range`) for each joint, in radians. Default 1.
    pub start_range: f64,
    /// Number of trajectories K. Default 100.
    pub n_trajectories: usize,
    /// Parameters of the simulation. Default 100 samples, 0.5 s apart, plain Euler.
    pub roll_out: RollOut,
}

impl ThreeLinkArm {
    /// The paper's set-up, with an arm given by the text of a URDF.
    ///
    /// # Errors
    /// [`DemoGenError::Robot`] for a URDF that cannot be read.
    pub fn new(urdf: &str) -> Result<Self, DemoGenError> {
        let robot = RobotModel::from_urdf(urdf)?;
        let potential = Parabola { weight: 0.05, centre: DVector::zeros(robot.n_joints()) };
        let roll_out = RollOut { time_step: 0.5, n_samples: 100, ..RollOut::default() };
        Ok(ThreeLinkArm { robot, potential, start_range: 1.0, n_trajectories: 100, roll_out })
    }

    /// One data set.
    ///
    /// For each trajectory, draws from the generator the start, joint by joint, and then the normal.
    ///
    /// # Errors
    /// [`DemoGenError::Robot`] without a link `hand`, [`DemoGenError::StartRange`], [`DemoGenError::NoTrajectory`], or
    /// [`DemoGenError::InTrajectory`] with those of [`RollOut::record`].
    pub fn record<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<Recording>, DemoGenError> {
        let range = self.start_range;
        check_start_range(range)?;
        let hand = self.robot.chain(self.robot.link("hand")?);
        record_each(self.n_trajectories, || {
            let start = DVector::from_fn(self.robot.n_joints(), |_, _| range * rng.random_range(-1.0..1.0));
            let [x, y] = rng.sample(UnitCircle);
            let constraint = hand_in_plane(&self.robot, &hand, Vector3::new(x, y, 0.0))?;
            self.roll_out.record(&self.potential, &constraint, start.as_view())
        })
    }
}
