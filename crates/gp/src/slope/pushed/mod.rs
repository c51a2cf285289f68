//! Replaces rows of samples by rows of stretches if constraints push, after the search on samples.

mod contradicted;

use std::borrow::Cow;

use crate::Rows;
use crate::left_out::NEARLY_EXACT;
use crate::rows::kept::Kept;
use crate::slope::all_rows::{More, OnAllRows, on_all_rows};
use crate::slope::cross_path::CrossPathEvidence;
use crate::slope::judgement::{ReportInput, report, root_mean_square};
use crate::slope::push_test::PushTest;
use crate::slope::search::{SlopeOutcome, outcome, outcome_of_nearly_best};
use crate::slope::slope_gp::SlopeGp;
use crate::stretches::pushes::SMALL;
use crate::stretches::rows::covered;
use crate::stretches::view::View;
use crate::stretches::{Stretches, Switches};

/// A search on rows of stretches.
pub(crate) struct Pushed {
    pub(crate) outcome: SlopeOutcome,
    pub(crate) kept: Kept,
    /// The source of the rows, and the learner that searched on them.
    stretches: Stretches,
    gp: SlopeGp,
}

/// The search on rows of stretches (S22) if it predicts left-out movements better than `plain`, the search on rows of samples. The
/// stretches are those in the recorded coordinates, or in the task space with the least expected error.
pub(crate) fn pushed(gp: &SlopeGp, rows: &Rows, kept: &Kept, plain: &SlopeOutcome) -> Option<Pushed> {
    if gp.push_test == PushTest::AssumeNone {
        return None;
    }
    let recorded = recorded(gp, rows, kept, plain);
    let (outcome, own) = recorded.as_ref().map_or((plain, kept), |of| (&of.outcome, &of.kept));
    in_task_space(gp, rows, (kept, own), outcome).or(recorded)
}

/// For task spaces, multiples of the usual numbers of rows (because each sample has several), of rows that determine amplitudes, and of
/// inducing rows; and the maxima of the products, unless the user requests more.
const TIMES: [usize; 3] = [6, 2, 3];
const MOST: [usize; 3] = [2400, 400, 1500];
/// From this many rows per stretch on, in the recorded coordinates, more rows add almost nothing.
const OF_A_STRETCH: usize = 4;
/// Number of candidates with the least expected error on few rows that are fitted to more rows, because few rows do not reveal a wrong
/// stretch among many.
const FINALISTS: usize = 3;
/// Their expected error is at most this multiple of the least.
const NEARLY: f64 = 2.0;

/// The search on stretches in the task space with the least expected error, if that is below the error expected of `outcome`.
fn in_task_space(gp: &SlopeGp, rows: &Rows, (kept, own): (&Kept, &Kept), outcome: &SlopeOutcome) -> Option<Pushed> {
    if rows.task_spaces().is_empty() || rows.momenta().is_some() {
        return None;
    }
    let before = expected(rows, outcome, own, kept);
    if before <= NEARLY_EXACT {
        return None;
    }
    let speed = root_mean_square(&outcome.taken.actions);
    let views = (0..rows.task_spaces().len()).filter_map(|space| View::in_space(rows, space));
    let found = views.flat_map(|view| {
        let sought = Stretches::of(rows, &view, Switches::Sought);
        let same = rows.labels().is_some() || sought.as_ref().is_some_and(Stretches::are_whole);
        let whole = if same { None } else { Stretches::of(rows, &view, Switches::None) };
        [sought, whole].into_iter().flatten().flat_map(move |found| {
            let without = || found.without_push(rows, &view);
            match found.push_is_significant() {
                true if found.push() > SMALL * speed => vec![found],
                // Noise that samples share, as after smoothing, looks like a small push.
                true => vec![without(), found],
                false => vec![without()],
            }
        })
    });
    let means = rows.averaged();
    let tried = found.filter_map(|found| {
        let tried = Pushed::search(gp, &means, kept, found)?;
        Some((expected(rows, &tried.outcome, &tried.kept, kept), tried))
    });
    let mut tried: Vec<(f64, Pushed)> = tried.collect();
    tried.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let larger = larger(gp);
    let between = SlopeGp { max_rows: gp.max_rows.max(larger.max_rows / 2), ..larger.clone() };
    let least = tried.first()?.0;
    let finalists = tried.into_iter().take(FINALISTS).take_while(|(error, _)| *error <= NEARLY * least);
    let on_more = |fewer: &Pushed, gp: &SlopeGp| {
        let pushed = fewer.of_nearly_best(gp, &means, kept, fewer.stretches.clone())?;
        Some((expected(rows, &pushed.outcome, &pushed.kept, kept), pushed))
    };
    let finals = finalists.filter_map(|(_, fewer)| on_more(&fewer, &between));
    let (_, best) = finals.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    on_more(&best, &larger).filter(|(error, _)| *error < before).map(|(_, pushed)| pushed)
}

/// The learner for task spaces, with [`TIMES`] as many rows.
fn larger(gp: &SlopeGp) -> SlopeGp {
    let more = |rows: usize, at: usize| rows.max((TIMES[at] * rows).min(MOST[at]));
    SlopeGp {
        max_rows: more(gp.max_rows, 0),
        hyper_rows: more(gp.hyper_rows, 1),
        inducing_rows: more(gp.inducing_rows, 2),
        ..gp.clone()
    }
}

/// Expected error (S19) with `own` rows, divided by the share of the movements that have such rows. R² is not used, because slow, certain
/// rows and fast rows alone do not have comparable R².
fn expected(rows: &Rows, outcome: &SlopeOutcome, own: &Kept, samples: &Kept) -> f64 {
    let report = report(&ReportInput { outcome, kept: own, rows, across: CrossPathEvidence::Tested });
    report.expected_nupe / covered(rows, own, samples)
}

/// The search on stretches in the recorded coordinates. If a push is detected, not tried if `plain` predicts nearly exactly. Without a
/// push, the only possible gain is in the noise of the directions, through those of whole movements (S32).
fn recorded(gp: &SlopeGp, rows: &Rows, kept: &Kept, plain: &SlopeOutcome) -> Option<Pushed> {
    let settled = plain.taken.left_out.is_nearly_exact();
    if settled && rows.variances().is_none() {
        return None;
    }
    let view = View::recorded(rows);
    let stretches = Stretches::of(rows, &view, Switches::Sought)?;
    if stretches.push_is_significant() {
        let pushed = if settled { None } else { Pushed::search(gp, rows, kept, stretches) }?;
        let left = |outcome: &SlopeOutcome| 1.0 - outcome.taken.left_out.r_squared;
        return (left(&pushed.outcome) < covered(rows, &pushed.kept, kept) * left(plain)).then_some(pushed);
    }
    rows.variances()?;
    let pushed = Pushed::search(gp, rows, kept, stretches.without_push(rows, &view))?;
    pushed.expects_less(rows, plain, kept).then_some(pushed)
}

impl Pushed {
    fn search(gp: &SlopeGp, rows: &Rows, kept: &Kept, stretches: Stretches) -> Option<Pushed> {
        let kept = stretches.rows(rows, kept, &gp.row_limits().ok()?)?;
        Some(Pushed { outcome: outcome(gp, &kept).ok()?, kept, stretches, gp: gp.clone() })
    }

    /// The same search on other rows, restricted to the models that were nearly the best here.
    fn of_nearly_best(&self, gp: &SlopeGp, rows: &Rows, kept: &Kept, stretches: Stretches) -> Option<Pushed> {
        let kept = stretches.rows(rows, kept, &gp.row_limits().ok()?)?;
        let outcome = outcome_of_nearly_best(gp, &kept, &self.outcome).ok()?;
        Some(Pushed { outcome, kept, stretches, gp: gp.clone() })
    }

    /// The samples to which rows of the stretches belong; in a task space they may be means.
    fn of_samples<'a>(&self, rows: &'a Rows) -> Cow<'a, Rows> {
        if self.stretches.through.is_some() { rows.averaged() } else { Cow::Borrowed(rows) }
    }

    /// Whether the constraints push. Rows of samples are then wrong, whatever their number.
    pub(crate) fn pushes(&self) -> bool {
        self.stretches.pushed
    }

    /// Whether the expected error is lower than that of a search on rows of samples.
    pub(crate) fn expects_less(&self, rows: &Rows, samples: &SlopeOutcome, kept: &Kept) -> bool {
        expected(rows, &self.outcome, &self.kept, kept) < expected(rows, samples, kept, kept)
    }

    /// The search on all rows of the stretches, if that improves it, after raising the noise of contradicted stretches. Used only once rows
    /// of stretches are selected, because if many stretches are wrong, the others predict well, too.
    pub(crate) fn on_all_rows(self, rows: &Rows) -> Pushed {
        let taken = self.with_contradicted(rows);
        let Pushed { outcome, kept, stretches, gp } = &taken;
        // Rows of one stretch share the error of its directions.
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

    /// Held-out squared error of one row per sample on each of these trajectories, as a share of the quantity to predict in all of the
    /// sample's rows (with rows along the velocity itself, one row contains all of it). At most 1, the error of predicting nothing, because
    /// a few rows may contain little to predict. A trajectory without stretches gets the share of all others together.
    pub(crate) fn shares(&self, trajectories: &[usize]) -> Vec<f64> {
        let SlopeOutcome { data, taken, .. } = &self.outcome;
        let weighed = |rows: &[usize], of: &dyn Fn(usize) -> f64| -> f64 {
            rows.iter().map(|&row| of(row).powi(2) / data.targets.noise_weights[row]).sum()
        };
        let of_sample = self.kept.of_stretches.as_ref().map_or(1.0, |of| of.of_sample);
        let share = |rows: &[usize]| {
            let error = weighed(rows, &|row| taken.left_out.residuals[(row, 0)]);
            (error / (of_sample * weighed(rows, &|row| data.targets.values[(row, 0)]))).min(1.0)
        };
        let all = share(&data.targets.groups.concat());
        let own = self.kept.trajectories();
        let share_of =
            |trajectory: &usize| own.binary_search(trajectory).map_or(all, |group| share(&data.targets.groups[group]));
        trajectories.iter().map(share_of).collect()
    }
}
