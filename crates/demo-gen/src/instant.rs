use constraints::{NullSpaceProjector, PfaffianConstraint};
use motion::{Policy, Potential, Trajectory};
use nalgebra::{DMatrix, DVector, DVectorView};

use crate::{DemoGenError, Quantity, Recording, Truth};

/// What wants to move, and what hinders it.
pub(crate) struct System<'a, D, C: ?Sized> {
    pub(crate) driver: D,
    pub(crate) constraint: &'a C,
}

/// What wants to move.
pub(crate) trait Driver {
    /// What it tells of a state besides its action.
    type Told;

    fn dim(&self) -> usize;

    /// The action at a state (n), and what else is told of it, all finite; errors name `sample`.
    fn drive(&self, state: DVectorView<'_, f64>, sample: usize) -> Result<(DVector<f64>, Self::Told), DemoGenError>;
}

/// A potential drives downhill, and tells its value.
pub(crate) struct Downhill<'a, P: ?Sized>(pub(crate) &'a P);

/// A policy drives as it says.
pub(crate) struct AsTold<'a, P: ?Sized>(pub(crate) &'a P);

impl<P: Potential + ?Sized> Driver for Downhill<'_, P> {
    type Told = f64;

    fn dim(&self) -> usize {
        self.0.dim()
    }

    fn drive(&self, state: DVectorView<'_, f64>, sample: usize) -> Result<(DVector<f64>, f64), DemoGenError> {
        let value = self.0.value(state);
        finite(&[value], Quantity::Potential, sample)?;
        let action = -self.0.gradient(state);
        finite(action.as_slice(), Quantity::Policy, sample)?;
        Ok((action, value))
    }
}

impl<P: Policy + ?Sized> Driver for AsTold<'_, P> {
    type Told = ();

    fn dim(&self) -> usize {
        self.0.dim()
    }

    fn drive(&self, state: DVectorView<'_, f64>, sample: usize) -> Result<(DVector<f64>, ()), DemoGenError> {
        let action = self.0.action(state);
        finite(action.as_slice(), Quantity::Policy, sample)?;
        Ok((action, ()))
    }
}

/// Everything that is true of the system at one time. All of it is finite.
pub(crate) struct Instant<T> {
    pub(crate) state: DVector<f64>,
    pub(crate) velocity: DVector<f64>,
    told: T,
    action: DVector<f64>,
    projector: NullSpaceProjector,
}

impl<D: Driver, C: PfaffianConstraint + ?Sized> System<'_, D, C> {
    /// The system in `state` at `time`; errors name `sample`.
    pub(crate) fn instant(
        &self,
        state: DVector<f64>,
        time: f64,
        sample: usize,
    ) -> Result<Instant<D::Told>, DemoGenError> {
        finite(state.as_slice(), Quantity::State, sample)?;
        let (action, told) = self.driver.drive(state.as_view(), sample)?;
        let projector = self
            .constraint
            .null_space_projector(state.as_view(), time)
            .map_err(|source| DemoGenError::Constraint { sample, source })?;
        let velocity = projector.project(action.as_view());
        finite(velocity.as_slice(), Quantity::Velocity, sample)?;
        Ok(Instant { state, velocity, told, action, projector })
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
        let potential = DVector::from_iterator(instants.len(), instants.iter().map(|instant| instant.told));
        let projectors = instants.into_iter().map(|instant| instant.projector).collect();
        Ok(Recording { observed, truth: Truth { states, potential, actions, projectors } })
    }
}

fn columns<T>(instants: &[Instant<T>], part: fn(&Instant<T>) -> &DVector<f64>) -> DMatrix<f64> {
    let dim = instants.first().map_or(0, |instant| instant.state.len());
    let values = instants.iter().flat_map(|instant| part(instant).iter().copied());
    DMatrix::from_iterator(dim, instants.len(), values)
}
