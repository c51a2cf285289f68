use constraints::{NullSpaceProjector, PfaffianConstraint};
use motion::{Policy, Potential, Trajectory};
use nalgebra::{DMatrix, DVector, DVectorView};

use crate::tasks::task_constraint::TaskConstraint;
use crate::{DemoGenError, Quantity, Recording, Truth};

/// A policy and its constraint.
pub(crate) struct System<'a> {
    actor: Actor<'a>,
    constraint: &'a dyn PfaffianConstraint,
    /// The same constraint, if its right side is not 0.
    task: Option<&'a dyn TaskConstraint>,
}

/// A policy, with its potential if that is known.
#[derive(Clone, Copy)]
pub(crate) enum Actor<'a> {
    /// The policy −∇φ of a potential.
    OfPotential(&'a dyn Potential),
    /// A policy without a known potential.
    OfPolicy(&'a dyn Policy),
}

impl Actor<'_> {
    pub(crate) fn dim(self) -> usize {
        match self {
            Actor::OfPotential(potential) => potential.dim(),
            Actor::OfPolicy(policy) => policy.dim(),
        }
    }

    /// The action at a state (n), and the potential there if it is known. All values must be finite; errors name
    /// `sample`.
    fn act(self, state: DVectorView<'_, f64>, sample: usize) -> Result<(DVector<f64>, Option<f64>), DemoGenError> {
        let (action, potential) = match self {
            Actor::OfPotential(potential) => {
                let value = potential.value(state);
                finite(&[value], Quantity::Potential, sample)?;
                (-potential.gradient(state), Some(value))
            }
            Actor::OfPolicy(policy) => (policy.action(state), None),
        };
        finite(action.as_slice(), Quantity::Policy, sample)?;
        Ok((action, potential))
    }
}

/// The complete state of the system at one time. All values are finite.
pub(crate) struct Instant {
    pub(crate) state: DVector<f64>,
    pub(crate) velocity: DVector<f64>,
    potential: Option<f64>,
    action: DVector<f64>,
    projector: NullSpaceProjector,
}

impl<'a> System<'a> {
    /// A system under A(x, t) u = 0.
    pub(crate) fn constrained(actor: Actor<'a>, constraint: &'a dyn PfaffianConstraint) -> Self {
        System { actor, constraint, task: None }
    }

    /// A system under A(x) u = b(x).
    pub(crate) fn with_task(actor: Actor<'a>, task: &'a dyn TaskConstraint) -> Self {
        System { actor, constraint: task, task: Some(task) }
    }

    pub(crate) fn dims(&self) -> (usize, usize) {
        (self.actor.dim(), self.constraint.dim())
    }

    /// The system in `state` at `time`; errors name `sample`.
    pub(crate) fn instant(&self, state: DVector<f64>, time: f64, sample: usize) -> Result<Instant, DemoGenError> {
        finite(state.as_slice(), Quantity::State, sample)?;
        let (action, potential) = self.actor.act(state.as_view(), sample)?;
        let projector = self
            .constraint
            .null_space_projector(state.as_view(), time)
            .map_err(|source| DemoGenError::Constraint { sample, source })?;
        let mut velocity = projector.project(action.as_view());
        if let Some(task) = self.task {
            let demanded = task.task_velocity(state.as_view(), time);
            velocity += demanded.map_err(|source| DemoGenError::Constraint { sample, source })?;
        }
        finite(velocity.as_slice(), Quantity::Velocity, sample)?;
        Ok(Instant { state, velocity, potential, action, projector })
    }
}

fn finite(values: &[f64], quantity: Quantity, sample: usize) -> Result<(), DemoGenError> {
    let all = values.iter().all(|value| value.is_finite());
    if all { Ok(()) } else { Err(DemoGenError::Diverged { sample, quantity }) }
}

/// The observed part of two or more instants, `time_step` seconds apart.
pub(crate) fn observed(instants: &[Instant], time_step: f64) -> Result<Trajectory, DemoGenError> {
    let states = columns(instants, |instant| &instant.state);
    Ok(Trajectory::new(states, time_step)?.with_velocities(columns(instants, |instant| &instant.velocity))?)
}

impl Recording {
    /// The recording of a movement at two or more instants, `time_step` seconds apart.
    pub(crate) fn of(instants: Vec<Instant>, time_step: f64) -> Result<Recording, DemoGenError> {
        let observed = observed(&instants, time_step)?;
        let states = columns(&instants, |instant| &instant.state);
        let actions = columns(&instants, |instant| &instant.action);
        let potential: Vec<f64> = instants.iter().filter_map(|instant| instant.potential).collect();
        let projectors = instants.into_iter().map(|instant| instant.projector).collect();
        Ok(Recording { observed, truth: Truth { states, potential: potential.into(), actions, projectors } })
    }
}

fn columns(instants: &[Instant], part: fn(&Instant) -> &DVector<f64>) -> DMatrix<f64> {
    let dim = instants.first().map_or(0, |instant| instant.state.len());
    let values = instants.iter().flat_map(|instant| part(instant).iter().copied());
    DMatrix::from_iterator(dim, instants.len(), values)
}
