use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::UnitCircle;
use serde::Serialize;

use super::LinearTask;
use crate::beyond::LimitCycle;
use crate::instant::{Actor, System};
use crate::recording::{check_start_range, record_each};
use crate::{DemoGenError, Recording, RollOut};

/// A limit cycle on the plane. Each movement has a separate constant constraint aᵀu = b, with a on the unit circle.
///
/// ```
/// use demo_gen::tasks::CyclesWithTask;
/// use rand::SeedableRng;
///
/// let system = CyclesWithTask { n_trajectories: 3, ..CyclesWithTask::default() };
/// let recordings = system.record(&mut rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
/// // Part of the velocity is not the policy's: u ≠ Nπ.
/// let (truth, velocities) = (&recordings[0].truth, recordings[0].observed.velocities().unwrap());
/// let projected = truth.projectors[0].project(truth.actions.column(0));
/// assert!((velocities.column(0) - projected).norm() > 0.01);
/// # Ok::<(), demo_gen::DemoGenError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CyclesWithTask {
    /// b is uniform in [−`largest_task`, `largest_task`), in units of the state per second; 0 for aᵀu = 0. Default 0.3.
    pub largest_task: f64,
    /// Number of trajectories K. Default 50.
    pub n_trajectories: usize,
    /// Starts are uniform in [−`start_range`, `start_range`)². Default 1.5.
    pub start_range: f64,
    /// Parameters of the simulation. Default 100 samples at 50 Hz, one Euler step from one to the next.
    pub roll_out: RollOut,
}

impl Default for CyclesWithTask {
    fn default() -> Self {
        let roll_out = RollOut { time_step: 0.02, n_samples: 100, sub_steps: 1 };
        CyclesWithTask { largest_task: 0.3, n_trajectories: 50, start_range: 1.5, roll_out }
    }
}

impl CyclesWithTask {
    /// The policy, the same in every data set: once round the unit circle in 2π s.
    pub const POLICY: LimitCycle = LimitCycle { speed: 1.0 };

    /// One data set. For each trajectory, draws from the generator the start x₁, x₂, then a, then b, so that the same seed
    /// gives the same starts and the same a whatever the task.
    ///
    /// # Errors
    /// [`DemoGenError::Task`], [`DemoGenError::StartRange`], [`DemoGenError::NoTrajectory`], or [`DemoGenError::InTrajectory`] with
    /// those of [`RollOut::record`].
    pub fn record<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<Recording>, DemoGenError> {
        check_start_range(self.start_range)?;
        check_task(self.largest_task)?;
        record_each(self.n_trajectories, || self.record_one(rng))
    }

    fn record_one<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Recording, DemoGenError> {
        let start = DVector::from_fn(2, |_, _| self.start_range * rng.random_range(-1.0..1.0));
        let normal = DMatrix::from_row_slice(1, 2, &rng.sample::<[f64; 2], _>(UnitCircle));
        let task = DVector::from_element(1, self.largest_task * rng.random_range(-1.0..1.0));
        let constraint =
            LinearTask::new(normal, task).map_err(|source| DemoGenError::Constraint { sample: 0, source })?;
        self.roll_out.recording(&System::with_task(Actor::OfPolicy(&Self::POLICY), &constraint), start.as_view())
    }
}

fn check_task(largest: f64) -> Result<(), DemoGenError> {
    if largest.is_finite() && largest >= 0.0 { Ok(()) } else { Err(DemoGenError::Task { largest }) }
}
