use motion::{Certainty, LearntPolicy, Policy};
use nalgebra::{DMatrix, DMatrixView, DVectorView, DVectorViewMut};
use rand::Rng;
use serde::{Deserialize, Serialize};

use crate::dimension::require;
use crate::direct::data::DirectData;
use crate::direct::model::DirectModel;
use crate::evidence::family_fit::{FamilyFit, each_until_exact};
use crate::kernel::family::Family;
use crate::left_out::LeftOutPredictions;
use crate::report::doubt::Doubt;
use crate::rows::kept::{Kept, RowLimits};
use crate::support::only_deviation_into;
use crate::{GpError, Rows};

/// A Gaussian process on velocities, for unconstrained motion. All components share one covariance.
///
/// It takes the same rows as [`SlopeGp`](crate::SlopeGp) and chooses its family, amplitudes and noise in the same way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectGp {
    /// Families to try. The one that best predicts held-out trajectories is kept; ties go to the first. If the first
    /// predicts all but 1e-8 of the variance, the others are skipped.
    pub families: Vec<Family>,
    /// Maximum number of rows; more are thinned evenly in time. Time grows with its cube, memory with its square. At most
    /// [`MOST_ROWS`](crate::MOST_ROWS).
    pub max_rows: usize,
    /// Number of random rows whose marginal likelihood sets the amplitudes.
    pub hyper_rows: usize,
    /// A row of uncertain velocity is used if |u|² exceeds this squared times the variance of u.
    pub least_snr: f64,
    /// A row is used if |u| exceeds this share of the largest.
    pub least_speed: f64,
}

impl Default for DirectGp {
    fn default() -> Self {
        DirectGp { families: Family::ALL.to_vec(), max_rows: 1500, hyper_rows: 400, least_snr: 1.5, least_speed: 1e-6 }
    }
}

/// A fitted direct GP. After storing and reading by serde, its predictions are the same to the last bit.
#[derive(Debug, Clone)]
pub struct DirectFit {
    pub(crate) model: DirectModel,
    pub(crate) family: Family,
    pub(crate) r_squared: f64,
    pub(crate) z_squared: f64,
}

/// The selected model, and its held-out predictions.
pub(crate) struct DirectOutcome {
    data: DirectData,
    pub(crate) fit: DirectFit,
    pub(crate) left_out: LeftOutPredictions,
    /// û at the rows, (n, M).
    pub(crate) actions: DMatrix<f64>,
}

impl DirectGp {
    /// Learns from rows. The generator draws one permutation and, if rows are thinned, an offset.
    ///
    /// # Errors
    /// [`GpError::Parameter`], or the reason for refusing the rows: too few, no motion, one state, no Cholesky factor.
    pub fn fit<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<DirectFit, GpError> {
        let kept = self.row_limits()?.keep(rows, rng)?;
        Ok(fit_direct(&self.families, &kept)?.fit)
    }

    fn row_limits(&self) -> Result<RowLimits, GpError> {
        if self.families.is_empty() {
            let requirement = "name at least one family";
            return Err(GpError::Parameter { name: "families", value: 0.0, requirement });
        }
        let &DirectGp { max_rows, hyper_rows, least_snr, least_speed, .. } = self;
        Ok(RowLimits { max_rows, hyper_rows, least_snr, least_speed })
    }
}

/// The model of the family that best predicts held-out trajectories.
pub(crate) fn fit_direct(families: &[Family], kept: &Kept) -> Result<DirectOutcome, GpError> {
    let data = DirectData::from_kept(kept)?;
    let fit = |family: Family| data.fit(&family.direct_blocks(), &kept.hyper);
    let tried = each_until_exact(families, fit, |fit| &fit.level.left_out);
    let tried = tried.into_iter().filter_map(|(family, fit)| Some((family, fit?)));
    let better = |best: (Family, FamilyFit), next: (Family, FamilyFit)| {
        if best.1.level.left_out.r_squared >= next.1.level.left_out.r_squared { best } else { next }
    };
    let (family, fit) = tried.reduce(better).ok_or(GpError::NoFactor)?;
    let blocks = family.direct_blocks();
    let left_out = fit.level.left_out.clone();
    let model = data.model(blocks, fit);
    let actions = model.moving_actions(kept.states.as_view());
    let fit = DirectFit { model, family, r_squared: left_out.r_squared, z_squared: left_out.z_squared };
    Ok(DirectOutcome { data, fit, left_out, actions })
}

impl DirectOutcome {
    /// The same family and amplitudes on all rows, through at most `most` of them; `None` without a Cholesky factor.
    pub(crate) fn on_all_rows(&self, all: &Kept, most: usize) -> Option<DirectOutcome> {
        let DirectFit { model, family, .. } = &self.fit;
        let data = self.data.of_others(all);
        let (model, left_out) = data.induced((&model.blocks, &model.amplitudes), most)?;
        let actions = model.moving_actions(all.states.as_view());
        let (r_squared, z_squared) = (left_out.r_squared, left_out.z_squared);
        let fit = DirectFit { model, family: *family, r_squared, z_squared };
        Some(DirectOutcome { data, fit, left_out, actions })
    }
}

impl DirectFit {
    /// û and its variance (R4), not yet multiplied by max(1, z²).
    pub fn model(&self) -> &DirectModel {
        &self.model
    }

    /// The selected family.
    pub fn family(&self) -> Family {
        self.family
    }

    /// Held-out R² (R3); 1 − R² is the expected error.
    pub fn r_squared(&self) -> f64 {
        self.r_squared
    }

    /// Mean squared held-out error divided by its predictive variance (R3).
    pub fn z_squared(&self) -> f64 {
        self.z_squared
    }

    /// Reasons to doubt the policy.
    pub fn doubts(&self) -> Vec<Doubt> {
        Doubt::about_prediction(self.r_squared).into_iter().collect()
    }
}

impl Policy for DirectFit {
    fn dim(&self) -> usize {
        self.model.dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>) {
        self.model.action_into(state, action);
    }

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        self.model.actions(states)
    }
}

impl LearntPolicy for DirectFit {
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        self.certainty(state.as_view()).support[0]
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, deviation: DVectorViewMut<'_, f64>) -> bool {
        only_deviation_into(&self.certainty(state.as_view()), deviation)
    }

    fn certainty(&self, states: DMatrixView<'_, f64>) -> Certainty {
        require(self.dim(), &[states.nrows()]);
        self.model.variances(states).certainty(self.z_squared.max(1.0), self.model.weights.nrows(), self.dim())
    }

    fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        require(self.dim(), &[states.nrows()]);
        self.model.supported(states, least)
    }

    fn warnings(&self) -> Vec<String> {
        self.doubts().iter().map(ToString::to_string).collect()
    }
}
