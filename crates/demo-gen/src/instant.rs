use constraints::{NullSpaceProjector, PfaffianConstraint};
use motion::{Potential, Trajectory};
use nalgebra::{DMatrix, DVector};

use crate::{DemoGenError, Quantity, Recording, Truth};

/// What wants to move, and what hinders it.
pub(crate) struct System<'a, P: ?Sized, C: ?Sized> {
    pub(crate) potential: &'a P,
    pub(crate) constraint: &'a C,
}

/// Everything that is true of the system at one time. All of it is finite.
pub(crate) struct Instant {
    pub(crate) state: DVector<f64>,
    pub(crate) velocity: DVector<f64>,
    potential: f64,
    action: DVector<f64>,
    projector: NullSpaceProjector,
}

impl<P: Potential + ?Sized, C: PfaffianConstraint + ?Sized> System<'_, P, C> {
    /// The system in `state` at `time`; errors name `sample`.
    pub(crate) fn instant(&self, state: DVector<f64>, time: f64, sample: usize) -> Result<Instant, DemoGenError> {
        let finite = |values: &[f64], quantity| {
            let all = values.iter().all(|value| value.is_finite());
            if all { Ok(()) } else { Err(DemoGenError::Diverged { sample, quantity }) }
        };
        finite(state.as_slice(), Quantity::State)?;
        let potential = self.potential.value(state.as_view());
        finite(&[potential], Quantity::Potential)?;
        let action = -self.potential.gradient(state.as_view());
        finite(action.as_slice(), Quantity::Policy)?;
        let projector = self
            .constraint
            .null_space_projector(state.as_view(), time)
            .map_err(|source| DemoGenError::Constraint { sample, source })?;
        let velocity = projector.project(action.as_view());
        finite(velocity.as_slice(), Quantity::Velocity)?;
        Ok(Instant { state, velocity, potential, action, projector })
    }
}

impl Recording {
    /// The recording of a movement at two or more instants, `time_step` seconds apart.
    pub(crate) fn of(instants: Vec<Instant>, time_step: f64) -> Result<Recording, DemoGenError> {
        let (n_states, n_samples) = (instants.first().map_or(0, |instant| instant.state.len()), instants.len());
        let columns = |part: fn(&Instant) -> &DVector<f64>| {
            DMatrix::from_iterator(
                n_states,
                n_samples,
                instants.iter().flat_map(|instant| part(instant).iter().copied()),
            )
        };
        let states = columns(|instant| &instant.state);
        let velocities = columns(|instant| &instant.velocity);
        let actions = columns(|instant| &instant.action);
        let potential = DVector::from_iterator(n_samples, instants.iter().map(|instant| instant.potential));
        let observed = Trajectory::new(states.clone(), time_step)?.with_velocities(velocities)?;
        let projectors = instants.into_iter().map(|instant| instant.projector).collect();
        Ok(Recording { observed, truth: Truth { states, potential, actions, projectors } })
    }
}
