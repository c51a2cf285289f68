//! Rows of stretches in place of rows of samples, where constraints push: after the search on samples.

mod contradicted;

use std::borrow::Cow;

use crate::Rows;
use crate::rows::kept::Kept;
use crate::slope::all_rows::{More, OnAllRows, on_all_rows};
use crate::slope::cross_path::CrossPathEvidence;
use crate::slope::judgement::{ReportInput, report};
use crate::slope::push_test::PushTest;
use crate::slope::search::{Outcome, outcome, outcome_of_nearly_best};
use crate::slope::slope_gp::SlopeGp;
use crate::stretches::rows::covered;
use crate::stretches::view::View;
use crate::stretches::{Stretches, Switches};

/// A search on rows of stretches.
pub(crate) struct Pushed {
    pub(crate) outcome: Outcome,
    pub(crate) kept: Kept,
    /// Where the rows are from, and what searched on them.
    stretches: Stretches,
    gp: SlopeGp,
}

/// The search on rows of stretches (S22) that predicts left-out movements better than `plain`, the one on rows of samples: of stretches in
/// the recorded coordinates, or in the task space that expects the least error.
pub(crate) fn pushed(gp: &SlopeGp, rows: &Rows, kept: &Kept, plain: &Outcome) -> Option<Pushed> {
    if gp.push_test == PushTest::AssumeNone {
        return None;
    }
    let recorded = recorded(gp, rows, kept, plain);
    let (outcome, own) = recorded.as_ref().map_or((plain, kept), |of| (&of.outcome, &of.kept));
    in_task_space(gp, rows, (kept, own), outcome).or(recorded)
}

/// Rows of stretches in a task space for one row of samples, since every sample has several, those that set amplitudes, and inducing ones;
/// and the most of them that are taken, unless more are asked for.
const TIMES: [usize; 3] = [6, 2, 3];
const MOST: [usize; 3] = [2400, 400, 1500];
/// Rows for each stretch in the recorded coordinates from which on more say nearly the same.
const OF_A_STRETCH: usize = 4;
/// Of those that expect least on few rows, so many are fitted to more: few rows do not show a wrong stretch among many.
const FINALISTS: usize = 3;
/// They expect at most so many times what the first of them does.
const NEARLY: f64 = 2.0;
/// Expected error up to which task spaces are not tried.
const NEARLY_EXACT: f64 = 1e-3;

/// Of stretches in the task space that expects the least error, if that is less than `outcome` expects.
fn in_task_space(gp: &SlopeGp, rows: &Rows, (kept, own): (&Kept, &Kept), outcome: &Outcome) -> Option<Pushed> {
    if rows.task_spaces().is_empty() || rows.momenta().is_some() {
        return None;
    }
    let before = expected(rows, outcome, own, kept);
    if before <= NEARLY_EXACT {
        return None;
    }
    let views = (0..rows.task_spaces().len()).filter_map(|space| View::in_space(rows, space));
    let found = views.flat_map(|view| {
        let sought = Stretches::of(rows, &view, Switches::Sought);
        let same = rows.labels().is_some() || sought.as_ref().is_some_and(Stretches::are_whole);
        let whole = if same { None } else { Stretches::of(rows, &view, Switches::None) };
        let known =
            |found: Stretches| if found.push_is_significant() { found } else { found.without_push(rows, &view) };
        [sought, whole].map(|found| found.map(known)).into_iter().flatten()
    });
    let means = rows.averaged();
    let tried = found.filter_map(|found| {
        let tried = Pushed::search(gp, &means, kept, found)?;
        Some((expected(rows, &tried.outcome, &tried.kept, kept), tried))
    });
    let mut tried: Vec<(f64, Pushed)> = tried.collect();
    tried.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let more = |rows: usize, (times, most): (usize, usize)| rows.max((times * rows).min(most));
    let [of_rows, of_hyper, of_inducing] = [0, 1, 2].map(|at| (TIMES[at], MOST[at]));
    let larger = SlopeGp {
        max_rows: more(gp.max_rows, of_rows),
        hyper_rows: more(gp.hyper_rows, of_hyper),
        inducing_rows: more(gp.inducing_rows, of_inducing),
        ..gp.clone()
    };
    let least = tried.first()?.0;
    let finalists = tried.into_iter().take(FINALISTS).take_while(|(error, _)| *error <= NEARLY * least);
    let finals = finalists.filter_map(|(_, fewer)| {
        let pushed = fewer.of_nearly_best(&larger, &means, kept, fewer.stretches.clone())?;
        Some((expected(rows, &pushed.outcome, &pushed.kept, kept), pushed))
    });
    let best = finals.min_by(|(a, _), (b, _)| a.total_cmp(b));
    best.filter(|(error, _)| *error < before).map(|(_, pushed)| pushed)
}

/// (S19) of `own` rows, for R² of slow rows that are certain is not that of fast ones alone: on all movements, as if nothing were
/// known of those that have none.
fn expected(rows: &Rows, outcome: &Outcome, own: &Kept, samples: &Kept) -> f64 {
    let report = report(&ReportInput { outcome, kept: own, rows, across: CrossPathEvidence::Tested });
    report.expected_nupe / covered(rows, own, samples)
}

/// Of stretches in the recorded coordinates. Not tried where `plain` predicts nearly exactly. Where nothing pushes, only noise of the
/// directions can be gained, by those of whole movements (S32).
fn recorded(gp: &SlopeGp, rows: &Rows, kept: &Kept, plain: &Outcome) -> Option<Pushed> {
    let settled = plain.taken.left_out.is_nearly_exact();
    if settled && rows.variances().is_none() {
        return None;
    }
    let view = View::recorded(rows);
    let stretches = Stretches::of(rows, &view, Switches::Sought)?;
    if stretches.push_is_significant() {
        let pushed = if settled { None } else { Pushed::search(gp, rows, kept, stretches) }?;
        let left = |outcome: &Outcome| 1.0 - outcome.taken.left_out.r_squared;
        return (left(&pushed.outcome) < covered(rows, &pushed.kept, kept) * left(plain)).then_some(pushed);
    }
    rows.variances()?;
    let pushed = Pushed::search(gp, rows, kept, stretches.without_push(rows, &view))?;
    pushed.expects_less(rows, plain, kept).then_some(pushed)
}

impl Pushed {
    fn search(gp: &SlopeGp, rows: &Rows, kept: &Kept, stretches: Stretches) -> Option<Pushed> {
        let kept = stretches.rows(rows, kept, &gp.selection().ok()?)?;
        Some(Pushed { outcome: outcome(gp, &kept).ok()?, kept, stretches, gp: gp.clone() })
    }

    /// The same on other rows, of the models alone that nearly were the best ones here.
    fn of_nearly_best(&self, gp: &SlopeGp, rows: &Rows, kept: &Kept, stretches: Stretches) -> Option<Pushed> {
        let kept = stretches.rows(rows, kept, &gp.selection().ok()?)?;
        let outcome = outcome_of_nearly_best(gp, &kept, &self.outcome).ok()?;
        Some(Pushed { outcome, kept, stretches, gp: gp.clone() })
    }

    /// The samples that rows of the stretches are of: in a task space perhaps means.
    fn of_samples<'a>(&self, rows: &'a Rows) -> Cow<'a, Rows> {
        if self.stretches.through.is_some() { rows.averaged() } else { Cow::Borrowed(rows) }
    }

    /// Whether the constraints push: then samples say nothing true, however many they are.
    pub(crate) fn pushes(&self) -> bool {
        self.stretches.pushed
    }

    /// Whether this expects less than a search on rows of samples.
    pub(crate) fn expects_less(&self, rows: &Rows, samples: &Outcome, kept: &Kept) -> bool {
        expected(rows, &self.outcome, &self.kept, kept) < expected(rows, samples, kept, kept)
    }

    /// The search on all rows of the stretches, where that pays, with doubts about those that other movements contradict. Only once rows of
    /// stretches are taken: where many are wrong, the others predict well, too.
    pub(crate) fn on_all_rows(self, rows: &Rows) -> Pushed {
        let taken = self.with_contradicted(rows);
        let Pushed { outcome, kept, stretches, gp } = &taken;
        // Rows of one stretch share the error of their directions.
        if stretches.through.is_none() && kept.rows.len() >= OF_A_STRETCH * stretches.all.len() {
            return taken;
        }
        let of_samples = taken.of_samples(rows);
        let at_most = |most| stretches.more_rows(&of_samples, kept, most);
        let more = More { at_most: &at_most, noisy: rows.variances().is_some() };
        match on_all_rows(gp, more, kept, outcome) {
            Some(OnAllRows { kept, outcome }) => Pushed { outcome, kept, ..taken },
            None => taken,
        }
    }

    /// Held-out squared error of one row a sample on each of these trajectories, as a share of what was to predict in all of its rows: along
    /// the velocity itself all of it is in one. At most 1, that of predicting nothing: in few rows there may be little to predict. On a trajectory
    /// without stretches the share of all others together.
    pub(crate) fn shares(&self, trajectories: &[usize]) -> Vec<f64> {
        let Outcome { data, taken, .. } = &self.outcome;
        let weighed = |rows: &[usize], of: &dyn Fn(usize) -> f64| -> f64 {
            rows.iter().map(|&row| of(row).powi(2) / data.noise_weights[row]).sum()
        };
        let of_sample = self.kept.of_stretches.as_ref().map_or(1.0, |of| of.of_sample);
        let share = |rows: &[usize]| {
            let error = weighed(rows, &|row| taken.left_out.residuals[(row, 0)]);
            (error / (of_sample * weighed(rows, &|row| data.targets[(row, 0)]))).min(1.0)
        };
        let all = share(&data.groups.concat());
        let own = self.kept.trajectories();
        let of = |trajectory: &usize| own.binary_search(trajectory).map_or(all, |group| share(&data.groups[group]));
        trajectories.iter().map(of).collect()
    }
}
