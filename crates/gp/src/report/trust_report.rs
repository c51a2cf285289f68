use motion::LeastSeen;
use serde::{Deserialize, Serialize};

use crate::kernel::block::Block;
use crate::kernel::family::Family;
use crate::left_out::is_nearly_exact;
use crate::report::doubt::Doubt;
use crate::report::identifiability::Identifiability;
use crate::rows::kept::{Grouping, RowsDropped};

/// Reliability of a slope GP, in numbers (`docs/slope-gp.md`, section 6).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrustReport {
    /// Held-out R² (S11): below 0.9 poor, below 0.5 unusable.
    pub r_squared: f64,
    /// Mean squared held-out error divided by its predictive variance (S11); above 4 the noise model is wrong.
    pub z_squared: f64,
    /// γ of (S19): factor on the posterior variance, in error bars and in `expected_nupe`. `None` in models stored by versions without this
    /// field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<f64>,
    /// Expected normalised error of the policy (nUPE) on new movements (S19). It includes the difference of the alternative model (R6) and
    /// [`Rows::step_change`](crate::Rows::step_change).
    pub expected_nupe: f64,
    /// Difference of the alternative model's policy, if that predicts nearly as well (R6). Above 0.1, the policy across the observed paths
    /// is a guess.
    pub ambiguity: f64,
    /// The directions of the policy that the demonstrations determine.
    pub identifiability: Identifiability,
    /// The direction with the least motion.
    pub least_seen: LeastSeen,
    /// t of (S12); `None` if no model with rotation was fitted.
    pub curl_t: Option<f64>,
    /// Σ|π̂_rot|²/Σ|π̂|²; 0 for a potential.
    pub rotational_share: f64,
    /// The selected model.
    pub model: ModelKind,
    /// The selected family.
    pub family: Family,
    /// All fitted models.
    pub families: Vec<FamilyReport>,
    /// Number of rows learnt from.
    pub rows: usize,
    /// Number of inducing rows (S34) over which the policy is a sum; `None` if it is a sum over all rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inducing: Option<usize>,
    /// Rows not learnt from.
    pub rows_dropped: RowsDropped,
    /// The unit of leave-one-out.
    pub grouping: Grouping,
    /// Standard deviation of the noise on positions estimated by the front end, in units of the state.
    pub noise: Option<f64>,
    /// Number of samples before which a constraint probably switched.
    pub switches: Option<usize>,
    /// Root mean square of the constraints' pushes A⁺b, as a share of the policy's speed, if the policy was learnt from directions in which
    /// velocities differ. Pushes that equal the policy's component along them count as 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub push: Option<f64>,
    /// The task space whose constraints the policy was learnt from (S41), as its index in [`Rows::task_spaces`](crate::Rows::task_spaces).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task_space: Option<usize>,
}

/// Whether the policy has a potential.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModelKind {
    /// π = −∇φ.
    Potential,
    /// With a rotational part.
    Helmholtz,
}

/// A fitted model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyReport {
    /// Its family.
    pub family: Family,
    /// With or without rotation.
    pub model: ModelKind,
    /// Its result; `None` if its covariance has no Cholesky factor.
    pub fit: Option<FamilyNumbers>,
}

/// The result of a fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyNumbers {
    /// (S11).
    pub r_squared: f64,
    /// κ: the factor on the noise variance with the largest held-out R² (section 4); 1 is the noise of the marginal likelihood.
    pub kappa: f64,
    /// Standard deviation of the noise, in units of the state per second.
    pub noise: f64,
    /// Blocks and their amplitudes a_b.
    pub amplitudes: Vec<(Block, f64)>,
}

impl TrustReport {
    /// Whether left-out movements are predicted so well (1 − R² ≤ 1e-3) that no better model can be distinguished.
    pub fn is_nearly_exact(&self) -> bool {
        is_nearly_exact(self.r_squared)
    }

    /// Factor on (S13) in error bars: [`TrustReport::calibration`], or max(1, z²) for an older model.
    pub fn variance_factor(&self) -> f64 {
        self.calibration.unwrap_or(self.z_squared.max(1.0))
    }

    /// Reasons to doubt the policy.
    pub fn doubts(&self) -> Vec<Doubt> {
        let identifiability = &self.identifiability;
        let doubts = [
            Doubt::about_prediction(self.r_squared),
            (self.z_squared > 4.0).then(|| Doubt::WrongNoise { factor: self.z_squared.sqrt() }),
            identifiability.warns().then(|| Doubt::MostlyPrior {
                direction: identifiability.direction.clone(),
                variance: identifiability.least,
            }),
            (self.least_seen.coverage() < 1e-6)
                .then(|| Doubt::NeverMoved { direction: self.least_seen.direction.clone() }),
            (self.ambiguity > 0.1).then_some(Doubt::AmbiguousRotation { difference: self.ambiguity }),
            (self.grouping == Grouping::BlocksOfTime).then_some(Doubt::BlocksOfTime),
        ];
        doubts.into_iter().flatten().collect()
    }
}
