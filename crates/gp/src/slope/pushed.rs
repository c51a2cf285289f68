//! Rows of stretches in place of rows of samples, where constraints push: after the search on samples.

use crate::Rows;
use crate::rows::kept::Kept;
use crate::slope::push_test::PushTest;
use crate::slope::search::{Outcome, outcome};
use crate::slope::slope_gp::SlopeGp;
use crate::stretches::Stretches;

/// A search on rows of stretches.
pub(crate) struct Pushed {
    pub(crate) outcome: Outcome,
    pub(crate) kept: Kept,
}

/// The search on rows of stretches (S22), if it predicts left-out movements better than `plain`, the one on rows of samples. Not
/// tried where that predicts nearly exactly, or where nothing pushes.
pub(crate) fn pushed(gp: &SlopeGp, rows: &Rows, kept: &Kept, plain: &Outcome) -> Option<Pushed> {
    if gp.push_test == PushTest::AssumeNone || plain.taken.left_out.is_nearly_exact() {
        return None;
    }
    let stretches = Stretches::of(rows).filter(Stretches::push_is_significant)?;
    let of_stretches = stretches.rows(rows, kept, &gp.selection().ok()?)?;
    let outcome = outcome(gp, &of_stretches).ok()?;
    let better = outcome.taken.left_out.r_squared > plain.taken.left_out.r_squared;
    better.then_some(Pushed { outcome, kept: of_stretches })
}

impl Pushed {
    /// Held-out squared error on each of these trajectories, as a share of what was to predict; on one without stretches the
    /// share of all others together.
    pub(crate) fn shares(&self, trajectories: &[usize]) -> Vec<f64> {
        let Outcome { data, taken, .. } = &self.outcome;
        let weighed = |rows: &[usize], of: &dyn Fn(usize) -> f64| -> f64 {
            rows.iter().map(|&row| of(row).powi(2) / data.noise_weights[row]).sum()
        };
        let share = |rows: &[usize]| {
            weighed(rows, &|row| taken.left_out.residuals[(row, 0)]) / weighed(rows, &|row| data.targets[(row, 0)])
        };
        let all = share(&data.groups.concat());
        let place = |trajectory: &usize| self.kept.trajectories.iter().position(|of| of == trajectory);
        trajectories
            .iter()
            .map(|trajectory| place(trajectory).map_or(all, |group| share(&data.groups[group])))
            .collect()
    }
}
