use nalgebra::{DMatrix, DVectorView};

use crate::{ConstraintError, NullSpaceProjector, PfaffianConstraint, Unconstrained};

/// Constraints that follow each other in time: each holds from its start time (inclusive) until the next one starts.
/// Before the first start there is no constraint.
///
/// For phases of different types use `Switching<Box<dyn PfaffianConstraint>>`.
#[derive(Debug, Clone, PartialEq)]
pub struct Switching<C> {
    dim: usize,
    phases: Vec<(f64, C)>,
}

impl<C: PfaffianConstraint> Switching<C> {
    /// Pairs of start time in seconds and constraint, in order of time.
    ///
    /// # Errors
    /// [`ConstraintError::NoPhase`], [`ConstraintError::StartTime`] or [`ConstraintError::PhaseDimension`].
    pub fn new(phases: Vec<(f64, C)>) -> Result<Self, ConstraintError> {
        let dim = phases.first().ok_or(ConstraintError::NoPhase)?.1.dim();
        let mut previous = f64::NEG_INFINITY;
        for (phase, (start, constraint)) in phases.iter().enumerate() {
            if !(start.is_finite() && *start > previous) {
                return Err(ConstraintError::StartTime { phase, start: *start });
            }
            if constraint.dim() != dim {
                return Err(ConstraintError::PhaseDimension { phase, found: constraint.dim(), expected: dim });
            }
            previous = *start;
        }
        Ok(Switching { dim, phases })
    }

    /// The constraint that holds at `time`; `None` before the first start.
    pub fn at(&self, time: f64) -> Option<&C> {
        let started = self.phases.partition_point(|(start, _)| *start <= time);
        started.checked_sub(1).map(|phase| &self.phases[phase].1)
    }
}

impl<C: PfaffianConstraint> PfaffianConstraint for Switching<C> {
    fn dim(&self) -> usize {
        self.dim
    }

    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        match self.at(time) {
            Some(constraint) => constraint.matrix(state, time),
            None => Unconstrained { dim: self.dim }.matrix(state, time),
        }
    }

    fn null_space_projector(
        &self,
        state: DVectorView<'_, f64>,
        time: f64,
    ) -> Result<NullSpaceProjector, ConstraintError> {
        match self.at(time) {
            Some(constraint) => constraint.null_space_projector(state, time),
            None => Ok(NullSpaceProjector::identity(self.dim)),
        }
    }
}
