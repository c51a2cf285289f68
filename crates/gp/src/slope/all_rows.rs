//! Step 10: the models of a search conditioned on all rows, also on those that were thinned.

use rayon::prelude::*;

use crate::Rows;
use crate::kernel::block::Block;
use crate::kernel::family::Family;
use crate::left_out::LeftOut;
use crate::left_out::curl_test::{curl_t, takes_rotation};
use crate::report::trust_report::{FamilyReport, ModelKind};
use crate::rows::kept::{Kept, positions};
use crate::rows::noise_weights::{certain_weights, slope_weights};
use crate::rows::thinning::every_so_many;
use crate::slope::candidate::Candidate;
use crate::slope::data::SlopeData;
use crate::slope::expansion::Expansion;
use crate::slope::search::{Outcome, best_of, candidate, nearly_best};
use crate::slope::slope_gp::SlopeGp;

/// Rows, for each that was kept, up to which the others say nearly the same as those kept.
const MANY: usize = 4;
/// Rows, for each inducing one, beyond which they are thinned.
const MOST: usize = 64;
/// Prior variance that inducing rows leave open, in variances of noise, from which more rows of an exact model say more.
const UNRESOLVED: f64 = 100.0;
/// Rows of that model, for each inducing one, and the share of them that sets amplitudes.
const EXACT: usize = 2;
const HYPER: f64 = 2.0 / 3.0;

/// All rows, and the outcome on them.
pub(crate) struct OnAllRows {
    pub(crate) kept: Kept,
    pub(crate) outcome: Outcome,
}

/// The families and amplitudes of `thinned`, a search on the rows `kept`, compared anew on all rows through inducing ones, or, almost
/// without noise, on more rows. None where not many rows were thinned, where what hides least was chosen, or where held-out movements
/// are predicted worse.
pub(crate) fn on_all_rows(gp: &SlopeGp, rows: &Rows, kept: &Kept, thinned: &Outcome) -> Option<OnAllRows> {
    if gp.inducing_rows == 0 || thinned.least_hidden {
        return None;
    }
    let all = gp.selection().ok()?.keep_all(rows, kept, MOST * gp.inducing_rows)?;
    if all.rows.len() <= MANY * kept.rows.len() {
        return None;
    }
    let of = |kept: &Kept| thinned.data.of_others(kept, noise_weights(kept, thinned));
    let data = of(&all);
    let unresolved = unresolved(gp, &data, thinned);
    let (all, data) = if unresolved {
        let more = more(gp, rows, kept)?;
        let data = of(&more);
        (more, data)
    } else {
        (all, data)
    };
    let mut families = Vec::new();
    let mut best = |kind| {
        let tried = nearly_best_of(&thinned.families, kind).into_par_iter().map(|(family, prior)| {
            let candidate = if unresolved {
                candidate(gp, &data, &all, family, kind)
            } else {
                Candidate::induced(&data, &all, (family, kind), prior, gp.inducing_rows)
            };
            (family, candidate)
        });
        best_of(tried.collect::<Vec<_>>().into_iter(), kind, &mut families)
    };
    let potential = best(ModelKind::Potential)?;
    let rotation = best(ModelKind::Helmholtz);
    let (taken, other, curl_t) = match rotation {
        None => (potential, None, None),
        Some(rotation) => {
            let t = curl_t(&potential.left_out, &rotation.left_out, &data.noise_weights, &data.groups);
            let rotates = takes_rotation(t, &potential.contender(), &rotation.contender());
            let (taken, other) = if rotates { (rotation, potential) } else { (potential, rotation) };
            (taken, Some(other), Some(t))
        }
    };
    let at_kept = positions(&all.rows, &kept.rows);
    let error = |left_out: &LeftOut, row: usize| left_out.residuals[(row, 0)].powi(2);
    let weighed = |of: &dyn Fn(usize) -> f64| -> f64 {
        (0..kept.rows.len()).map(|at| of(at) / thinned.data.noise_weights[at]).sum()
    };
    let before = weighed(&|at| error(&thinned.taken.left_out, at));
    let after = weighed(&|at| error(&taken.left_out, at_kept[at]));
    let outcome = Outcome { data, taken, other, curl_t, families, least_hidden: false };
    (after <= before).then_some(OnAllRows { kept: all, outcome })
}

/// Whether noise is so small that inducing rows leave more open than it does.
fn unresolved(gp: &SlopeGp, data: &SlopeData, thinned: &Outcome) -> bool {
    let Expansion { blocks, amplitudes, .. } = thinned.taken.model.expansion();
    data.open(blocks, amplitudes, gp.inducing_rows) > UNRESOLVED * thinned.taken.model.noise
}

/// The rows kept and others, few enough for an exact model, most of them for amplitudes.
fn more(gp: &SlopeGp, rows: &Rows, kept: &Kept) -> Option<Kept> {
    let more = gp.selection().ok()?.keep_all(rows, kept, EXACT * gp.inducing_rows)?;
    let count = more.rows.len();
    Some(Kept { hyper: every_so_many(count, (HYPER * count as f64) as usize), ..more })
}

/// Families of one kind that predict movements left out nearly as well as the best of them, with their amplitudes.
fn nearly_best_of(families: &[FamilyReport], kind: ModelKind) -> Vec<(Family, &[(Block, f64)])> {
    let nearly = nearly_best(families.iter().filter(|report| report.model == kind));
    nearly.into_iter().filter_map(|report| Some((report.family, &*report.fit.as_ref()?.amplitudes))).collect()
}

/// D of all rows as it was of those kept.
fn noise_weights(all: &Kept, thinned: &Outcome) -> Vec<f64> {
    let lengths =
        || thinned.taken.model.actions(&all.states).column_iter().map(|action| action.norm()).collect::<Vec<_>>();
    match &all.variances {
        Some(variances) => slope_weights(variances, &all.speeds, &lengths()),
        None if thinned.data.noise_weights.iter().any(|&weight| weight != 1.0) => {
            certain_weights(&all.speeds, &lengths())
        }
        None => vec![1.0; all.speeds.len()],
    }
}
