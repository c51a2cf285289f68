use std::sync::OnceLock;

use linalg::Factor;
use nalgebra::DMatrix;

use crate::kernel::panel::Panel;
use crate::kernel::triangle::InverseOfLower;

/// The factor of a model's covariance: at hand after a fit; of a stored model computed when an error bar first needs it,
/// which costs M² numbers of memory for a moment, half of them for good, and M³ of time.
#[derive(Debug, Clone, Default)]
pub(crate) struct LazyFactor(OnceLock<Option<InverseOfLower>>);

impl From<Factor> for LazyFactor {
    fn from(factor: Factor) -> Self {
        LazyFactor(OnceLock::from(Some(factor.into())))
    }
}

impl LazyFactor {
    /// Replaces B by L⁻¹B. If the covariance has no factor, B becomes 0: rows that cannot be told apart say nothing, and
    /// the prior remains.
    pub(crate) fn whiten(&self, b: &mut Panel, covariance: impl FnOnce() -> DMatrix<f64>) {
        match self.0.get_or_init(|| Factor::new(covariance()).map(InverseOfLower::from)) {
            Some(factor) => factor.apply(b),
            None => b.clear(),
        }
    }
}
