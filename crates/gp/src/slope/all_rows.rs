//! Step 10: fits the models of a search to more rows than were kept: exactly to some, through inducing rows to all.

use crate::Rows;
use crate::kernel::block::Block;
use crate::kernel::family::Family;
use crate::left_out::curl_test::{curl_t, takes_rotation};
use crate::report::trust_report::{FamilyReport, ModelKind};
use crate::rows::kept::{Kept, positions};
use crate::rows::noise_weights::{certain_weights, slope_weights};
use crate::rows::thinning::scattered;
use crate::slope::candidate::Candidate;
use crate::slope::data::SlopeData;
use crate::slope::search::{NEARLY, SlopeOutcome, best_of, candidate, nearly_best};
use crate::slope::slope_gp::SlopeGp;

/// Up to this many rows of certain velocities per kept row, the other rows add almost nothing.
const MANY: usize = 4;
/// Number of rows of an exact model in addition to the kept ones, and minimum number of all these that determine its amplitudes.
const EXACT: usize = 1500;
const HYPER: usize = 400;
/// A model of more noisy rows is accepted up to this multiple of the left-out error of a model of fewer.
const ALLOWED: f64 = 1.05;
/// A model of some rows through inducing rows is accepted up to this multiple of the left-out error of an exact model.
const CLEARLY: f64 = 0.7;
/// If the error exceeds this multiple of the least so far, the other kind of model is not tried through inducing rows.
const HOPELESS: f64 = 2.0;
/// Families of exact models are tried through inducing rows if their 1 − R² is at most this multiple of the least.
const ABOUT: f64 = 1.2;
/// Rows per inducing row on which families are compared if there are [`SEVERAL`] times as many; above [`MOST`] per inducing row, rows are
/// thinned.
const FEW: usize = 16;
const SEVERAL: usize = 3;
const MOST: usize = 64;
/// Above this number of inducing rows, the number of rows does not grow with it, because time grows with its square.
const INDUCING: usize = 500;

/// More rows, and the outcome of a search on them.
pub(crate) struct OnAllRows {
    pub(crate) kept: Kept,
    pub(crate) outcome: SlopeOutcome,
}

/// [`on_all_rows`] for rows of samples.
pub(crate) fn on_all_samples(gp: &SlopeGp, rows: &Rows, kept: &Kept, thinned: &SlopeOutcome) -> Option<OnAllRows> {
    let limits = gp.row_limits().ok()?;
    let at_most = |most| limits.keep_all(rows, kept, most);
    on_all_rows(gp, More { at_most: &at_most, noisy: rows.variances().is_some() }, kept, thinned)
}

/// Source of more rows than those kept.
pub(crate) struct More<'a> {
    /// The kept rows and about so many others; `None` if there are no others.
    pub(crate) at_most: &'a dyn Fn(usize) -> Option<Kept>,
    /// Whether their velocities are uncertain.
    pub(crate) noisy: bool,
}

/// Extends `thinned`, a search on the rows `kept`, to more rows. The best families are fitted again: first exactly with new amplitudes,
/// then those that remain good through inducing rows on some rows, and the best of these on all rows. `None` if few rows were thinned, if
/// step 8 selected the policy that hides least, or if the movements of `kept` are predicted best without these rows.
pub(crate) fn on_all_rows(
    gp: &SlopeGp,
    More { at_most, noisy }: More<'_>,
    kept: &Kept,
    thinned: &SlopeOutcome,
) -> Option<OnAllRows> {
    if gp.inducing_rows == 0 || thinned.least_hidden {
        return None;
    }
    let more = at_most(EXACT)?;
    let beyond = more.dropped.thinned;
    if !noisy && more.rows.len() + beyond <= MANY * kept.rows.len() {
        return None;
    }
    let judge = Judge { weights: &thinned.data.targets.noise_weights, rows: &kept.rows };
    let error = |tried: &OnAllRows| judge.error(&tried.kept, &tried.outcome.data, &tried.outcome.taken);
    let exact = if gp.max_rows < EXACT { exact(gp, &more, thinned, &judge) } else { None };
    let thinned_error = judge.error(kept, &thinned.data, &thinned.taken);
    let least = exact.as_ref().map_or(thinned_error, |exact| error(exact).min(thinned_error));
    let worth = |all: &Kept, data: &SlopeData, of: &Candidate| judge.error(all, data, of) <= HOPELESS * least;
    let before = exact.as_ref().map_or(thinned, |exact| &exact.outcome);
    let (some, all) = if beyond == 0 { (None, None) } else { all_induced(gp, at_most, before, worth) };
    // If rows are noisy, too few are kept to distinguish nearly equal models, so the model of more rows is preferred.
    let allowed = if noisy { ALLOWED } else { 1.0 };
    let all = all.filter(|all| error(all) <= allowed * least);
    // This model has more rows than an exact one, but represents them by fewer. It is better only if it predicts clearly better.
    let some = some.filter(|some| error(some) <= CLEARLY * least);
    all.or(some).or_else(|| exact.filter(|exact| error(exact) <= allowed * thinned_error))
}

/// Models through inducing rows: of some rows if there are several times as many, with the families that were nearly the best before, and
/// of all rows with the families that are the best then, or that are the best through fewer inducing rows.
fn all_induced(
    gp: &SlopeGp,
    at_most: &dyn Fn(usize) -> Option<Kept>,
    before: &SlopeOutcome,
    worth: impl Fn(&Kept, &SlopeData, &Candidate) -> bool,
) -> (Option<OnAllRows>, Option<OnAllRows>) {
    let (inducing, fewer) = (gp.inducing_rows, gp.inducing_rows.min(INDUCING));
    let [some, all] = [FEW, MOST].map(|rows| at_most(rows * fewer));
    let (Some(some), Some(all)) = (some, all) else { return (None, None) };
    if all.rows.len() >= SEVERAL * some.rows.len() {
        let some = induced(some, (before, ABOUT), inducing, &worth);
        let all = some.as_ref().and_then(|some| induced(all, (&some.outcome, 1.0), inducing, worth));
        return (some, all);
    }
    if inducing == fewer {
        return (None, induced(all, (before, ABOUT), inducing, worth));
    }
    let compared = induced(all.clone(), (before, ABOUT), fewer, |_, _, _| true);
    (None, compared.and_then(|compared| induced(all, (&compared.outcome, 1.0), inducing, worth)))
}

/// Compares models on the kept rows, which all of them contain.
struct Judge<'a> {
    /// D of these rows.
    weights: &'a [f64],
    rows: &'a [usize],
}

impl Judge<'_> {
    /// Σ w e² in squared units of speed, where each movement is left out of a model of `all` rows.
    fn error(&self, all: &Kept, data: &SlopeData, of: &Candidate) -> f64 {
        let places = positions(&all.rows, self.rows);
        let each = places.into_iter().zip(self.weights);
        each.map(|(at, weight)| (data.unit * of.left_out.residuals[(at, 0)]).powi(2) / weight).sum()
    }
}

/// Exact models of a limited number of rows, with amplitudes fitted to these. If the previously selected model predicts nearly exactly,
/// prediction depends on the units of z and y. The units are then those of `thinned` or of these rows, whichever give that model the lower
/// error.
fn exact(gp: &SlopeGp, more: &Kept, thinned: &SlopeOutcome, judge: &Judge<'_>) -> Option<OnAllRows> {
    let count = more.rows.len();
    let hyper = scattered(count, count.min(gp.hyper_rows.max(HYPER)), 0.0).collect();
    let kept = Kept { hyper, ..more.clone() };
    let weights = noise_weights(&kept, thinned);
    let before = (thinned.taken.family, thinned.taken.kind);
    let in_units = |data: SlopeData| {
        let anew = candidate(gp, &data, &kept, before.0, before.1);
        let error = anew.as_ref().map_or(f64::INFINITY, |anew| judge.error(&kept, &data, anew));
        (error, data, anew)
    };
    let own = thinned.taken.left_out.is_nearly_exact().then(|| SlopeData::from_kept(&kept, weights.clone()).ok());
    let units = [Some(thinned.data.of_others(&kept, weights)), own.flatten()];
    let tried = units.into_iter().flatten().map(in_units);
    let (_, data, mut anew) = tried.min_by(|(a, ..), (b, ..)| a.total_cmp(b))?;
    let fit = |data: &SlopeData, kept: &Kept, of: (Family, ModelKind), _: &_| {
        let known = if of == before { anew.take() } else { None };
        known.or_else(|| candidate(gp, data, kept, of.0, of.1))
    };
    refit_nearly_best((kept, data), (thinned, NEARLY), fit, |_, _, _| true)
}

/// Models of these rows through at most `most` inducing rows, with the families that were nearly the best before; `None` if the best model
/// of the previously selected kind is not `worth` continuing.
fn induced(
    all: Kept,
    (before, nearly): (&SlopeOutcome, f64),
    most: usize,
    worth: impl Fn(&Kept, &SlopeData, &Candidate) -> bool,
) -> Option<OnAllRows> {
    let data = before.data.of_others(&all, noise_weights(&all, before));
    let fit = |data: &SlopeData, all: &Kept, of, prior: &_| Candidate::induced(data, all, of, prior, most);
    refit_nearly_best((all, data), (before, nearly), fit, worth)
}

/// Steps 6 and 7 on other rows, with the families that were nearly the best before; `None` if the best model of the previously selected
/// kind is not `worth` trying the other kind.
fn refit_nearly_best(
    (kept, data): (Kept, SlopeData),
    (before, nearly): (&SlopeOutcome, f64),
    mut fit: impl FnMut(&SlopeData, &Kept, (Family, ModelKind), &[(Block, f64)]) -> Option<Candidate>,
    worth: impl Fn(&Kept, &SlopeData, &Candidate) -> bool,
) -> Option<OnAllRows> {
    // Sequential, because each fit is parallel in itself, and together they would take several times the memory.
    let mut best = |kind| {
        let tried = nearly_best_of(&before.families, kind, nearly)
            .into_iter()
            .map(|(family, prior)| (family, fit(&data, &kept, (family, kind), prior)));
        let mut families = Vec::new();
        (best_of(tried, kind, &mut families), families)
    };
    let first = best(before.taken.kind);
    if first.0.as_ref().is_none_or(|first| !worth(&kept, &data, first)) {
        return None;
    }
    let ((potential, mut families), (rotation, rotating)) = match before.taken.kind {
        ModelKind::Potential => (first, best(ModelKind::Helmholtz)),
        ModelKind::Helmholtz => (best(ModelKind::Potential), first),
    };
    families.extend(rotating);
    let (taken, other, curl_t) = match (potential, rotation) {
        (Some(potential), Some(rotation)) => {
            let t = curl_t(&potential.left_out, &rotation.left_out, &data.targets.noise_weights, &data.targets.groups);
            let rotates = takes_rotation(t, &potential.contender(), &rotation.contender());
            let (taken, other) = if rotates { (rotation, potential) } else { (potential, rotation) };
            (taken, Some(other), Some(t))
        }
        (potential, rotation) => (potential.or(rotation)?, None, None),
    };
    let outcome = SlopeOutcome { data, taken, other, curl_t, families, least_hidden: false };
    Some(OnAllRows { kept, outcome })
}

/// Families of one kind that predict left-out movements nearly as well as the best of them, with their amplitudes.
fn nearly_best_of(families: &[FamilyReport], kind: ModelKind, nearly: f64) -> Vec<(Family, &[(Block, f64)])> {
    let nearly = nearly_best(families.iter().filter(|report| report.model == kind), nearly);
    nearly.into_iter().filter_map(|report| Some((report.family, &*report.fit.as_ref()?.amplitudes))).collect()
}

/// D of other rows, computed as for the previous ones; rows of stretches have their own.
fn noise_weights(all: &Kept, before: &SlopeOutcome) -> Vec<f64> {
    if let Some(of_stretches) = &all.of_stretches {
        return of_stretches.weights.clone();
    }
    let lengths =
        || before.taken.model.actions(&all.states).column_iter().map(|action| action.norm()).collect::<Vec<_>>();
    match &all.variances {
        Some(variances) => slope_weights(variances, &all.speeds, &lengths()),
        None if before.data.targets.noise_weights.iter().any(|&weight| weight != 1.0) => {
            certain_weights(&all.speeds, &lengths())
        }
        None => vec![1.0; all.speeds.len()],
    }
}
