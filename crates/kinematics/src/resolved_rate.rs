use nalgebra::{Cholesky, DMatrix, DMatrixView, DVector, DVectorView, DVectorViewMut};

use crate::KinematicsError;

/// A pivot of J Jᵀ + λ² I below this share of its diagonal entry is a rounding error.
const SINGULAR: f64 = 1e-13;

/// Damped resolved-rate control: joint velocities that realise a task velocity, and follow a secondary joint velocity as far as
/// the task leaves them free.
///
/// q̇ = J⁺ v + (I − J⁺ J) z with the damped pseudo-inverse J⁺ = Jᵀ (J Jᵀ + λ² I)⁻¹. The task may be any number m of
/// rows: one hand (3 or 6), several points stacked (3 each).
#[derive(Debug, Clone)]
pub struct ResolvedRate {
    damping: f64,
    /// J Jᵀ + λ² I, lower triangle.
    gram: DMatrix<f64>,
    residual: DVector<f64>,
}

impl ResolvedRate {
    /// Control with damping λ, in the Jacobian's unit (metres per radian). The task's part of the joint velocity is at most |v −
    /// J z| / (2λ); where J is small compared with λ, the task is realised less exactly. 0 means no damping: the joint velocity
    /// then grows without bound near a singular posture.
    ///
    /// # Errors
    /// [`KinematicsError::Damping`].
    pub fn new(damping: f64) -> Result<Self, KinematicsError> {
        if !(damping.is_finite() && damping >= 0.0) {
            return Err(KinematicsError::Damping { damping });
        }
        Ok(ResolvedRate { damping, gram: DMatrix::zeros(0, 0), residual: DVector::zeros(0) })
    }

    /// Writes q̇ (n) into `velocity`, for `jacobian` J (m, n) (a reference to a matrix with 3, 6 or any number of rows), the
    /// desired task velocity `task` v (m) and the desired joint velocity `pull` z (n), all per second. Allocates only when m
    /// changes.
    ///
    /// # Errors
    /// [`KinematicsError::TaskShape`] or [`KinematicsError::SingularTask`]; then `velocity` is meaningless.
    pub fn velocity<'j>(
        &mut self,
        jacobian: impl Into<DMatrixView<'j, f64>>,
        task: DVectorView<'_, f64>,
        pull: DVectorView<'_, f64>,
        mut velocity: DVectorViewMut<'_, f64>,
    ) -> Result<(), KinematicsError> {
        let jacobian = jacobian.into();
        let (m, n) = jacobian.shape();
        if task.len() != m || pull.len() != n || velocity.len() != n {
            return Err(KinematicsError::TaskShape {
                jacobian: (m, n),
                task: task.len(),
                pull: pull.len(),
                velocity: velocity.len(),
            });
        }
        // v − J z: q̇ = z + J⁺ (v − J z) needs the pseudo-inverse only once.
        if self.residual.len() != m {
            (self.residual, self.gram) = (DVector::zeros(m), DMatrix::zeros(m, m));
        }
        self.residual.copy_from(&task);
        self.residual.gemv(-1.0, &jacobian, &pull, 1.0);
        self.solve(jacobian)?;
        velocity.copy_from(&pull);
        velocity.gemv_tr(1.0, &jacobian, &self.residual, 1.0);
        let finite = velocity.iter().all(|value| value.is_finite());
        if finite { Ok(()) } else { Err(KinematicsError::SingularTask { damping: self.damping }) }
    }

    /// residual ← (J Jᵀ + λ² I)⁻¹ residual.
    fn solve(&mut self, jacobian: DMatrixView<'_, f64>) -> Result<(), KinematicsError> {
        // The factorisation works in place, but requires ownership of the matrix.
        let mut gram = std::mem::replace(&mut self.gram, DMatrix::zeros(0, 0));
        gram.fill(0.0);
        gram.fill_diagonal(self.damping * self.damping);
        for column in jacobian.column_iter() {
            gram.syger(1.0, &column, &column, 1.0);
        }
        let Some(cholesky) = Cholesky::new(gram) else {
            self.residual = DVector::zeros(0);
            return Err(KinematicsError::SingularTask { damping: self.damping });
        };
        // Rounding may leave a nonzero pivot in a singular matrix, but only a small share of its diagonal.
        let lower = cholesky.l_dirty();
        let left =
            |row: usize| lower[(row, row)].powi(2) > SINGULAR * lower.view((row, 0), (1, row + 1)).norm_squared();
        if !(0..lower.nrows()).all(left) {
            self.gram = cholesky.unpack_dirty();
            return Err(KinematicsError::SingularTask { damping: self.damping });
        }
        cholesky.solve_mut(&mut self.residual);
        self.gram = cholesky.unpack_dirty();
        Ok(())
    }
}
