use nalgebra::{DMatrix, DVectorView};

use crate::{ConstraintError, NullSpaceProjector};

/// A constraint A(x,t) u = 0 on the velocity u (2). A may change with state and time, including its number of rows.
///
/// An obstacle is a row that exists only during contact: a type that implements [`PfaffianConstraint::matrix`]. For a
/// hand in a plane or on a line there is [`PointConstraint`](crate::PointConstraint).
///
/// ```
/// use constraints::{ConstraintError, PfaffianConstraint};
/// use nalgebra::{DMatrix, DVectorView, dvector};
///
/// /// A point on the plane that slides along a wall from the moment it is there.
/// struct Wall {
///     at: f64,
/// }
///
/// impl PfaffianConstraint for Wall {
///     fn dim(&self) -> usize {
///         2
///     }
///
///     fn matrix(&self, state: DVectorView<'_, f64>, _time: f64) -> Result<DMatrix<f64>, ConstraintError> {
///         let n_rows = usize::from(state[0] >= self.at);
///         Ok(DMatrix::from_fn(n_rows, 2, |_, column| if column == 0 { 1.0 } else { 0.0 }))
///     }
/// }
///
/// let (wall, wanted) = (Wall { at: 1.0 }, dvector![2.0, 3.0]);
/// let before = wall.null_space_projector(dvector![0.5, 0.0].as_view(), 0.0)?.project(wanted.as_view());
/// let there = wall.null_space_projector(dvector![1.0, 0.0].as_view(), 0.0)?.project(wanted.as_view());
/// assert_eq!((before, there), (dvector![2.0, 3.0], dvector![0.0, 3.0]));
/// # Ok::<(), constraints::ConstraintError>(())
/// ```
pub trait PfaffianConstraint: Send + Sync {
    /// Dimension n of the state.
    fn dim(&self) -> usize;

    /// A(x,t), (k, n), at a state (n) and a time in seconds. k may be 0 or exceed n, and rows may be linearly dependent;
    /// the rows' units and lengths do not matter.
    ///
    /// # Errors
    /// [`ConstraintError::State`] or [`ConstraintError::Jacobian`] if A cannot be computed.
    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError>;

    /// N(x,t) = I − A⁺A (3), with the [default tolerance](NullSpaceProjector::DEFAULT_TOLERANCE).
    ///
    /// # Errors
    /// Those of [`PfaffianConstraint::matrix`], [`ConstraintError::Columns`] if A does not have n columns, otherwise as
    /// [`NullSpaceProjector::new`].
    fn null_space_projector(
        &self,
        state: DVectorView<'_, f64>,
        time: f64,
    ) -> Result<NullSpaceProjector, ConstraintError> {
        let matrix = self.matrix(state, time)?;
        if matrix.ncols() != self.dim() {
            return Err(ConstraintError::Columns { found: matrix.ncols(), expected: self.dim() });
        }
        NullSpaceProjector::new(&matrix)
    }
}

/// No constraint: A has no rows, N = I.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unconstrained {
    /// Dimension n of the state.
    pub dim: usize,
}

impl PfaffianConstraint for Unconstrained {
    fn dim(&self) -> usize {
        self.dim
    }

    fn matrix(&self, _state: DVectorView<'_, f64>, _time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        Ok(DMatrix::zeros(0, self.dim))
    }
}

/// Implements the trait for pointers to constraints.
macro_rules! behind {
    ($($pointer:ty),*) => {$(
        impl<C: PfaffianConstraint + ?Sized> PfaffianConstraint for $pointer {
            fn dim(&self) -> usize {
                (**self).dim()
            }

            fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError> {
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
    )*};
}

behind!(&C, Box<C>);
