//! The direct GP of the rows that move freely, if constraints deflected only some (R10).

use nalgebra::DMatrix;

use crate::direct::direct_gp::{DirectOutcome, fit_direct};
use crate::kernel::family::Family;
use crate::rows::kept::Kept;

/// Rows count as free if their squared left-out error is at most this multiple of a low quantile.
const USUAL: f64 = 10.0;
/// That quantile. Most rows below it are free even if only half of all rows are.
const QUANTILE: f64 = 0.3;
/// Smallest limit on the squared error, in mean squares of a velocity component.
const LEAST: f64 = 1e-10;
/// Rows above the limit are worth another fit if they make this share of the squared errors; with noise alone they make less.
const WORTH: f64 = 0.5;
/// Smallest share of free rows in any fit. From fewer, later fits hardly reach the half that counts.
const LEAST_FREE: f64 = 0.4;
/// Largest share of deflections along the motion, in that of noise, with which another fit may help.
const HOPELESS: f64 = 0.6;
/// Maximum number of fits.
const ROUNDS: usize = 6;
/// Variance added to deflected velocities, in mean squares of a component: they count no more.
const IGNORED: f64 = 1e4;

/// The direct GP of the free rows.
pub(crate) struct FreeRowsFit {
    pub(crate) direct: DirectOutcome,
    /// Whether each row is free, (M).
    pub(crate) free: Vec<bool>,
    /// Largest |u − û| of a free row, in units of the state per second.
    pub(crate) within: f64,
    /// Share of the deflected rows' squared left-out errors along their motion.
    pub(crate) along: f64,
}

impl FreeRowsFit {
    fn new(direct: DirectOutcome, free: Vec<bool>, within: f64, kept: &Kept) -> FreeRowsFit {
        let (mut along, mut all) = (0.0, 0.0);
        for row in (0..free.len()).filter(|&row| !free[row]) {
            let error = direct.left_out.residuals.row(row);
            along += ((error * kept.velocities.column(row)).x / kept.speeds[row]).powi(2);
            all += error.norm_squared();
        }
        FreeRowsFit { direct, free, within, along: along / all }
    }

    /// Repeats the fit, with one family, without the rows that it predicts worst until these no longer change; at last with all families.
    /// `None` if `all`, the fit of all rows, has no such rows or too many, or if they do not look like deflected ones.
    pub(crate) fn of(families: &[Family], kept: &Kept, all: &DirectOutcome) -> Option<FreeRowsFit> {
        if all.left_out.is_nearly_exact() {
            return None;
        }
        let mut found: Option<FreeRowsFit> = None;
        for _ in 0..ROUNDS {
            let direct = found.as_ref().map_or(all, |found| &found.direct);
            let errors: Vec<f64> = direct.left_out.residuals.row_iter().map(|row| row.norm_squared()).collect();
            let limit = free_error_limit(&errors);
            if found.is_none() && !deflections_dominate(&errors, limit) {
                return None;
            }
            let free: Vec<bool> = errors.iter().map(|&error| error <= limit).collect();
            if found.as_ref().is_some_and(|found| found.free == free) {
                break;
            }
            if free.iter().filter(|&&free| free).count() < (LEAST_FREE * free.len() as f64) as usize {
                return None;
            }
            let within = direct.fit.model.unit * limit.sqrt();
            let direct = fit_direct(&[all.fit.family], &without_deflected(kept, &free)).ok()?;
            let next = FreeRowsFit::new(direct, free, within, kept);
            if found.is_some() && next.along * kept.velocities.nrows() as f64 > HOPELESS {
                return None;
            }
            found = Some(next);
        }
        let found = found?;
        if found.direct.left_out.is_exact() || families.len() == 1 {
            return Some(found);
        }
        let direct = fit_direct(families, &without_deflected(kept, &found.free)).ok()?;
        Some(FreeRowsFit::new(direct, found.free, found.within, kept))
    }

    /// The same model on all rows, those near its predictions free, through at most `most` of them; `None` without a Cholesky factor.
    pub(crate) fn on_all_rows(&self, all: &Kept, most: usize) -> Option<FreeRowsFit> {
        let within = self.within;
        let free = within_distance(&self.direct.fit.model.moving_actions(all.states.as_view()), all.observed(), within);
        let direct = self.direct.on_all_rows(&without_deflected(all, &free), most)?;
        Some(FreeRowsFit::new(direct, free, within, all))
    }
}

/// Whether each velocity, (n, M), is within a distance of its prediction.
pub(crate) fn within_distance(predicted: &DMatrix<f64>, observed: &DMatrix<f64>, within: f64) -> Vec<bool> {
    predicted.column_iter().zip(observed.column_iter()).map(|(expected, u)| (u - expected).norm() <= within).collect()
}

fn free_error_limit(errors: &[f64]) -> f64 {
    let mut sorted = errors.to_vec();
    sorted.sort_by(f64::total_cmp);
    (USUAL * sorted[(QUANTILE * sorted.len() as f64) as usize]).max(LEAST)
}

fn deflections_dominate(errors: &[f64], limit: f64) -> bool {
    let above: f64 = errors.iter().filter(|&&error| error > limit).sum();
    above >= WORTH * errors.iter().sum::<f64>()
}

/// The same rows, deflected ones with a variance so large that they do not count.
fn without_deflected(kept: &Kept, free: &[bool]) -> Kept {
    let ignored = IGNORED * kept.observed().norm_squared() / kept.observed().len() as f64;
    let known = |row: usize| kept.variances.as_ref().map_or(0.0, |variances| variances[row]);
    let variance = |(row, &free): (usize, &bool)| known(row) + if free { 0.0 } else { ignored };
    Kept { variances: Some(free.iter().enumerate().map(variance).collect()), ..kept.clone() }
}
