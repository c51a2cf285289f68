use constraints::{PfaffianConstraint, Switching, Unconstrained};
use nalgebra::DVector;
use rand::{Rng, RngExt};
use serde::Serialize;

use super::policy_kind::{Field, Scene};
use super::{DriftingConstraint, PolicyKind};
use crate::instant::{Actor, System};
use crate::recording::record_each;
use crate::{DemoGenError, Recording, Redraw, RollOut};

/// The constraints on the movements of a data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum ConstraintKind {
    /// No movement is constrained.
    Free,
    /// Every movement has separate constraints.
    Varying,
    /// All movements share the same constraint, all the time.
    OneForAll,
    /// Every second movement has separate constraints; the first is free.
    HalfFree,
}

/// Movements unlike the paper's examples: other policies, in 2 to 22 dimensions, under random
/// constraints that turn with the state ([`DriftingConstraint`], about one forbidden direction in four).
///
/// ```
/// use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind};
/// use rand::SeedableRng;
///
/// let system = BeyondSystem { policy: PolicyKind::Wells { dim: 3 }, n_trajectories: 10, ..BeyondSystem::default() };
/// let recordings = system.record(&mut rand_chacha::ChaCha8Rng::seed_from_u64(1))?;
/// assert_eq!(recordings[9].observed.states().shape(), (3, 40));
/// assert_eq!(recordings[9].truth.projectors[0].rank(), 1);
/// # Ok::<(), demo_gen::DemoGenError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BeyondSystem {
    /// The policy. Default three wells in three dimensions.
    #[serde(rename = "shown")] // in stored records
    pub policy: PolicyKind,
    /// Default [`ConstraintKind::Varying`].
    #[serde(rename = "hindrance")] // in stored records
    pub constraint: ConstraintKind,
    /// Number of trajectories K. Default 60.
    pub n_trajectories: usize,
    /// When a movement's separate constraint changes. Default every 20 samples.
    pub redraw: Redraw,
    /// Samples, time step and sub-steps. Default 40 samples at intervals of one second, with 50 Euler steps between two.
    pub roll_out: RollOut,
}

impl Default for BeyondSystem {
    fn default() -> Self {
        BeyondSystem {
            policy: PolicyKind::Wells { dim: 3 },
            constraint: ConstraintKind::Varying,
            n_trajectories: 60,
            redraw: Redraw::Every(20),
            roll_out: RollOut { sub_steps: 50, ..RollOut::default() },
        }
    }
}

impl BeyondSystem {
    /// One data set: K movements of one policy from starts in a cube.
    ///
    /// Draws from the generator the policy, the shared constraint, and then for each trajectory the start and its constraints
    /// in order of time. `truth.potential` is empty if the policy has no potential.
    ///
    /// # Errors
    /// [`DemoGenError::TooFewDimensions`], [`DemoGenError::Edge`], [`DemoGenError::NoTrajectory`],
    /// [`DemoGenError::Redraw`], or those of [`RollOut::record`].
    pub fn record<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<Vec<Recording>, DemoGenError> {
        self.policy.check()?;
        self.roll_out.check()?;
        let first_samples = self.redraw.first_samples(self.roll_out.n_samples)?;
        let scene = self.policy.draw(rng);
        let shared = self.draw_constraint(rng);
        let mut trajectory = 0;
        record_each(self.n_trajectories, || {
            let start = scene.start(rng);
            let own = self.constraint == ConstraintKind::Varying
                || self.constraint == ConstraintKind::HalfFree && trajectory % 2 == 1;
            trajectory += 1;
            if own {
                let phases = first_samples
                    .iter()
                    .map(|&sample| (self.roll_out.time_step * sample as f64, self.draw_constraint(rng)));
                let constraint = Switching::new(phases.collect())
                    .map_err(|source| DemoGenError::Constraint { sample: 0, source })?;
                return scene.record(&self.roll_out, &constraint, &start);
            }
            match self.constraint {
                ConstraintKind::OneForAll => scene.record(&self.roll_out, &shared, &start),
                _ => scene.record(&self.roll_out, &Unconstrained { dim: self.policy.dim() }, &start),
            }
        })
    }

    fn draw_constraint<R: Rng + ?Sized>(&self, rng: &mut R) -> DriftingConstraint {
        let dim = self.policy.dim();
        DriftingConstraint::draw(dim.div_ceil(4), dim, rng)
    }
}

impl Scene {
    fn start<R: Rng + ?Sized>(&self, rng: &mut R) -> DVector<f64> {
        let from_middle = self.middle.iter().map(|middle| middle + rng.random_range(-self.half_width..self.half_width));
        DVector::from_iterator(self.middle.len(), from_middle)
    }

    fn record(
        &self,
        roll_out: &RollOut,
        constraint: &dyn PfaffianConstraint,
        start: &DVector<f64>,
    ) -> Result<Recording, DemoGenError> {
        let actor = match &self.field {
            Field::OfPotential(potential) => Actor::OfPotential(&**potential),
            Field::OfPolicy(policy) => Actor::OfPolicy(&**policy),
        };
        roll_out.recording(&System::constrained(actor, constraint), start.as_view())
    }
}
