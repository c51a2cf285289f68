//! Step 10: the models of a search on more rows than those that were kept: exactly on some, through inducing rows on all.

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
use crate::slope::search::{NEARLY, Outcome, best_of, candidate, nearly_best};
use crate::slope::slope_gp::SlopeGp;

/// Rows of certain velocities, for each that was kept, up to which the others say nearly the same as those kept.
const MANY: usize = 4;
/// Rows of an exact model beside those kept, and how many of both set amplitudes, at least.
const EXACT: usize = 1500;
const HYPER: usize = 400;
/// Left-out error of a model of more noisy rows, in errors of one of fewer, up to which it is taken.
const ALLOWED: f64 = 1.05;
/// Left-out error of a model of some rows through inducing ones, in errors of an exact one, up to which it is taken.
const CLEARLY: f64 = 0.7;
/// Multiple of the least error so far above which the other kind of model is not tried through inducing rows.
const HOPELESS: f64 = 2.0;
/// Families of exact models with at most so many times the least 1 − R² are tried through inducing rows.
const ABOUT: f64 = 1.2;
/// Rows, for each inducing one, on which families are compared where there are several times as many, and beyond which they are thinned.
const FEW: usize = 16;
const SEVERAL: usize = 3;
const MOST: usize = 64;
/// Inducing rows beyond which rows are not more: time goes with the square of the former.
const INDUCING: usize = 500;

/// More rows, and the outcome on them.
pub(crate) struct OnAllRows {
    pub(crate) kept: Kept,
    pub(crate) outcome: Outcome,
}

/// [`on_all_rows`] of rows of samples.
pub(crate) fn on_all_samples(gp: &SlopeGp, rows: &Rows, kept: &Kept, thinned: &Outcome) -> Option<OnAllRows> {
    let selection = gp.selection().ok()?;
    let at_most = |most| selection.keep_all(rows, kept, most);
    on_all_rows(gp, More { at_most: &at_most, noisy: rows.variances().is_some() }, kept, thinned)
}

/// Where more rows than those kept come from.
pub(crate) struct More<'a> {
    /// Those kept and about so many of the others; none if there are no others.
    pub(crate) at_most: &'a dyn Fn(usize) -> Option<Kept>,
    /// Whether their velocities are uncertain.
    pub(crate) noisy: bool,
}

/// `thinned`, a search on the rows `kept`, on more rows: the best families again, first exactly with amplitudes anew, then those of
/// them that are still good on rows through inducing ones, and the best of these on all rows. None where not many rows were thinned, where what hides least was
/// chosen, or where the movements of `kept` are predicted best without these rows.
pub(crate) fn on_all_rows(
    gp: &SlopeGp,
    More { at_most, noisy }: More<'_>,
    kept: &Kept,
    thinned: &Outcome,
) -> Option<OnAllRows> {
    if gp.inducing_rows == 0 || thinned.least_hidden {
        return None;
    }
    let more = at_most(EXACT)?;
    let beyond = more.dropped.thinned;
    if !noisy && more.rows.len() + beyond <= MANY * kept.rows.len() {
        return None;
    }
    let judge = Judge { weights: &thinned.data.noise_weights, rows: &kept.rows };
    let error = |tried: &OnAllRows| judge.error(&tried.kept, &tried.outcome.data, &tried.outcome.taken);
    let exact = if gp.max_rows < EXACT { exact(gp, &more, thinned, &judge) } else { None };
    let thinned_error = judge.error(kept, &thinned.data, &thinned.taken);
    let least = exact.as_ref().map_or(thinned_error, |exact| error(exact).min(thinned_error));
    let worth = |all: &Kept, data: &SlopeData, of: &Candidate| judge.error(all, data, of) <= HOPELESS * least;
    let before = exact.as_ref().map_or(thinned, |exact| &exact.outcome);
    let (some, all) = if beyond == 0 { (None, None) } else { all_induced(gp, at_most, before, worth) };
    // Of noisy rows too few are kept to tell nearly equal models apart: the one of more rows knows more.
    let allowed = if noisy { ALLOWED } else { 1.0 };
    let all = all.filter(|all| error(all) <= allowed * least);
    // More rows than an exact model has, but seen through fewer: it knows more only if it predicts clearly better.
    let some = some.filter(|some| error(some) <= CLEARLY * least);
    all.or(some).or_else(|| exact.filter(|exact| error(exact) <= allowed * thinned_error))
}

/// Models through inducing rows: of some rows where there are several times as many, with the families that were nearly the best before,
/// and of all with those that are the best then.
fn all_induced(
    gp: &SlopeGp,
    at_most: &dyn Fn(usize) -> Option<Kept>,
    before: &Outcome,
    worth: impl Fn(&Kept, &SlopeData, &Candidate) -> bool,
) -> (Option<OnAllRows>, Option<OnAllRows>) {
    let [some, all] = [FEW, MOST].map(|rows| at_most(rows * gp.inducing_rows.min(INDUCING)));
    let (Some(some), Some(all)) = (some, all) else { return (None, None) };
    if all.rows.len() < SEVERAL * some.rows.len() {
        return (None, induced(gp, all, (before, ABOUT), worth));
    }
    let some = induced(gp, some, (before, ABOUT), &worth);
    let all = some.as_ref().and_then(|some| induced(gp, all, (&some.outcome, 1.0), worth));
    (some, all)
}

/// Compares models on the rows that were kept, which all of them have.
struct Judge<'a> {
    /// D of these rows.
    weights: &'a [f64],
    rows: &'a [usize],
}

impl Judge<'_> {
    /// Σ w e² in squared units of speed, each movement left out of a model of `all` rows.
    fn error(&self, all: &Kept, data: &SlopeData, of: &Candidate) -> f64 {
        let places = positions(&all.rows, self.rows);
        let each = places.into_iter().zip(self.weights);
        each.map(|(at, weight)| (data.speed * of.left_out.residuals[(at, 0)]).powi(2) / weight).sum()
    }
}

/// Models of few enough rows to be exact, with amplitudes of those. Where the model taken before predicts nearly exactly, prediction depends on the
/// units of z and y: they are those of `thinned` or of these rows, whichever that model predicts better in.
fn exact(gp: &SlopeGp, more: &Kept, thinned: &Outcome, judge: &Judge<'_>) -> Option<OnAllRows> {
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
    compared((kept, data), (thinned, NEARLY), fit, |_, _, _| true)
}

/// Models of these rows through inducing ones, with the families that were nearly the best before; none if those like the one taken
/// then are not `worth` more.
fn induced(
    gp: &SlopeGp,
    all: Kept,
    (before, nearly): (&Outcome, f64),
    worth: impl Fn(&Kept, &SlopeData, &Candidate) -> bool,
) -> Option<OnAllRows> {
    let data = before.data.of_others(&all, noise_weights(&all, before));
    let most = gp.inducing_rows;
    let fit = |data: &SlopeData, all: &Kept, of, prior: &_| Candidate::induced(data, all, of, prior, most);
    compared((all, data), (before, nearly), fit, worth)
}

/// Steps 6 and 7 on other rows, with the families that were nearly the best before; none if the best model of the kind taken before is not `worth`
/// the other kind.
fn compared(
    (kept, data): (Kept, SlopeData),
    (before, nearly): (&Outcome, f64),
    mut fit: impl FnMut(&SlopeData, &Kept, (Family, ModelKind), &[(Block, f64)]) -> Option<Candidate>,
    worth: impl Fn(&Kept, &SlopeData, &Candidate) -> bool,
) -> Option<OnAllRows> {
    // One after the other: each is parallel in itself, and together they would take several times the memory.
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
            let t = curl_t(&potential.left_out, &rotation.left_out, &data.noise_weights, &data.groups);
            let rotates = takes_rotation(t, &potential.contender(), &rotation.contender());
            let (taken, other) = if rotates { (rotation, potential) } else { (potential, rotation) };
            (taken, Some(other), Some(t))
        }
        (potential, rotation) => (potential.or(rotation)?, None, None),
    };
    let outcome = Outcome { data, taken, other, curl_t, families, least_hidden: false };
    Some(OnAllRows { kept, outcome })
}

/// Families of one kind that predict movements left out nearly as well as the best of them, with their amplitudes.
fn nearly_best_of(families: &[FamilyReport], kind: ModelKind, nearly: f64) -> Vec<(Family, &[(Block, f64)])> {
    let nearly = nearly_best(families.iter().filter(|report| report.model == kind), nearly);
    nearly.into_iter().filter_map(|report| Some((report.family, &*report.fit.as_ref()?.amplitudes))).collect()
}

/// D of other rows as it was of those before; rows of stretches have theirs.
fn noise_weights(all: &Kept, before: &Outcome) -> Vec<f64> {
    if let Some(of_stretches) = &all.of_stretches {
        return of_stretches.weights.clone();
    }
    let lengths =
        || before.taken.model.actions(&all.states).column_iter().map(|action| action.norm()).collect::<Vec<_>>();
    match &all.variances {
        Some(variances) => slope_weights(variances, &all.speeds, &lengths()),
        None if before.data.noise_weights.iter().any(|&weight| weight != 1.0) => {
            certain_weights(&all.speeds, &lengths())
        }
        None => vec![1.0; all.speeds.len()],
    }
}
