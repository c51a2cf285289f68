use nalgebra::{DVector, Point3};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use serde::Serialize;

use crate::recording::record_each;
use crate::{DemoGenError, GraspScene, Recording, RollOut, UpperBody};

/// Number of successive start postures, none of them natural, after which the scene itself must be at fault.
const MOST_DRAWS: usize = 10_000;

/// Grasping a ball through a wall with a gap (Section 4.2): both palms reach for the ball's sides. The width of the
/// gap varies between trajectories.
///
/// ```
/// use demo_gen::{Grasp, UpperBody};
/// use rand::SeedableRng;
///
/// # let urdf = include_str!("../../../robots/asimo_upper_body.urdf");
/// # let srdf = include_str!("../../../robots/asimo_upper_body.srdf");
/// let grasp = Grasp { n_trajectories: 2, ..Grasp::new(UpperBody::new(urdf, srdf)?) };
/// let recordings = grasp.record(&mut rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
/// assert_eq!((recordings[0].observed.dim(), recordings[0].observed.n_samples()), (6, 100));
/// # Ok::<(), demo_gen::DemoGenError>(())
/// ```
#[derive(Debug, Clone, Serialize)]
pub struct Grasp {
    /// The robot. It is not serialised with the rest; its URDF describes it.
    #[serde(skip)]
    pub body: UpperBody,
    /// Ball, table, wall.
    pub scene: GraspScene,
    /// Parameters of the simulation. Default 100 samples, 0.5 s apart, plain Euler.
    pub roll_out: RollOut,
    /// Number of trajectories K. Default 100.
    pub n_trajectories: usize,
    /// Mean width of the wall's gap, metres. Default 0.25.
    pub gap_mean: f64,
    /// Standard deviation of that width, metres. Default 0.1.
    pub gap_deviation: f64,
    /// Minimum width to which narrower gaps are widened, metres. Default 0.17: the ball fits through with a centimetre on
    /// either side, so that every movement can arrive.
    pub gap_least: f64,
    /// Variance of start postures around "ready", in rad² or m². Default 0.1.
    pub start_variance: f64,
    /// Start palms are before this x, metres. Default: where the wall has no influence.
    pub start_depth: f64,
    /// Each start palm is farther than this from the middle, on its own side, |y| in metres. Default 0.02.
    pub start_side: f64,
}

/// The random values of one trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct GraspStart {
    /// Configuration of the robot, (n).
    pub posture: DVector<f64>,
    /// Its palms, left then right, (6), metres: the start state.
    pub palms: DVector<f64>,
    /// Width of the wall's gap, metres.
    pub gap: f64,
}

impl Grasp {
    /// The set-up of Section 4.2.
    pub fn new(body: UpperBody) -> Self {
        let scene = GraspScene::default();
        let start_depth = scene.wall - scene.wall_influence;
        Grasp {
            body,
            scene,
            roll_out: RollOut { time_step: 0.5, n_samples: 100, ..RollOut::default() },
            n_trajectories: 100,
            gap_mean: 0.25,
            gap_deviation: 0.1,
            gap_least: 0.17,
            start_variance: 0.1,
            start_depth,
            start_side: 0.02,
        }
    }

    /// One data set: K [movements](Self::movement), each from a separate [start](Self::start). A longer data set
    /// begins like a shorter one.
    ///
    /// # Errors
    /// [`DemoGenError::NoTrajectory`], or [`DemoGenError::InTrajectory`] with those of [`Grasp::start`] and
    /// [`Grasp::movement`].
    pub fn record<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<Recording>, DemoGenError> {
        record_each(self.n_trajectories, || self.movement(&self.start(rng)?))
    }

    /// Start posture and gap of one trajectory.
    ///
    /// Draws start postures from the generator like [`UpperBody::start`], until one is natural: palms before the
    /// body and each on its side, none below the table. Then draws the gap.
    ///
    /// # Errors
    /// [`DemoGenError::Gap`], [`DemoGenError::NoNaturalStart`], or those of [`UpperBody::start`].
    pub fn start<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<GraspStart, DemoGenError> {
        let (mean, deviation, least) = (self.gap_mean, self.gap_deviation, self.gap_least);
        let lengths = [deviation, least].iter().all(|length| length.is_finite() && *length >= 0.0);
        if !(mean.is_finite() && lengths) {
            return Err(DemoGenError::Gap { mean, deviation, least });
        }
        for _ in 0..MOST_DRAWS {
            let posture = self.body.start(self.start_variance, rng)?;
            let [left, right] = self.body.palms(posture.as_view())?;
            if self.is_natural(&left, &right) {
                let palms = DVector::from_iterator(6, left.iter().chain(right.iter()).copied());
                let gap = (mean + deviation * rng.sample::<f64, _>(StandardNormal)).max(least);
                return Ok(GraspStart { posture, palms, gap });
            }
        }
        Err(DemoGenError::NoNaturalStart { draws: MOST_DRAWS })
    }

    /// The movement of the palms from a start through its gap.
    ///
    /// # Errors
    /// Those of [`RollOut::record`]; also [`DemoGenError::Constraint`] for an invalid wall.
    pub fn movement(&self, start: &GraspStart) -> Result<Recording, DemoGenError> {
        let wall = self.scene.wall_with_gap(start.gap);
        let wall = wall.map_err(|source| DemoGenError::Constraint { sample: 0, source })?;
        self.roll_out.record(&self.scene.potential(), &wall, start.palms.as_view())
    }

    fn is_natural(&self, left: &Point3<f64>, right: &Point3<f64>) -> bool {
        let near = left.x.max(right.x) < self.start_depth;
        let apart = left.y > self.start_side && right.y < -self.start_side;
        near && apart && !self.scene.is_below_the_table(left) && !self.scene.is_below_the_table(right)
    }
}
