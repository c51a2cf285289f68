use nalgebra::{DVector, DVectorView, DVectorViewMut};
use rand::{Rng, RngExt};

use super::{RobotModel, joint::checked};
use crate::{JointKind, KinematicsError};

impl RobotModel {
    /// A random configuration (n): each coordinate is uniform between its limits, a continuous joint's angle in
    /// [−π, π). The limits of mimic joints are ignored, because a configuration does not contain them.
    pub fn random_configuration(&self, rng: &mut impl Rng) -> DVector<f64> {
        let mut q = DVector::zeros(self.n_joints());
        self.draw(rng, q.as_mut_slice());
        q
    }

    /// Writes a [`RobotModel::random_configuration`] into `q` (n). Does not allocate.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`].
    pub fn random_configuration_into(
        &self,
        rng: &mut impl Rng,
        mut q: DVectorViewMut<'_, f64>,
    ) -> Result<(), KinematicsError> {
        if q.len() != self.n_joints() {
            return Err(KinematicsError::ConfigurationLength { found: q.len(), expected: self.n_joints() });
        }
        self.draw(rng, q.as_mut_slice());
        Ok(())
    }

    fn draw(&self, rng: &mut impl Rng, q: &mut [f64]) {
        for (value, joint) in q.iter_mut().zip(self.joints.iter()) {
            let part: f64 = rng.random();
            *value = match joint.kind {
                JointKind::Continuous => std::f64::consts::PI * (2.0 * part - 1.0),
                // Two products, because upper − lower may overflow.
                _ => (joint.lower * (1.0 - part) + joint.upper * part).clamp(joint.lower, joint.upper),
            };
        }
    }

    /// Clips every coordinate of `q` (n) to its limits, and returns the number of coordinates that changed.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`] or [`KinematicsError::NotFinite`]; then `q` is unchanged.
    pub fn clip(&self, mut q: DVectorViewMut<'_, f64>) -> Result<usize, KinematicsError> {
        let beyond = self.n_beyond_limits(q.as_view())?;
        for (value, joint) in q.iter_mut().zip(self.joints.iter()) {
            *value = value.clamp(joint.lower, joint.upper);
        }
        Ok(beyond)
    }

    /// Number of coordinates of `q` (n) that are beyond their limits.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`] or [`KinematicsError::NotFinite`].
    pub fn n_beyond_limits(&self, q: DVectorView<'_, f64>) -> Result<usize, KinematicsError> {
        let q = checked(&q, &self.joints)?;
        let joints = self.joints.iter();
        Ok(q.iter().zip(joints).filter(|(value, joint)| **value < joint.lower || **value > joint.upper).count())
    }
}
