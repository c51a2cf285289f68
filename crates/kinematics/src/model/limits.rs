use nalgebra::{DVector, DVectorView, DVectorViewMut};
use rand::{Rng, RngExt};

use super::{RobotModel, joint::checked};
use crate::{JointKind, KinematicsError};

impl RobotModel {
    /// A configuration (n), each coordinate drawn uniformly between its limits, a continuous joint's angle from
    /// [−π, π). The limits of mimic joints do not count: a configuration does not hold them.
    pub fn random_configuration(&self, rng: &mut impl Rng) -> DVector<f64> {
        let mut q = DVector::zeros(self.n_joints());
        self.draw(rng, q.as_mut_slice());
        q
    }

    /// Writes a [`RobotModel::random_configuration`] into `q` (n). Allocates nothing.
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
                // Two products, because upper − lower may be more than a number can hold.
                _ => (joint.lower * (1.0 - part) + joint.upper * part).clamp(joint.lower, joint.upper),
            };
        }
    }

    /// Moves every coordinate of `q` (n) that is beyond a limit to that limit, and says how many there were.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`] or [`KinematicsError::NotFinite`]; `q` is as it was then.
    pub fn clip(&self, mut q: DVectorViewMut<'_, f64>) -> Result<usize, KinematicsError> {
        let beyond = self.n_beyond_limits(q.as_view())?;
        for (value, joint) in q.iter_mut().zip(self.joints.iter()) {
            *value = value.clamp(joint.lower, joint.upper);
        }
        Ok(beyond)
    }

    /// How many coordinates of `q` (n) are beyond their limits.
    ///
    /// # Errors
    /// [`KinematicsError::ConfigurationLength`] or [`KinematicsError::NotFinite`].
    pub fn n_beyond_limits(&self, q: DVectorView<'_, f64>) -> Result<usize, KinematicsError> {
        let q = checked(&q, &self.joints)?;
        let joints = self.joints.iter();
        Ok(q.iter().zip(joints).filter(|(value, joint)| **value < joint.lower || **value > joint.upper).count())
    }
}
