use std::sync::OnceLock;

use linalg::Factor;
use nalgebra::DMatrix;

use crate::kernel::panel::Panel;
use crate::kernel::triangle::InverseOfLower;

/// The factor of a model's covariance. It is available after a fit; for a stored model it is computed when an error bar
/// first needs it, which takes M² numbers of memory temporarily, half of them permanently, and M³ time.
#[derive(Debug, Clone, Default)]
pub(crate) struct LazyFactor(OnceLock<Option<InverseOfLower>>);

impl From<Factor> for LazyFactor {
    fn from(factor: Factor) -> Self {
        LazyFactor(OnceLock::from(Some(factor.into())))
    }
}

impl LazyFactor {
    /// Replaces B by L⁻¹B. If the covariance has no factor, B becomes 0: the rows then explain nothing, and the prior
    /// remains.
    pub(crate) fn whiten(&self, b: &mut Panel, covariance: impl FnOnce() -> DMatrix<f64>) {
        match self.0.get_or_init(|| Factor::new(covariance()).map(InverseOfLower::from)) {
            Some(factor) => factor.apply(b),
            None => b.clear(),
        }
    }
}
