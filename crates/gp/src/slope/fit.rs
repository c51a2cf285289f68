use motion::{Certainty, LearntPolicy, Policy, Potential};
use nalgebra::{DMatrix, DMatrixView, DVectorView, DVectorViewMut};
use rand::Rng;

use crate::dimension::require;
use crate::report::trust_report::TrustReport;
use crate::slope::all_rows::{OnAllRows, on_all_samples};
use crate::slope::cross_path::CrossPathEvidence;
use crate::slope::judgement::{ReportInput, report};
use crate::slope::model::SlopeModel;
use crate::slope::policy::{SlopePolicy, SlopePotential};
use crate::slope::pushed::{Pushed, pushed};
use crate::slope::search::outcome;
use crate::slope::slope_gp::SlopeGp;
use crate::support::only_deviation_into;
use crate::{GpError, Rows};

/// A fitted slope GP: policy, uncertainty and trust report.
///
/// After storing and reading by serde, its predictions are the same to the last bit.
#[derive(Debug, Clone)]
pub struct SlopeFit {
    pub(crate) model: SlopeModel,
    pub(crate) report: TrustReport,
}

impl SlopeGp {
    /// Learns from rows. The generator draws one permutation and, if rows are thinned, an offset.
    ///
    /// # Errors
    /// [`GpError::Parameter`], or the reason for refusing the rows: too few, no motion, one state, no Cholesky factor.
    pub fn fit<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<SlopeFit, GpError> {
        let kept = self.row_limits()?.keep(rows, rng)?;
        let plain = outcome(self, &kept)?;
        let pushed = pushed(self, rows, &kept, &plain).map(|pushed| pushed.on_all_rows(rows));
        let (outcome, kept) = match pushed {
            Some(pushed) if pushed.pushes() => (pushed.outcome, pushed.kept),
            pushed => {
                let all = on_all_samples(self, rows, &kept, &plain);
                let all = all.unwrap_or(OnAllRows { kept, outcome: plain });
                match pushed.filter(|pushed| pushed.expects_less(rows, &all.outcome, &all.kept)) {
                    Some(Pushed { outcome, kept, .. }) => (outcome, kept),
                    None => (all.outcome, all.kept),
                }
            }
        };
        let across = CrossPathEvidence::of_neighbours(&outcome.data);
        let report = report(&ReportInput { outcome: &outcome, kept: &kept, rows, across });
        Ok(SlopeFit { model: outcome.taken.model, report })
    }
}

impl SlopeFit {
    /// π̂.
    pub fn policy(&self) -> &SlopePolicy {
        self.model.policy()
    }

    /// φ̂; `None` if the model allows rotation.
    pub fn potential(&self) -> Option<&SlopePotential> {
        self.model.potential()
    }

    /// (S13): cov π(x), (n, n), in squared units of the state per second, not yet multiplied by [`TrustReport::variance_factor`]. Costs n
    /// M².
    pub fn uncertainty(&self, state: DVectorView<'_, f64>) -> DMatrix<f64> {
        self.model.covariance(state)
    }

    /// φ̂(x) − φ̂(x₀), from x₀ = `from` to x, (n + p) each, in squared units of the state per second, and its variance (S14), not yet
    /// multiplied by [`TrustReport::variance_factor`]; `None` without a potential.
    pub fn potential_difference(&self, x: DVectorView<'_, f64>, from: DVectorView<'_, f64>) -> Option<(f64, f64)> {
        self.model.potential_difference(x, from)
    }

    /// Numbers and doubts about the fit.
    pub fn report(&self) -> &TrustReport {
        &self.report
    }
}

impl Policy for SlopeFit {
    fn dim(&self) -> usize {
        self.model.policy().dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>) {
        self.model.policy().action_into(state, action);
    }

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        self.model.policy().actions(states)
    }
}

impl LearntPolicy for SlopeFit {
    fn potential(&self) -> Option<&dyn Potential> {
        self.model.potential().map(|potential| potential as &dyn Potential)
    }

    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        self.certainty(state.as_view()).support[0]
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, deviation: DVectorViewMut<'_, f64>) -> bool {
        only_deviation_into(&self.certainty(state.as_view()), deviation)
    }

    fn certainty(&self, states: DMatrixView<'_, f64>) -> Certainty {
        require(self.dim(), &[states.nrows()]);
        let moving = self.model.expansion().moving();
        self.model.variances(states).certainty(self.report.variance_factor(), moving, self.dim())
    }

    fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        require(self.dim(), &[states.nrows()]);
        self.model.supported(states, least)
    }

    fn warnings(&self) -> Vec<String> {
        self.report.doubts().iter().map(ToString::to_string).collect()
    }
}
