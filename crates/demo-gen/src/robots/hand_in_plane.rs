use nalgebra::{DVector, Vector3};
use rand::{Rng, RngExt};
use rand_distr::UnitSphere;
use serde::Serialize;

use crate::recording::record_each;
use crate::robots::hand::hand_in_plane;
use crate::{DemoGenError, Parabola, Recording, RollOut, Side, UpperBody};

/// The humanoid of Section 4.3, which moves all its joints while one hand, left or right at random, stays in a plane. Each
/// trajectory has a different normal, uniformly distributed on the sphere.
///
/// Starts are [`UpperBody::start`]s. As in the paper, the movements ignore joint limits and collisions;
/// [`n_leaving_limits`](crate::n_leaving_limits) counts those that leave the limits.
#[derive(Debug, Clone, Serialize)]
pub struct HandInPlane {
    /// The robot. It is not serialised with the rest; its URDF describes it.
    #[serde(skip)]
    pub body: UpperBody,
    /// φ. The paper has w = 0.05; the default's centre is 0: upright, with hanging arms.
    pub potential: Parabola,
    /// Variance of each coordinate of the starts around "ready", in rad² or m². Default 0.1.
    pub start_variance: f64,
    /// Number of trajectories K. Default 100.
    pub n_trajectories: usize,
    /// Parameters of the simulation. Default 100 samples, 0.5 s apart, plain Euler.
    pub roll_out: RollOut,
}

impl HandInPlane {
    /// The set-up of Section 4.3.
    pub fn new(body: UpperBody) -> Self {
        let potential = Parabola { weight: 0.05, centre: DVector::zeros(body.robot().n_joints()) };
        let roll_out = RollOut { time_step: 0.5, n_samples: 100, ..RollOut::default() };
        HandInPlane { body, potential, start_variance: 0.1, n_trajectories: 100, roll_out }
    }

    /// One data set.
    ///
    /// For each trajectory, draws from the generator the start, the side, and the normal.
    ///
    /// # Errors
    /// [`DemoGenError::NoTrajectory`], or [`DemoGenError::InTrajectory`] with those of [`UpperBody::start`] and
    /// [`RollOut::record`].
    pub fn record<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<Recording>, DemoGenError> {
        record_each(self.n_trajectories, || {
            let start = self.body.start(self.start_variance, rng)?;
            let side = if rng.random() { Side::Left } else { Side::Right };
            let normal = Vector3::from(rng.sample::<[f64; 3], _>(UnitSphere));
            let constraint = hand_in_plane(self.body.robot(), self.body.palm(side), normal)?;
            self.roll_out.record(&self.potential, &constraint, start.as_view())
        })
    }
}
