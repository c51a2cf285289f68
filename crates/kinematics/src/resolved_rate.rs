use nalgebra::{Cholesky, DMatrix, DMatrixView, DVector, DVectorView, DVectorViewMut};

use crate::KinematicsError;

/// A pivot of J Jᵀ + λ² I below this share of its diagonal entry is rounding.
const SINGULAR: f64 = 1e-13;

/// Damped resolved-rate control: joint velocities that realise a task velocity, and follow a second wish as far as the
/// task leaves them free.
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
    /// Control with damping λ, in the Jacobian's unit (metres per radian). The task's part of the joint velocity is at most
    /// |v − J z| / (2λ), and where J is small beside λ the task is met less exactly. 0 is no damping: near a singular posture the
    /// joint velocity then grows without bound.
    ///
    /// # Errors
    /// [`KinematicsError::Damping`].
    pub fn new(damping: f64) -> Result<Self, KinematicsError> {
        if !(damping.is_finite() && damping >= 0.0) {
            return Err(KinematicsError::Damping { damping });
        }
        Ok(ResolvedRate { damping, gram: DMatrix::zeros(0, 0), residual: DVector::zeros(0) })
    }

    /// Writes q̇ (n) into `velocity`, for `jacobian` J (m, n) (a reference to a matrix of 3, 6 or any rows),
    /// the wished task velocity `task` v (m) and the wished
    /// joint velocity `pull` z (n), all per second. Allocates only when m changes.
    ///
    /// # Errors
    /// [`KinematicsError::TaskShape`] or [`KinematicsError::SingularTask`]; `velocity` is of no meaning then.
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
        // v − J z, which the pseudo-inverse takes at once: q̇ = z + J⁺ (v − J z).
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
        // The factorisation works in place, but only in a matrix that it owns.
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
        // Rounding may leave a singular matrix a pivot, but none that is more than a small share of its diagonal.
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
