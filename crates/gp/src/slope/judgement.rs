//! The trust report of a slope GP, with the expected error on new movements (R6), (S19).

use motion::{LeastSeen, spread};
use nalgebra::{DMatrix, DVectorView};
use rayon::prelude::*;

use crate::Rows;
use crate::kernel::covariance::NOISE_FLOOR;
use crate::left_out::LeftOutPredictions;
use crate::left_out::common_error::common_error;
use crate::left_out::comparison::difference;
use crate::left_out::typical::typical_mean;
use crate::report::identifiability::{Identifiability, least_seen};
use crate::report::trust_report::{ModelKind, TrustReport};
use crate::rows::kept::{Grouping, Kept};
use crate::rows::thinning::every_so_many;
use crate::slope::candidate::Candidate;
use crate::slope::cross_path::CrossPathEvidence;
use crate::slope::data::SlopeData;
use crate::slope::search::SlopeOutcome;

/// The error of predicting the mean alone; a wider posterior adds no information.
pub(crate) const NOTHING_KNOWN: f64 = 1.0;

/// Maximum number of states over which uncertainty is averaged.
const STATES: usize = 200;
/// Number of states whose triangular systems are solved together.
const TOGETHER: usize = 10;
/// The other model counts if its 1 − R² is at most this many times as large.
const NEARLY_AS_GOOD: f64 = 1.5;
/// Probability above which a switch is counted.
const SWITCHED: f64 = 0.5;

/// Inputs of a report.
pub(crate) struct ReportInput<'a> {
    pub(crate) outcome: &'a SlopeOutcome,
    pub(crate) kept: &'a Kept,
    pub(crate) rows: &'a Rows,
    pub(crate) across: CrossPathEvidence,
}

pub(crate) fn report(chosen: &ReportInput<'_>) -> TrustReport {
    let ReportInput { outcome, kept, rows, across } = chosen;
    let SlopeOutcome { data, taken, other, curl_t, families, .. } = outcome;
    let CovariancesAtRows { traces, posterior, prior } = covariances_at_rows(taken, kept, data);
    let ambiguity = other.as_ref().map_or(0.0, |other| ambiguity(taken, other));
    let noise = noise(data, taken);
    let common =
        common_error(&taken.left_out, &data.n, (taken.model.noise, &data.targets.noise_weights), &data.targets.groups);
    let least_seen = least_seen(&data.n);
    let blind = kept.grouping == Grouping::BlocksOfTime || least_seen.coverage() < LeastSeen::COVERED;
    let across = if blind { CrossPathEvidence::Untested } else { *across };
    let calibration = calibration((standardised(data, taken), common), noise_share(data, taken), across);
    let variance = spread(&taken.actions) / kept.speeds.len() as f64;
    let error = calibration * traces.max(on_new_movements(data, taken, &noise)) / variance;
    // Skips the first sample, at which every movement begins.
    let after_first = |switches: &Vec<f64>| switches.iter().skip(1).filter(|&&p| p > SWITCHED).count();
    let count = |switches: &[Vec<f64>]| switches.iter().map(after_first).sum();
    let pushes = kept.of_stretches.as_ref().and_then(|of| of.pushes.as_ref());
    TrustReport {
        r_squared: taken.left_out.r_squared,
        z_squared: taken.left_out.z_squared,
        calibration: Some(calibration),
        expected_nupe: (error + ambiguity + rows.step_change().unwrap_or(0.0)).min(NOTHING_KNOWN),
        ambiguity,
        identifiability: Identifiability::of(&posterior, &prior),
        least_seen,
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
        push: pushes.map(|of| of.root_mean_square(&taken.model.actions(&of.states)) / root_mean_square(&taken.actions)),
    }
}

/// Trace of the policy's covariance on new movements, as estimated from left-out ones along their motion, in squared units of the state per
/// second (S19).
fn on_new_movements(data: &SlopeData, taken: &Candidate, noise: &[f64]) -> f64 {
    let along = |row: usize| (taken.left_out.variances[row] - noise[row]).max(0.0);
    let rows = 0..noise.len();
    data.n.nrows() as f64 * data.unit.powi(2) * of_movements(rows.map(|row| (row, along(row))), data)
}

/// Expected z² (S11) on new movements (S43).
fn standardised(data: &SlopeData, taken: &Candidate) -> f64 {
    let LeftOutPredictions { residuals, variances, .. } = &taken.left_out;
    let each = residuals.iter().zip(variances).map(|(residual, variance)| residual * residual / variance);
    of_movements(each.enumerate(), data)
}

/// (S43) for the movements' means of numbers at some rows.
fn of_movements(numbers: impl Iterator<Item = (usize, f64)>, data: &SlopeData) -> f64 {
    let mut of_row = vec![None; data.n.ncols()];
    numbers.for_each(|(row, number)| of_row[row] = Some(number));
    let of_group = |rows: &Vec<usize>| {
        let numbers: Vec<f64> = rows.iter().filter_map(|&row| of_row[row]).collect();
        let count = numbers.len() as f64;
        (count > 0.0).then(|| (numbers.iter().sum::<f64>() / count, count))
    };
    let (means, counts): (Vec<f64>, Vec<f64>) = data.targets.groups.iter().filter_map(of_group).unzip();
    typical_mean(&means, &counts)
}

/// Noise variance of each row in the model, including the floor, (M), scaled.
fn noise(data: &SlopeData, taken: &Candidate) -> Vec<f64> {
    data.targets.noise_weights.iter().map(|weight| (taken.model.noise + NOISE_FLOOR) * weight).collect()
}

/// Share of noise in the predictive variance of left-out movements, with the weights of (S11).
fn noise_share(data: &SlopeData, taken: &Candidate) -> f64 {
    let each = taken.left_out.variances.iter().zip(&data.targets.noise_weights);
    let predicted: f64 = each.map(|(variance, weight)| variance / weight).sum();
    taken.model.noise * data.targets.noise_weights.len() as f64 / predicted
}

/// γ of (S19): factor on the posterior variance, determined by the errors on left-out movements: z² (S11), and `common`, the part that
/// neighbouring errors share (S42). A value below 1 is informative about the posterior only if noise is a small part of the predictive
/// variance, and about all directions only if left-out movements went in other directions than the learnt ones.
fn calibration((z_squared, common): (f64, f64), noise_share: f64, across: CrossPathEvidence) -> f64 {
    let least = match across {
        CrossPathEvidence::Tested => noise_share.min(1.0),
        CrossPathEvidence::Untested => 1.0,
    };
    z_squared.max(common).max(least)
}

pub(crate) fn root_mean_square(actions: &DMatrix<f64>) -> f64 {
    (actions.norm_squared() / actions.ncols() as f64).sqrt()
}

/// Δ of (R6).
fn ambiguity(taken: &Candidate, other: &Candidate) -> f64 {
    let nearly = 1.0 - other.left_out.r_squared <= NEARLY_AS_GOOD * (1.0 - taken.left_out.r_squared);
    if nearly { difference(&taken.actions, &other.actions) } else { 0.0 }
}

/// (S13) at some rows.
struct CovariancesAtRows {
    /// Expected trace on movements like those of the rows (S43).
    traces: f64,
    /// Mean posterior covariance, (n, n), and mean prior covariance.
    posterior: DMatrix<f64>,
    prior: DMatrix<f64>,
}

fn covariances_at_rows(taken: &Candidate, kept: &Kept, data: &SlopeData) -> CovariancesAtRows {
    let at = every_so_many(kept.states.ncols(), STATES);
    let sums_over = |rows: &[usize]| {
        let states: Vec<DVectorView<'_, f64>> = rows.iter().map(|&row| kept.states.column(row)).collect();
        let posterior = taken.model.covariances(&states);
        let traces: Vec<f64> = posterior.iter().map(DMatrix::trace).collect();
        let prior: DMatrix<f64> = states.iter().map(|state| taken.model.prior_covariance(*state)).sum();
        (traces, posterior.into_iter().sum::<DMatrix<f64>>(), prior)
    };
    let parts: Vec<_> = at.par_chunks(TOGETHER).map(sums_over).collect();
    let moving = taken.model.expansion().moving();
    let (mut posterior, mut prior) = (DMatrix::zeros(moving, moving), DMatrix::zeros(moving, moving));
    let mut traces = Vec::with_capacity(at.len());
    for part in parts {
        traces.extend(part.0);
        posterior += part.1;
        prior += part.2;
    }
    let count = at.len() as f64;
    let traces = of_movements(at.into_iter().zip(traces.into_iter().map(|trace| trace.max(0.0))), data);
    CovariancesAtRows { traces, posterior: posterior / count, prior: prior / count }
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
        /// Errors larger than predicted always widen the posterior. Smaller errors narrow it only in tested directions, and never below
        /// either measure or the share of noise.
        #[test]
        fn only_tested_directions_narrow_the_posterior(z_squared in 0.0f64..9.0, common in 0.0f64..9.0, noise in 0.0f64..1.0) {
            let tested = calibration((z_squared, common), noise, CrossPathEvidence::Tested);
            let untested = calibration((z_squared, common), noise, CrossPathEvidence::Untested);
            prop_assert_eq!(untested, z_squared.max(common).max(1.0));
            prop_assert!(tested <= untested && tested >= z_squared && tested >= common && tested >= noise);
            prop_assert!([z_squared, common, noise].contains(&tested));
        }
    }
}
