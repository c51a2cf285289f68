//! The slope GP and the direct GP on the same rows, before one of them is selected.

use crate::Rows;
use crate::direct::direct_gp::DirectOutcome;
use crate::direct::free_rows::FreeRowsFit;
use crate::kernel::family::Family;
use crate::reading::numbers::{Compared, LeftOutRow, ReadingNumbers, TrajectoryErrors};
use crate::rows::kept::Kept;
use crate::slope::all_rows::{OnAllRows, on_all_samples};
use crate::slope::pushed::Pushed;
use crate::slope::search::SlopeOutcome;
use crate::slope::slope_gp::SlopeGp;

/// Both models of the same rows.
pub(crate) struct SlopeAndDirect {
    pub(crate) kept: Kept,
    pub(crate) slope: SlopeOutcome,
    pub(crate) direct: DirectOutcome,
    /// The direct GP of the free rows, which replaces that of all rows.
    pub(crate) free_rows_fit: Option<FreeRowsFit>,
}

/// Errors of predictions of left-out trajectories.
pub(crate) struct LeftOutErrors {
    pub(crate) trajectories: Vec<TrajectoryErrors>,
    pub(crate) rows: Vec<LeftOutRow>,
}

impl SlopeAndDirect {
    /// Adds the direct GP of the free rows if it explains the others (R10).
    pub(crate) fn with_free_rows(mut self, families: &[Family]) -> SlopeAndDirect {
        self.free_rows_fit = FreeRowsFit::of(families, &self.kept, &self.direct);
        self.free_rows_if_they_explain_all()
    }

    /// Drops the direct GP of the free rows if the constrained rows contradict it.
    fn free_rows_if_they_explain_all(mut self) -> SlopeAndDirect {
        if self.free_rows_fit.is_some() && !self.compare_predictions(None).0.free_rows_explain_all() {
            self.free_rows_fit = None;
        }
        self
    }

    /// Both models on all rows if that improves the slope GP; otherwise unchanged.
    pub(crate) fn on_all_rows(self, gp: &SlopeGp, rows: &Rows) -> SlopeAndDirect {
        let all = on_all_samples(gp, rows, &self.kept, &self.slope);
        let both = all.and_then(|all| Some((self.direct.on_all_rows(&all.kept, gp.inducing_rows)?, all)));
        match both {
            Some((direct, OnAllRows { kept, outcome })) => {
                let free_rows_fit =
                    self.free_rows_fit.and_then(|free_rows_fit| free_rows_fit.on_all_rows(&kept, gp.inducing_rows));
                SlopeAndDirect { kept, slope: outcome, direct, free_rows_fit }.free_rows_if_they_explain_all()
            }
            None => self,
        }
    }

    /// Compares their predictions of left-out trajectories on these rows, with the slope GP of `pushed`, if any, in place of
    /// their own.
    pub(crate) fn compare_predictions(&self, pushed: Option<&Pushed>) -> (ReadingNumbers, LeftOutErrors) {
        let SlopeAndDirect { kept, slope, direct, free_rows_fit } = self;
        let direct = free_rows_fit.as_ref().map_or(direct, |free_rows_fit| &free_rows_fit.direct);
        let actions = pushed.map(|pushed| pushed.outcome.taken.model.actions(&kept.states));
        let shares = pushed.map(|pushed| pushed.shares(&kept.trajectories()));
        let taken = &pushed.map_or(slope, |pushed| &pushed.outcome).taken;
        let compared = Compared {
            speeds: &kept.speeds,
            grouping: kept.grouping,
            indices: &kept.indices,
            data: &slope.data,
            slope: (&taken.left_out, actions.as_ref().unwrap_or(&taken.actions)),
            direct: (&direct.left_out, &direct.actions),
            direct_unit: direct.fit.model.unit,
            free_rows_fit: free_rows_fit.as_ref(),
            shares: shares.as_deref(),
        };
        let errors = LeftOutErrors { trajectories: compared.errors(), rows: compared.rows() };
        (ReadingNumbers::from_comparison(&compared), errors)
    }
}
