use constraints::{NullSpaceProjector, PfaffianConstraint};
use motion::{Policy, Potential, Trajectory};
use nalgebra::{DMatrix, DVector, DVectorView};

use crate::{DemoGenError, Quantity, Recording, Truth};

/// Who acts, and what constrains it.
pub(crate) struct System<'a, D, C: ?Sized> {
    pub(crate) actor: D,
    pub(crate) constraint: &'a C,
}

/// A policy, and what is known of its potential.
pub(crate) trait Actor {
    /// The potential's value at a state; nothing for a policy that may have none.
    type Potential;

    fn dim(&self) -> usize;

    /// The action at a state (n) and the potential there, both finite; errors name `sample`.
    fn act(&self, state: DVectorView<'_, f64>, sample: usize) -> Result<(DVector<f64>, Self::Potential), DemoGenError>;
}

/// The policy −∇φ of a potential.
pub(crate) struct OfPotential<'a, P: ?Sized>(pub(crate) &'a P);

/// A policy of which no potential is known.
pub(crate) struct OfPolicy<'a, P: ?Sized>(pub(crate) &'a P);

impl<P: Potential + ?Sized> Actor for OfPotential<'_, P> {
    type Potential = f64;

    fn dim(&self) -> usize {
        self.0.dim()
    }

    fn act(&self, state: DVectorView<'_, f64>, sample: usize) -> Result<(DVector<f64>, f64), DemoGenError> {
        let value = self.0.value(state);
        finite(&[value], Quantity::Potential, sample)?;
        let action = -self.0.gradient(state);
        finite(action.as_slice(), Quantity::Policy, sample)?;
        Ok((action, value))
    }
}

impl<P: Policy + ?Sized> Actor for OfPolicy<'_, P> {
    type Potential = ();

    fn dim(&self) -> usize {
        self.0.dim()
    }

    fn act(&self, state: DVectorView<'_, f64>, sample: usize) -> Result<(DVector<f64>, ()), DemoGenError> {
        let action = self.0.action(state);
        finite(action.as_slice(), Quantity::Policy, sample)?;
        Ok((action, ()))
    }
}

/// Everything that is true of the system at one time. All of it is finite.
pub(crate) struct Instant<T> {
    pub(crate) state: DVector<f64>,
    pub(crate) velocity: DVector<f64>,
    potential: T,
    action: DVector<f64>,
    projector: NullSpaceProjector,
}

impl<D: Actor, C: PfaffianConstraint + ?Sized> System<'_, D, C> {
    /// The system in `state` at `time`; errors name `sample`.
    pub(crate) fn instant(
        &self,
        state: DVector<f64>,
        time: f64,
        sample: usize,
    ) -> Result<Instant<D::Potential>, DemoGenError> {
        finite(state.as_slice(), Quantity::State, sample)?;
        let (action, potential) = self.actor.act(state.as_view(), sample)?;
        let projector = self
            .constraint
            .null_space_projector(state.as_view(), time)
            .map_err(|source| DemoGenError::Constraint { sample, source })?;
        let velocity = projector.project(action.as_view());
        finite(velocity.as_slice(), Quantity::Velocity, sample)?;
        Ok(Instant { state, velocity, potential, action, projector })
    }
}

fn finite(values: &[f64], quantity: Quantity, sample: usize) -> Result<(), DemoGenError> {
    let all = values.iter().all(|value| value.is_finite());
    if all { Ok(()) } else { Err(DemoGenError::Diverged { sample, quantity }) }
}

/// What an observer sees of two or more instants, `time_step` seconds apart.
pub(crate) fn observed<T>(instants: &[Instant<T>], time_step: f64) -> Result<Trajectory, DemoGenError> {
    let states = columns(instants, |instant| &instant.state);
    Ok(Trajectory::new(states, time_step)?.with_velocities(columns(instants, |instant| &instant.velocity))?)
}

impl Recording {
    /// The recording of a movement at two or more instants, `time_step` seconds apart.
    pub(crate) fn of(instants: Vec<Instant<f64>>, time_step: f64) -> Result<Recording, DemoGenError> {
        let observed = observed(&instants, time_step)?;
        let states = columns(&instants, |instant| &instant.state);
        let actions = columns(&instants, |instant| &instant.action);
        let potential = DVector::from_iterator(instants.len(), instants.iter().map(|instant| instant.potential));
        let projectors = instants.into_iter().map(|instant| instant.projector).collect();
        Ok(Recording { observed, truth: Truth { states, potential, actions, projectors } })
    }
}

fn columns<T>(instants: &[Instant<T>], part: fn(&Instant<T>) -> &DVector<f64>) -> DMatrix<f64> {
    let dim = instants.first().map_or(0, |instant| instant.state.len());
    let values = instants.iter().flat_map(|instant| part(instant).iter().copied());
    DMatrix::from_iterator(dim, instants.len(), values)
}
