use nalgebra::{DMatrix, DVectorView};

use crate::{ConstraintError, NullSpaceProjector};

/// A constraint A(x,t) u = 0 on the velocity u (2), which may change with state and time, in number of rows too.
///
/// A hand on a plane is the one row nᵀJ(x), an obstacle a row that is there only where it touches: both are a type
/// that holds what it needs (a Jacobian function, a position) and answers [`PfaffianConstraint::matrix`]:
///
/// ```
/// use constraints::PfaffianConstraint;
/// use nalgebra::{DMatrix, DVectorView, dmatrix, dvector};
///
/// /// A hand that must stay at its height: the second row of its Jacobian.
/// struct AtItsHeight<J> {
///     n_joints: usize,
///     hand_jacobian: J,
/// }
///
/// impl<J: Fn(DVectorView<'_, f64>) -> DMatrix<f64> + Send + Sync> PfaffianConstraint for AtItsHeight<J> {
///     fn n_states(&self) -> usize {
///         self.n_joints
///     }
///
///     fn matrix(&self, state: DVectorView<'_, f64>, _time: f64) -> DMatrix<f64> {
///         (self.hand_jacobian)(state).rows(1, 1).into_owned()
///     }
/// }
///
/// // Two links of length 1 in the plane.
/// let hand_jacobian = |q: DVectorView<'_, f64>| {
///     let (a, b) = (q[0], q[0] + q[1]);
///     dmatrix![-a.sin() - b.sin(), -b.sin(); a.cos() + b.cos(), b.cos()]
/// };
/// let constraint = AtItsHeight { n_joints: 2, hand_jacobian };
/// let q = dvector![0.4, 0.9];
/// let free = constraint.null_space_projector(q.as_view(), 0.0)?.project(dvector![1.0, 0.0].as_view());
/// let hand_velocity = hand_jacobian(q.as_view()) * free;
/// assert!(hand_velocity[1].abs() < 1e-15 && hand_velocity[0].abs() > 0.1);
/// # Ok::<(), constraints::ConstraintError>(())
/// ```
pub trait PfaffianConstraint: Send + Sync {
    /// Dimension n of the state.
    fn n_states(&self) -> usize;

    /// A(x,t), (k, n), at a state (n) and a time in seconds. k may be 0, may exceed n, and rows may depend on each
    /// other; the rows' units and lengths do not matter.
    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> DMatrix<f64>;

    /// N(x,t) = I − A⁺A (3), with the [default tolerance](NullSpaceProjector::DEFAULT_TOLERANCE).
    ///
    /// # Errors
    /// [`ConstraintError::Columns`] when A does not have n columns, otherwise as [`NullSpaceProjector::new`].
    fn null_space_projector(
        &self,
        state: DVectorView<'_, f64>,
        time: f64,
    ) -> Result<NullSpaceProjector, ConstraintError> {
        let matrix = self.matrix(state, time);
        if matrix.ncols() != self.n_states() {
            return Err(ConstraintError::Columns { found: matrix.ncols(), expected: self.n_states() });
        }
        NullSpaceProjector::new(&matrix)
    }
}

/// No constraint: A has no rows, N = I.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unconstrained {
    /// Dimension n of the state.
    pub n_states: usize,
}

impl PfaffianConstraint for Unconstrained {
    fn n_states(&self) -> usize {
        self.n_states
    }

    fn matrix(&self, _state: DVectorView<'_, f64>, _time: f64) -> DMatrix<f64> {
        DMatrix::zeros(0, self.n_states)
    }
}

impl<C: PfaffianConstraint + ?Sized> PfaffianConstraint for &C {
    fn n_states(&self) -> usize {
        (**self).n_states()
    }

    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> DMatrix<f64> {
        (**self).matrix(state, time)
    }

    fn null_space_projector(
        &self,
        state: DVectorView<'_, f64>,
        time: f64,
    ) -> Result<NullSpaceProjector, ConstraintError> {
        (**self).null_space_projector(state, time)
    }
}

impl<C: PfaffianConstraint + ?Sized> PfaffianConstraint for Box<C> {
    fn n_states(&self) -> usize {
        (**self).n_states()
    }

    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> DMatrix<f64> {
        (**self).matrix(state, time)
    }

    fn null_space_projector(
        &self,
        state: DVectorView<'_, f64>,
        time: f64,
    ) -> Result<NullSpaceProjector, ConstraintError> {
        (**self).null_space_projector(state, time)
    }
}
