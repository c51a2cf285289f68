use nalgebra::{DMatrixView, DVectorView};

use crate::{JointKind, KinematicsError, error::FARTHEST};

/// An active joint: one coordinate of a configuration q, one column of a Jacobian.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    pub(crate) name: String,
    pub(crate) kind: JointKind,
    pub(crate) lower: f64,
    pub(crate) upper: f64,
}

impl Joint {
    /// The joint's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Type of motion, which determines the unit of its coordinate.
    pub fn kind(&self) -> JointKind {
        self.kind
    }

    /// Lower limit, in radians or metres; −∞ for a continuous joint.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// Upper limit, in radians or metres; +∞ for a continuous joint.
    pub fn upper(&self) -> f64 {
        self.upper
    }
}

/// Checks a configuration against its joints.
#[inline]
pub(crate) fn checked<'q>(q: &'q DVectorView<'_, f64>, joints: &[Joint]) -> Result<&'q [f64], KinematicsError> {
    within(q, joints, f64::MAX)
}

/// Checks a configuration for placing links.
#[inline]
pub(crate) fn placeable<'q>(q: &'q DVectorView<'_, f64>, joints: &[Joint]) -> Result<&'q [f64], KinematicsError> {
    within(q, joints, FARTHEST)
}

/// Checks configurations (n, N) for placing links.
pub(crate) fn all_placeable(q: &DMatrixView<'_, f64>, joints: &[Joint]) -> Result<(), KinematicsError> {
    for (index, column) in q.column_iter().enumerate() {
        placeable(&column, joints).map_err(|error| KinematicsError::InBatch { index, reason: Box::new(error) })?;
    }
    Ok(())
}

#[inline]
fn within<'q>(q: &'q DVectorView<'_, f64>, joints: &[Joint], most: f64) -> Result<&'q [f64], KinematicsError> {
    let q = q.as_slice();
    if q.len() != joints.len() {
        return Err(KinematicsError::ConfigurationLength { found: q.len(), expected: joints.len() });
    }
    // Without an early exit, the loop is vectorized.
    if q.iter().fold(true, |all, value| all & (value.abs() <= most)) { Ok(q) } else { Err(beyond(q, joints, most)) }
}

#[cold]
fn beyond(q: &[f64], joints: &[Joint], most: f64) -> KinematicsError {
    let is_beyond = |value: &f64| value.is_nan() || value.abs() > most;
    let index = q.iter().position(is_beyond).expect("one value was found to be beyond");
    let (joint, value) = (joints[index].name.clone(), q[index]);
    if value.is_finite() {
        KinematicsError::TooFar { joint, index, value }
    } else {
        KinematicsError::NotFinite { joint, index, value }
    }
}
