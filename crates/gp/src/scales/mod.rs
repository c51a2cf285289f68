//! The unit of each axis, learnt: constraints act at right angles in some units only.
//!
//! With z = Cx the right coordinates, C diagonal, and m = C², the policy is −M⁻¹∇φ: (S1) becomes −uᵀ∇φ(x) = uᵀMu, linear in m
//! and φ together. Left-out errors are linear in targets, so those of each axis alone give the left-out error of every m.

mod context;
mod quotient;

use motion::{scaled, upper_median};
use nalgebra::{DMatrix, DVector};
use rand::Rng;

use crate::evidence::family_fit::FamilyFit;
use crate::kernel::block::Block;
use crate::left_out::LeftOut;
use crate::left_out::comparison::{difference, t_of_mean};
use crate::rows::kept::{Kept, Selection};
use crate::slope::data::SlopeData;
use crate::slope::slope_gp::SlopeGp;
use crate::{GpError, Rows};
use quotient::least_error;

/// Rows at most, and those of them that set the amplitudes: scales are few.
const ROWS: usize = 600;
const HYPER_ROWS: usize = 300;
/// Fits one after the other, each in the units that the one before found.
const ROUNDS: usize = 6;
/// t of the mean gain per trajectory from which learnt units are better by more than chance.
const LEAST_T: f64 = 2.5;
/// Share of the left-out error that learnt units may leave.
const LEFT: f64 = 0.5;
/// Policies in both units differ by more than this share.
const DIFFERS: f64 = 0.05;
/// Scales that differ by less than this share are one.
const SAME: f64 = 0.05;

/// How many times the spread of an axis may be worth that of another.
const MOST_WORTH: f64 = 100.0;

/// Units that predict left-out movements better than those recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct LearntScales {
    /// Factor on each axis, (n); the first is 1.
    pub factors: Vec<f64>,
    /// 1 − R² as recorded, and in these units.
    pub left_out: (f64, f64),
    /// t of the mean gain per trajectory.
    pub t: f64,
}

/// A fit in some units.
struct Round {
    factors: DVector<f64>,
    data: SlopeData,
    blocks: Vec<Block>,
    fit: FamilyFit,
}

impl Round {
    /// With every axis multiplied by its factor; none without Cholesky factor.
    fn new(kept: &Kept, blocks: Vec<Block>, factors: DVector<f64>) -> Option<Round> {
        let velocities = scaled(&kept.velocities, &factors);
        let speeds: Vec<f64> = velocities.column_iter().map(|velocity| velocity.norm()).collect();
        let states = rescaled(&kept.states, &factors);
        let kept = Kept { states, velocities, speeds, variances: None, ..kept.clone() };
        let data = SlopeData::from_kept(&kept, vec![1.0; kept.speeds.len()]).ok()?;
        let fit = data.fit(&blocks, &kept.hyper, None)?;
        Some(Round { factors, data, blocks, fit })
    }

    fn left_out(&self) -> &LeftOut {
        &self.fit.level.left_out
    }

    /// 1 − R².
    fn unexplained(&self) -> f64 {
        1.0 - self.left_out().r_squared
    }

    /// The factors of the next round (S25); none without Cholesky factor.
    fn improved(&self) -> Option<DVector<f64>> {
        let axes = self.data.axis_errors(&self.blocks, &self.fit)?;
        Some(self.factors.component_mul(&least_error(&axes.errors, &axes.targets).map(f64::sqrt)))
    }

    /// Left-out squared error of each trajectory, as a share of everything to predict.
    fn shares(&self) -> Vec<f64> {
        let (residuals, all) = (&self.left_out().residuals, self.data.targets.norm_squared());
        let share = |rows: &Vec<usize>| rows.iter().map(|&row| residuals[(row, 0)].powi(2)).sum::<f64>() / all;
        self.data.groups.iter().map(share).collect()
    }

    /// π̂ at the rows, in units of the recording.
    fn actions(self, kept: &Kept) -> DMatrix<f64> {
        let states = rescaled(&kept.states, &self.factors);
        let actions = self.data.model(self.blocks, self.fit).actions(&states);
        scaled(&actions, &self.factors.map(f64::recip))
    }
}

impl SlopeGp {
    /// Learns a factor for every axis with its first family; none if the units recorded are as good, or where nothing tells.
    /// At most eight fits to 600 rows.
    ///
    /// # Errors
    /// As [`SlopeGp::fit`].
    pub fn learn_scales<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<Option<LearntScales>, GpError> {
        let selection = self.selection()?;
        let few = Selection {
            max_rows: selection.max_rows.min(ROWS),
            hyper_rows: selection.hyper_rows.min(HYPER_ROWS),
            ..selection
        };
        let kept = few.keep(rows, rng)?;
        let round = |factors| Round::new(&kept, self.families[0].blocks(self.trend), factors);
        let dim = rows.dim();
        let spread = spreads(&kept.states).rows(0, dim).into_owned();
        if dim == 1 || spread.min() <= 0.0 {
            return Ok(None);
        }
        let recorded = round(DVector::repeat(dim, 1.0));
        let Some(recorded) = recorded.filter(|round| !round.left_out().is_nearly_exact()) else { return Ok(None) };
        let mut factors = Some(spread.map(f64::recip));
        let mut best: Option<Round> = None;
        for _ in 0..ROUNDS {
            let Some(now) = factors.take().and_then(round) else { break };
            factors = now.improved();
            if best.as_ref().is_none_or(|best| now.unexplained() < best.unexplained()) {
                best = Some(now);
            }
        }
        let plain = best.as_ref().and_then(|best| round(in_plain_units(&best.factors)));
        let best = match (best, plain) {
            (Some(best), Some(plain)) if plain.unexplained() <= best.unexplained() => Some(plain),
            (best, _) => best,
        };
        // An axis that is worth next to nothing was explained away, not measured.
        let sound = |best: &Round| {
            let worth = best.factors.component_mul(&spread);
            worth.max() <= MOST_WORTH * worth.min()
        };
        Ok(best.filter(sound).and_then(|best| accepted(recorded, best, &kept)))
    }
}

/// Standard deviation of every axis.
fn spreads(states: &DMatrix<f64>) -> DVector<f64> {
    DVector::from_iterator(states.nrows(), states.row_iter().map(|axis| axis.variance().sqrt()))
}

/// States (n + p, M) with a factor on every axis that moves, (n), and one on their context that keeps its share of the spread.
fn rescaled(states: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    let (dim, context_dim) = (factors.len(), states.nrows() - factors.len());
    let spread = spreads(&states.rows(0, dim).into_owned());
    let context = spread.component_mul(factors).norm() / spread.norm();
    scaled(states, &factors.clone().resize_vertically(dim + context_dim, context))
}

/// Factors relative to their median, with a power of ten, times 1 or a degree in radians, in place of what is close to it: most
/// mixed units are millimetres beside metres, or degrees beside radians.
fn in_plain_units(factors: &DVector<f64>) -> DVector<f64> {
    let reference = upper_median(factors.as_slice().to_vec()).unwrap_or(1.0);
    factors.map(|factor| {
        let relative = factor / reference;
        let nearest = |unit: f64| unit * 10.0_f64.powf((relative / unit).log10().round());
        let close = |plain: &f64| (relative / plain).ln().abs() < SAME;
        [1.0, 1.0_f64.to_radians()].map(nearest).into_iter().find(close).unwrap_or(relative)
    })
}

/// The scales of `learnt`, if they are better by more than chance and make a difference.
fn accepted(recorded: Round, learnt: Round, kept: &Kept) -> Option<LearntScales> {
    let factors: Vec<f64> = learnt.factors.iter().map(|factor| factor / learnt.factors[0]).collect();
    let (least, most) = factors.iter().fold((1.0_f64, 1.0_f64), |(least, most), &f| (least.min(f), most.max(f)));
    let gains: Vec<f64> = recorded.shares().iter().zip(learnt.shares()).map(|(before, after)| before - after).collect();
    let t = t_of_mean(&gains);
    let left_out = (recorded.unexplained(), learnt.unexplained());
    let better = t >= LEAST_T && left_out.1 <= LEFT * left_out.0 && most / least > 1.0 + SAME;
    let differs = better && difference(&recorded.actions(kept), &learnt.actions(kept)) > DIFFERS;
    differs.then_some(LearntScales { factors, left_out, t })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_units_are_recognised() {
        let found = in_plain_units(&DVector::from_vec(vec![1.02, 0.99e-3, 1.0, 0.0172, 5.0]));
        let expected = [1.0, 1e-3, 1.0, 1.0_f64.to_radians(), 5.0];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
    }
}
