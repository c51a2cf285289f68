use nalgebra::{DMatrix, Matrix6xX};

use super::LinkPoses;
use crate::KinematicsError;

impl LinkPoses<'_> {
    /// The mass matrix M(q) = Σ m J_vᵀJ_v + J_ωᵀRIRᵀJ_ω over links, (n, n); the kinetic energy is half q̇ᵀMq̇. J_v and J_ω are
    /// Jacobians of a link's centre of mass. The units are kg m², kg m and kg, depending on whether the joints rotate or slide. The
    /// time grows with the number of links times n².
    ///
    /// # Errors
    /// As [`RobotModel::inertials`](crate::RobotModel::inertials).
    pub fn mass_matrix(&self) -> Result<DMatrix<f64>, KinematicsError> {
        let n = self.robot().n_joints();
        let mut sum = DMatrix::zeros(n, n);
        let mut jacobian = Matrix6xX::zeros(n);
        for inertial in self.robot().inertials()? {
            let centre = self.transform_point(inertial.link, &inertial.origin.translation.vector.into());
            self.fill_at::<6>(inertial.link, &centre, jacobian.as_mut_slice());
            let (linear, angular) = (jacobian.fixed_rows::<3>(0), jacobian.fixed_rows::<3>(3));
            let axes = self.pose(inertial.link).rotation * inertial.origin.rotation;
            let turning = axes.inverse() * angular;
            sum += linear.tr_mul(&linear) * inertial.mass + turning.tr_mul(&(inertial.tensor * &turning));
        }
        Ok(sum)
    }
}
