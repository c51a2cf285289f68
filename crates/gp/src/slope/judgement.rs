//! The trust report of a slope GP, with the error to expect on new movements (R6), (S19).

use nalgebra::{DMatrix, DVectorView};
use rayon::prelude::*;

use crate::Rows;
use crate::kernel::covariance::NOISE_FLOOR;
use crate::left_out::comparison::{difference, spread};
use crate::report::identifiability::{Identifiability, LeastSeen};
use crate::report::trust_report::{ModelKind, TrustReport};
use crate::rows::kept::Kept;
use crate::rows::thinning::every_so_many;
use crate::slope::candidate::Candidate;
use crate::slope::data::SlopeData;
use crate::slope::model::SlopeModel;
use crate::slope::search::Outcome;

/// As large an error as that of the mean alone: a posterior that is wider says no more.
pub(crate) const NOTHING_KNOWN: f64 = 1.0;

/// States at which uncertainty is averaged, at most.
const STATES: usize = 200;
/// States whose triangular systems are solved together.
const TOGETHER: usize = 10;
/// The other model counts if it predicts at most so much worse.
const NEARLY_AS_GOOD: f64 = 1.5;
/// Probability from which a switch is counted.
const SWITCHED: f64 = 0.5;

/// By how much a posterior that left-out movements confirm was too narrow, at most.
const OPTIMISTIC: f64 = 2.0;

/// Input of a report.
pub(crate) struct ReportInput<'a> {
    pub(crate) outcome: &'a Outcome,
    pub(crate) kept: &'a Kept,
    pub(crate) rows: &'a Rows,
    pub(crate) across: CrossPathEvidence,
}

/// Whether movements passed the same places in other directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CrossPathEvidence {
    /// Constraints varied: held-out movements test the policy across the paths of the others.
    Tested,
    /// All movements may have gone alike, so that nothing tested the policy across them.
    Untested,
}

pub(crate) fn report(chosen: &ReportInput<'_>) -> TrustReport {
    let ReportInput { outcome, kept, rows, across } = chosen;
    let Outcome { data, taken, other, curl_t, families, .. } = outcome;
    let (posterior, prior) = mean_covariances(&taken.model, &kept.states);
    let ambiguity = other.as_ref().map_or(0.0, |other| ambiguity(taken, other));
    let calibration = calibration(taken.left_out.z_squared, noise_share(data, taken), *across);
    let variance = spread(&taken.actions) / kept.speeds.len() as f64;
    let error = calibration * posterior.trace().max(on_new_movements(data, taken)) / variance;
    // Before its first sample every movement begins.
    let after_first = |switches: &Vec<f64>| switches.iter().skip(1).filter(|&&p| p > SWITCHED).count();
    let count = |switches: &[Vec<f64>]| switches.iter().map(after_first).sum();
    TrustReport {
        r_squared: taken.left_out.r_squared,
        z_squared: taken.left_out.z_squared,
        calibration: Some(calibration),
        expected_nupe: (error + ambiguity + rows.step_change().unwrap_or(0.0)).min(NOTHING_KNOWN),
        ambiguity,
        identifiability: Identifiability::of(&posterior, &prior),
        least_seen: LeastSeen::of(&data.n),
        curl_t: *curl_t,
        rotational_share: rotational_share(taken, &kept.states),
        model: taken.kind,
        family: taken.family,
        families: families.clone(),
        rows: kept.speeds.len(),
        inducing: taken.model.inducing(),
        rows_dropped: kept.dropped,
        grouping: kept.grouping,
        noise: rows.noise(),
        switches: rows.switches().map(count),
        task_space: kept.of_stretches.as_ref().and_then(|of| of.space),
        push: kept.of_stretches.as_ref().and_then(|of| of.push).map(|push| push / root_mean_square(&taken.actions)),
    }
}

/// Trace of the policy's covariance on movements that were not shown, as far as those left out say along their motion, in
/// squared units of the state per second (S19).
fn on_new_movements(data: &SlopeData, taken: &Candidate) -> f64 {
    let noise = taken.model.noise + NOISE_FLOOR;
    let each = taken.left_out.variances.iter().zip(&data.noise_weights);
    let along: f64 = each.map(|(variance, weight)| (variance - noise * weight).max(0.0)).sum();
    let (dim, rows) = data.n.shape();
    dim as f64 * data.speed.powi(2) * along / rows as f64
}

/// Share of noise in the variance predicted of left-out movements, by the weights of (S11).
fn noise_share(data: &SlopeData, taken: &Candidate) -> f64 {
    let each = taken.left_out.variances.iter().zip(&data.noise_weights);
    let predicted: f64 = each.map(|(variance, weight)| variance / weight).sum();
    taken.model.noise * data.noise_weights.len() as f64 / predicted
}

/// γ of (S19): factor on the posterior's variance, from how left-out movements were predicted: z² (S11) where that is over 1, since
/// the posterior is then too narrow. A z² under 1 tells something of the posterior only as far as noise is a small part of the
/// variance predicted, and of all directions only where movements left out went in others than those learnt from.
fn calibration(z_squared: f64, noise_share: f64, across: CrossPathEvidence) -> f64 {
    let least = match across {
        CrossPathEvidence::Tested => (OPTIMISTIC * z_squared).max(noise_share).min(1.0),
        CrossPathEvidence::Untested => 1.0,
    };
    z_squared.max(least)
}

fn root_mean_square(actions: &DMatrix<f64>) -> f64 {
    (actions.norm_squared() / actions.ncols() as f64).sqrt()
}

/// Δ of (R6).
fn ambiguity(taken: &Candidate, other: &Candidate) -> f64 {
    let nearly = 1.0 - other.left_out.r_squared <= NEARLY_AS_GOOD * (1.0 - taken.left_out.r_squared);
    if nearly { difference(&taken.actions, &other.actions) } else { 0.0 }
}

/// Mean of (S13) at some rows' states, and of what it was before anything was observed.
fn mean_covariances(model: &SlopeModel, states: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let at = every_so_many(states.ncols(), STATES);
    let sums = |rows: &[usize]| {
        let states: Vec<DVectorView<'_, f64>> = rows.iter().map(|&row| states.column(row)).collect();
        let posterior: DMatrix<f64> = model.covariances(&states).iter().sum();
        let prior: DMatrix<f64> = states.iter().map(|state| model.prior_covariance(*state)).sum();
        (posterior, prior)
    };
    let parts: Vec<_> = at.par_chunks(TOGETHER).map(sums).collect();
    let moving = model.expansion().moving();
    let zero = DMatrix::zeros(moving, moving);
    let (posterior, prior) =
        parts.into_iter().fold((zero.clone(), zero), |(posterior, prior), part| (posterior + part.0, prior + part.1));
    (posterior / at.len() as f64, prior / at.len() as f64)
}

fn rotational_share(taken: &Candidate, states: &DMatrix<f64>) -> f64 {
    match taken.kind {
        ModelKind::Potential => 0.0,
        ModelKind::Helmholtz => {
            let rotation = taken.model.rotational_part().expansion.actions(states.as_view());
            rotation.norm_squared() / taken.actions.norm_squared()
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Errors larger than predicted always widen; smaller ones narrow only what they have tested, and never below
        /// twice what they say or the share of noise.
        #[test]
        fn a_posterior_is_narrowed_only_by_what_tested_it(z_squared in 0.0f64..9.0, noise in 0.0f64..1.0) {
            let tested = calibration(z_squared, noise, CrossPathEvidence::Tested);
            let untested = calibration(z_squared, noise, CrossPathEvidence::Untested);
            prop_assert_eq!(untested, z_squared.max(1.0));
            prop_assert!(tested <= untested && tested >= z_squared && tested >= noise);
            prop_assert!(tested >= (2.0 * z_squared).min(1.0));
            prop_assert!(tested == untested || tested == 2.0 * z_squared || tested == noise);
        }
    }
}
