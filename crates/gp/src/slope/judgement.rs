//! The trust report of a slope GP: section 7, and (R6).

use nalgebra::{DMatrix, DVectorView};
use rayon::prelude::*;

use crate::Rows;
use crate::left_out::comparison::{difference, spread};
use crate::report::identifiability::{Identifiability, LeastSeen};
use crate::report::trust_report::{ModelKind, TrustReport};
use crate::rows::kept::Kept;
use crate::slope::model::SlopeModel;
use crate::slope::search::{Candidate, Outcome};

/// States at which uncertainty is averaged, at most.
const STATES: usize = 200;
/// States whose triangular systems are solved together.
const TOGETHER: usize = 10;
/// The other model counts if it predicts at most so much worse.
const NEARLY_AS_GOOD: f64 = 1.5;
/// Probability from which a switch is counted.
const SWITCHED: f64 = 0.5;

/// What a report is about.
pub(crate) struct Chosen<'a> {
    pub(crate) outcome: &'a Outcome,
    pub(crate) kept: &'a Kept,
    pub(crate) rows: &'a Rows,
}

pub(crate) fn report(chosen: &Chosen<'_>) -> TrustReport {
    let Chosen { outcome, kept, rows } = chosen;
    let Outcome { data, taken, other, curl_t, families } = outcome;
    let (posterior, prior) = mean_covariances(&taken.model, &kept.states);
    let ambiguity = other.as_ref().map_or(0.0, |other| ambiguity(taken, other));
    let states = every_so_many(kept.states.ncols());
    let variance = spread(&taken.actions.select_columns(&states)) / states.len() as f64;
    let error = posterior.trace() * taken.left_out.z_squared.max(1.0) / variance;
    // Before its first sample every movement begins.
    let after_first = |switches: &Vec<f64>| switches.iter().skip(1).filter(|&&p| p > SWITCHED).count();
    let count = |switches: &[Vec<f64>]| switches.iter().map(after_first).sum();
    TrustReport {
        r_squared: taken.left_out.r_squared,
        z_squared: taken.left_out.z_squared,
        expected_nupe: error + ambiguity + rows.step_change().unwrap_or(0.0),
        ambiguity,
        identifiability: Identifiability::of(&posterior, &prior),
        least_seen: LeastSeen::of(&data.n),
        curl_t: *curl_t,
        rotational_share: rotational_share(taken, &kept.states),
        model: taken.kind,
        family: taken.family,
        families: families.clone(),
        rows: kept.speeds.len(),
        rows_dropped: kept.dropped,
        grouping: kept.grouping,
        noise: rows.noise(),
        switches: rows.switches().map(count),
    }
}

/// Δ of (R6).
fn ambiguity(taken: &Candidate, other: &Candidate) -> f64 {
    let nearly = 1.0 - other.left_out.r_squared <= NEARLY_AS_GOOD * (1.0 - taken.left_out.r_squared);
    if nearly { difference(&taken.actions, &other.actions) } else { 0.0 }
}

/// At most `STATES` rows, evenly spaced.
fn every_so_many(count: usize) -> Vec<usize> {
    let states = count.min(STATES);
    (0..states).map(|at| at * count / states).collect()
}

/// Mean of (S13) at some rows' states, and of what it was before anything was observed.
fn mean_covariances(model: &SlopeModel, states: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let at = every_so_many(states.ncols());
    let sums = |rows: &[usize]| {
        let states: Vec<DVectorView<'_, f64>> = rows.iter().map(|&row| states.column(row)).collect();
        let posterior: DMatrix<f64> = model.covariances(&states).iter().sum();
        let prior: DMatrix<f64> = states.iter().map(|state| model.prior_covariance(*state)).sum();
        (posterior, prior)
    };
    let parts: Vec<_> = at.par_chunks(TOGETHER).map(sums).collect();
    let zero = DMatrix::zeros(states.nrows(), states.nrows());
    let (posterior, prior) =
        parts.into_iter().fold((zero.clone(), zero), |(posterior, prior), part| (posterior + part.0, prior + part.1));
    (posterior / at.len() as f64, prior / at.len() as f64)
}

fn rotational_share(taken: &Candidate, states: &DMatrix<f64>) -> f64 {
    match taken.kind {
        ModelKind::Potential => 0.0,
        ModelKind::Helmholtz => {
            let rotation = taken.model.rotational_part().expansion.actions(states);
            rotation.norm_squared() / taken.actions.norm_squared()
        }
    }
}
