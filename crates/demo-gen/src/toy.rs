use constraints::{LinearConstraint, Switching};
use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use serde::Serialize;

use crate::recording::{check_start_range, record_each};
use crate::{DemoGenError, Recording, Redraw, RollOut, ToyPotential};

impl Redraw {
    /// Indices of the samples at which a new constraint begins.
    pub(crate) fn first_samples(self, n_samples: usize) -> Result<Vec<usize>, DemoGenError> {
        match self {
            Redraw::Every(samples) if samples > 0 => Ok((0..n_samples).step_by(samples).collect()),
            Redraw::Segments(segments) if (1..=n_samples).contains(&segments) => {
                Ok((0..segments).map(|segment| segment * n_samples / segments).collect())
            }
            redraw => Err(DemoGenError::Redraw { redraw, n_samples }),
        }
    }
}

/// The toy system of Section 4.1: a point on the plane that follows a potential. Each trajectory is subject to random linear
/// constraints αᵀu = 0, α ~ N(0, I₂), that change along the way.
///
/// ```
/// use demo_gen::{ToyPotential, ToySystem, demonstrations};
/// use rand::SeedableRng;
///
/// let system = ToySystem { potential: ToyPotential::sinusoidal(), n_samples: 100, ..ToySystem::default() };
/// let recordings = system.record(&mut rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
/// let demonstrations = demonstrations(&recordings)?;
/// assert_eq!((demonstrations.n_trajectories(), demonstrations.n_samples()), (40, 4000));
/// # Ok::<(), demo_gen::DemoGenError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ToySystem {
    /// φ. Default [`ToyPotential::parabola`].
    pub potential: ToyPotential,
    /// Number of trajectories K. Default 40.
    pub n_trajectories: usize,
    /// Samples of each trajectory, N. Default 40.
    pub n_samples: usize,
    /// When the constraint changes. Default every 20 samples.
    pub redraw: Redraw,
    /// Starts are uniform in [−`start_range`, `start_range`)². Default 2, the axes of the paper's Figure 5.
    pub start_range: f64,
    /// Time between two samples, δt in seconds. Default 1, with which the paper's (9) needs no δt.
    pub time_step: f64,
}

impl Default for ToySystem {
    fn default() -> Self {
        ToySystem {
            potential: ToyPotential::parabola(),
            n_trajectories: 40,
            n_samples: 40,
            redraw: Redraw::Every(20),
            start_range: 2.0,
            time_step: 1.0,
        }
    }
}

impl ToySystem {
    /// One data set: K movements.
    ///
    /// For each trajectory, draws from the generator the start x₁, x₂ and then the α of each constraint
    /// in order of time, so that the same seed gives the same bits, and a longer data set begins like a shorter one.
    ///
    /// # Errors
    /// [`DemoGenError::NoTrajectory`], [`DemoGenError::TooFewSamples`], [`DemoGenError::Redraw`],
    /// [`DemoGenError::StartRange`], or [`DemoGenError::InTrajectory`] with those of [`RollOut::record`].
    pub fn record<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<Recording>, DemoGenError> {
        let roll_out = RollOut { n_samples: self.n_samples, time_step: self.time_step, ..RollOut::default() };
        roll_out.check()?;
        check_start_range(self.start_range)?;
        let first_samples = self.redraw.first_samples(self.n_samples)?;
        record_each(self.n_trajectories, || self.record_one(&roll_out, &first_samples, rng))
    }

    fn record_one<R: Rng + ?Sized>(
        &self,
        roll_out: &RollOut,
        first_samples: &[usize],
        rng: &mut R,
    ) -> Result<Recording, DemoGenError> {
        let start = DVector::from_fn(2, |_, _| self.start_range * rng.random_range(-1.0..1.0));
        let in_constraint = |sample| move |source| DemoGenError::Constraint { sample, source };
        let phases = first_samples.iter().map(|&sample| {
            let alpha = DMatrix::from_fn(1, 2, |_, _| rng.sample(StandardNormal));
            let constraint = LinearConstraint::new(alpha).map_err(in_constraint(sample))?;
            Ok((roll_out.time_step * sample as f64, constraint))
        });
        let phases = phases.collect::<Result<_, DemoGenError>>()?;
        let constraint = Switching::new(phases).map_err(in_constraint(0))?;
        roll_out.record(&self.potential, &constraint, start.as_view())
    }
}
