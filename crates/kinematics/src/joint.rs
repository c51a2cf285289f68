use nalgebra::DVectorView;

use crate::{JointKind, KinematicsError};

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

    /// How it moves, and so the unit of its coordinate.
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

/// Checks a configuration against the joints it is for.
#[inline]
pub(crate) fn checked<'q>(q: &'q DVectorView<'_, f64>, joints: &[Joint]) -> Result<&'q [f64], KinematicsError> {
    let q = q.as_slice();
    if q.len() != joints.len() {
        return Err(KinematicsError::ConfigurationLength { found: q.len(), expected: joints.len() });
    }
    // No early exit: then the loop becomes vector code.
    if q.iter().fold(true, |all, value| all & value.is_finite()) { Ok(q) } else { Err(not_finite(q, joints)) }
}

#[cold]
fn not_finite(q: &[f64], joints: &[Joint]) -> KinematicsError {
    let index = q.iter().position(|value| !value.is_finite()).expect("one value was found not to be finite");
    KinematicsError::NotFinite { joint: joints[index].name.clone(), index, value: q[index] }
}
