//! Rows of stretches in place of rows of samples, where constraints push: after the search on samples.

use crate::Rows;
use crate::rows::kept::Kept;
use crate::slope::judgement::{CrossPathEvidence, ReportInput, report};
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
/// tried where that predicts nearly exactly. Where nothing pushes, only noise of the directions can be gained, by those of whole
/// movements (S32).
pub(crate) fn pushed(gp: &SlopeGp, rows: &Rows, kept: &Kept, plain: &Outcome) -> Option<Pushed> {
    let settled = plain.taken.left_out.is_nearly_exact();
    if gp.push_test == PushTest::AssumeNone || settled && rows.variances().is_none() {
        return None;
    }
    let stretches = Stretches::of(rows)?;
    if stretches.push_is_significant() {
        let pushed = if settled { None } else { Pushed::search(gp, rows, kept, &stretches) }?;
        let r_squared = |outcome: &Outcome| outcome.taken.left_out.r_squared;
        return (r_squared(&pushed.outcome) > r_squared(plain)).then_some(pushed);
    }
    rows.variances()?;
    let pushed = Pushed::search(gp, rows, kept, &stretches.without_push(rows))?;
    // R² of slow rows that are certain is not that of fast ones alone.
    let expected = |outcome: &Outcome, kept: &Kept| {
        report(&ReportInput { outcome, kept, rows, across: CrossPathEvidence::Tested }).expected_nupe
    };
    (expected(&pushed.outcome, &pushed.kept) < expected(plain, kept)).then_some(pushed)
}

impl Pushed {
    fn search(gp: &SlopeGp, rows: &Rows, kept: &Kept, stretches: &Stretches) -> Option<Pushed> {
        let kept = stretches.rows(rows, kept, &gp.selection().ok()?)?;
        Some(Pushed { outcome: outcome(gp, &kept).ok()?, kept })
    }

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
