use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView, DVectorViewMut};

use crate::ConstraintError;

/// The null-space projector N = I − A⁺A (3) of a constraint matrix A (k, n).
///
/// N depends only on the row space of A. Therefore only an orthonormal basis Q of that space, (n, rank), is stored: N v
/// = v − Q Qᵀv, in 4·n·rank operations, without forming N or A⁺.
#[derive(Debug, Clone, PartialEq)]
pub struct NullSpaceProjector {
    row_space: DMatrix<f64>,
}

impl NullSpaceProjector {
    /// The tolerance of [`NullSpaceProjector::new`]: a thousand times the rounding error of a Jacobian, and far below
    /// any meaningful difference between constraints.
    pub const DEFAULT_TOLERANCE: f64 = 1e-12;

    /// N of the matrix A (k, n) with the [default tolerance](Self::DEFAULT_TOLERANCE). k may be 0 or exceed n.
    ///
    /// # Errors
    /// [`ConstraintError::NotFinite`].
    pub fn new(matrix: &DMatrix<f64>) -> Result<Self, ConstraintError> {
        Self::with_tolerance(matrix, Self::DEFAULT_TOLERANCE)
    }

    /// N of the matrix A (k, n), where `tolerance` is the threshold for rounding errors. It is relative, and is used
    /// twice. First, rows whose largest entry is at most `tolerance` times that of the whole matrix are ignored. Then
    /// all rows are scaled to length 1 and processed one by one, always the one farthest from the span of those before.
    /// A row whose distance to that span is at most `tolerance` does not extend it. As a result, neither c·A nor rows in
    /// other units change N.
    ///
    /// # Errors
    /// [`ConstraintError::NotFinite`], or [`ConstraintError::Tolerance`] unless machine epsilon ≤ `tolerance` < 1.
    pub fn with_tolerance(matrix: &DMatrix<f64>, tolerance: f64) -> Result<Self, ConstraintError> {
        if !(f64::EPSILON..1.0).contains(&tolerance) {
            return Err(ConstraintError::Tolerance { tolerance });
        }
        if let Some(at) = matrix.iter().position(|entry| !entry.is_finite()) {
            let (row, column) = (at % matrix.nrows(), at / matrix.nrows());
            return Err(ConstraintError::NotFinite { row, column, value: matrix[at] });
        }
        Ok(NullSpaceProjector { row_space: orthonormal(unit_rows(matrix, tolerance), tolerance) })
    }

    /// N = I, without constraints.
    pub fn identity(dim: usize) -> Self {
        NullSpaceProjector { row_space: DMatrix::zeros(dim, 0) }
    }

    /// Dimension n of the state.
    pub fn dim(&self) -> usize {
        self.row_space.nrows()
    }

    /// Rank of A: the number of independent constraints. N has trace n − rank.
    pub fn rank(&self) -> usize {
        self.row_space.ncols()
    }

    /// Replaces v (n) by N v. Does not allocate.
    ///
    /// # Panics
    /// If the length of v is not n.
    pub fn project_into(&self, mut vector: DVectorViewMut<'_, f64>) {
        assert_eq!(vector.len(), self.dim(), "the projector of an n-dimensional state takes vectors of length n");
        if self.rank() == self.dim() {
            // No direction is free. Subtraction would leave rounding errors, and a fully constrained system would creep.
            vector.fill(0.0);
        } else {
            remove(self.row_space.as_view(), vector);
        }
    }

    /// N v, (n).
    ///
    /// # Panics
    /// If the length of v is not n.
    pub fn project(&self, vector: DVectorView<'_, f64>) -> DVector<f64> {
        let mut projected = vector.into_owned();
        self.project_into(projected.as_view_mut());
        projected
    }

    /// N itself, (n, n).
    pub fn matrix(&self) -> DMatrix<f64> {
        let mut matrix = DMatrix::identity(self.dim(), self.dim());
        for mut column in matrix.column_iter_mut() {
            self.project_into(column.as_view_mut());
        }
        matrix
    }
}

/// The rows of A that exceed rounding errors, each scaled to length 1, as columns (n, at most k).
fn unit_rows(matrix: &DMatrix<f64>, tolerance: f64) -> DMatrix<f64> {
    let negligible = tolerance * matrix.amax();
    let rows = matrix.row_iter().filter(|row| row.amax() > negligible).map(|row| {
        // Divided by the largest entry first, so that no square overflows or underflows.
        let largest = row.amax();
        row.transpose().map(|entry| entry / largest).normalize()
    });
    let rows: Vec<DVector<f64>> = rows.collect();
    if rows.is_empty() { DMatrix::zeros(matrix.ncols(), 0) } else { DMatrix::from_columns(&rows) }
}

/// An orthonormal basis of the span of unit vectors (n, k), by Gram–Schmidt orthogonalization that always takes the
/// vector farthest from the span of those before: a rank-revealing QR decomposition with pivoting.
fn orthonormal(mut vectors: DMatrix<f64>, tolerance: f64) -> DMatrix<f64> {
    let mut rank = 0;
    while rank < vectors.nrows().min(vectors.ncols()) {
        let distance = |column: usize| vectors.column(column).norm();
        let farthest = (rank..vectors.ncols()).max_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(rank);
        if distance(farthest) <= tolerance {
            break;
        }
        vectors.swap_columns(rank, farthest);
        let (basis, mut rest) = vectors.columns_range_pair_mut(..rank, rank..);
        let (mut direction, mut rest) = rest.columns_range_pair_mut(0, 1..);
        // The remainder of a nearly dependent row consists mostly of rounding errors along the basis; a second pass
        // removes them.
        direction.normalize_mut();
        remove(basis.as_view(), direction.as_view_mut());
        direction.normalize_mut();
        for mut vector in rest.column_iter_mut() {
            vector.axpy(-direction.dot(&vector), &direction, 1.0);
        }
        rank += 1;
    }
    vectors.resize_horizontally(rank, 0.0)
}

/// v − Q Qᵀv for orthonormal columns Q, one column after the other.
fn remove(basis: DMatrixView<'_, f64>, mut vector: DVectorViewMut<'_, f64>) {
    for direction in basis.column_iter() {
        let along = direction.dot(&vector);
        vector.axpy(-along, &direction, 1.0);
    }
}
