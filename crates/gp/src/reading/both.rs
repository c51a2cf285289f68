//! The slope GP and the direct GP on the same rows, before one of them is selected.

use crate::Rows;
use crate::direct::direct_gp::DirectOutcome;
use crate::reading::numbers::{Compared, LeftOutRow, ReadingNumbers, TrajectoryErrors};
use crate::rows::kept::Kept;
use crate::slope::all_rows::{OnAllRows, on_all_samples};
use crate::slope::pushed::Pushed;
use crate::slope::search::Outcome;
use crate::slope::slope_gp::SlopeGp;

/// Both models of the same rows.
pub(crate) struct Both {
    pub(crate) kept: Kept,
    pub(crate) slope: Outcome,
    pub(crate) direct: DirectOutcome,
}

/// Left-out errors of trajectories, and of rows.
pub(crate) type LeftOutPredictions = (Vec<TrajectoryErrors>, Vec<LeftOutRow>);

impl Both {
    /// Both models on all rows if that improves the slope GP; otherwise unchanged.
    pub(crate) fn on_all_rows(self, gp: &SlopeGp, rows: &Rows) -> Both {
        let all = on_all_samples(gp, rows, &self.kept, &self.slope);
        let both = all.and_then(|all| Some((self.direct.on_all_rows(&all.kept, gp.inducing_rows)?, all)));
        match both {
            Some((direct, OnAllRows { kept, outcome })) => Both { kept, slope: outcome, direct },
            None => self,
        }
    }

    /// Compares their predictions of left-out trajectories on these rows, with the slope GP of `pushed`, if any, in place of
    /// their own.
    pub(crate) fn compared(&self, pushed: Option<&Pushed>) -> (ReadingNumbers, LeftOutPredictions) {
        let Both { kept, slope, direct } = self;
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
            shares: shares.as_deref(),
        };
        (ReadingNumbers::compared(&compared), (compared.errors(), compared.rows()))
    }
}
