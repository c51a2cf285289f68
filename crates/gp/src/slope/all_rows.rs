//! Step 10: the models of a search conditioned on all rows, also on those that were thinned.

use crate::Rows;
use crate::left_out::LeftOut;
use crate::left_out::curl_test::{curl_t, takes_rotation};
use crate::report::trust_report::ModelKind;
use crate::rows::kept::{Kept, positions};
use crate::rows::noise_weights::{certain_weights, slope_weights};
use crate::slope::candidate::Candidate;
use crate::slope::search::Outcome;
use crate::slope::slope_gp::SlopeGp;

/// Rows, for each that was kept, up to which the others say nearly the same as those kept.
const MANY: usize = 4;
/// Rows, for each inducing one, beyond which they are thinned.
const MOST: usize = 64;

/// All rows, and the outcome on them.
pub(crate) struct OnAllRows {
    pub(crate) kept: Kept,
    pub(crate) outcome: Outcome,
}

/// The families, amplitudes and kinds of model of `thinned`, a search on the rows `kept`, on all rows through inducing ones. None where
/// not many rows were thinned, where what hides least was chosen, or where held-out movements are predicted worse.
pub(crate) fn on_all_rows(gp: &SlopeGp, rows: &Rows, kept: &Kept, thinned: &Outcome) -> Option<OnAllRows> {
    if gp.inducing_rows == 0 || thinned.least_hidden {
        return None;
    }
    let all = gp.selection().ok()?.keep_all(rows, kept, MOST * gp.inducing_rows)?;
    if all.rows.len() <= MANY * kept.rows.len() {
        return None;
    }
    let data = thinned.data.of_others(&all, noise_weights(&all, thinned));
    let induced = |candidate: &Candidate| candidate.induced(&data, &all, gp.inducing_rows);
    let taken = induced(&thinned.taken)?;
    let other = thinned.other.as_ref().and_then(induced);
    let (taken, other, curl_t) = match other {
        None => (taken, None, None),
        Some(other) => {
            let (potential, rotation) = match taken.kind {
                ModelKind::Potential => (taken, other),
                ModelKind::Helmholtz => (other, taken),
            };
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
    let outcome = Outcome { data, taken, other, curl_t, families: thinned.families.clone(), least_hidden: false };
    (after <= before).then_some(OnAllRows { kept: all, outcome })
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
