//! The unit of each axis, learnt: constraints act at right angles in some units only.
//!
//! With z = Cx the right coordinates, C diagonal, and m = C², the policy is −M⁻¹∇φ: (S1) becomes −uᵀ∇φ(x) = uᵀMu, linear in m
//! and φ together. Left-out errors are linear in targets, so those of each axis alone give the left-out error of every m.

mod quotient;

use motion::upper_median;
use nalgebra::{DMatrix, DVector};
use rand::Rng;

use crate::kernel::family::{Family, Trend};
use crate::left_out::comparison::{difference, t_of_mean};
use crate::rows::kept::{Kept, Selection};
use crate::slope::data::{AxisErrors, SlopeData};
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
    unexplained: f64,
    /// Left-out squared error of each trajectory, as a share of everything to predict.
    shares: Vec<f64>,
    /// π̂ at the rows, in units of the recording.
    actions: DMatrix<f64>,
    axes: AxisErrors,
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
        let family = self.families[0];
        let dim = kept.states.nrows();
        let recorded = round(&kept, family, self.trend, DVector::repeat(dim, 1.0));
        let Some(recorded) = recorded.filter(|round| dim > 1 && round.unexplained > crate::left_out::NEARLY_EXACT)
        else {
            return Ok(None);
        };
        let spread = DVector::from_iterator(dim, kept.states.row_iter().map(|axis| axis.variance().sqrt()));
        if spread.min() <= 0.0 {
            return Ok(None);
        }
        let mut factors = spread.map(|spread| 1.0 / spread);
        let mut best: Option<Round> = None;
        for _ in 0..ROUNDS {
            let Some(now) = round(&kept, family, self.trend, factors.clone()) else { break };
            factors.component_mul_assign(&least_error(&now.axes.errors, &now.axes.targets).map(f64::sqrt));
            if best.as_ref().is_none_or(|best| now.unexplained < best.unexplained) {
                best = Some(now);
            }
        }
        let plain = best.as_ref().and_then(|best| round(&kept, family, self.trend, in_plain_units(&best.factors)));
        let best = match (best, plain) {
            (Some(best), Some(plain)) if plain.unexplained <= best.unexplained => Some(plain),
            (best, _) => best,
        };
        // An axis that is worth next to nothing was explained away, not measured.
        let sound = |best: &Round| {
            let worth = best.factors.component_mul(&spread);
            worth.max() <= MOST_WORTH * worth.min()
        };
        Ok(best.filter(sound).and_then(|best| accepted(&recorded, &best)))
    }
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
fn accepted(recorded: &Round, learnt: &Round) -> Option<LearntScales> {
    let factors: Vec<f64> = learnt.factors.iter().map(|factor| factor / learnt.factors[0]).collect();
    let (least, most) = factors.iter().fold((1.0_f64, 1.0_f64), |(least, most), &f| (least.min(f), most.max(f)));
    let gains: Vec<f64> = recorded.shares.iter().zip(&learnt.shares).map(|(before, after)| before - after).collect();
    let t = t_of_mean(&gains);
    let better = t >= LEAST_T && learnt.unexplained <= LEFT * recorded.unexplained;
    let differs = most / least > 1.0 + SAME && difference(&recorded.actions, &learnt.actions) > DIFFERS;
    (better && differs).then_some(LearntScales { factors, left_out: (recorded.unexplained, learnt.unexplained), t })
}

/// A fit with every axis multiplied by its factor; none without Cholesky factor.
fn round(kept: &Kept, family: Family, trend: Trend, factors: DVector<f64>) -> Option<Round> {
    let scaled =
        |of: &DMatrix<f64>| DMatrix::from_fn(of.nrows(), of.ncols(), |axis, at| factors[axis] * of[(axis, at)]);
    let velocities = scaled(&kept.velocities);
    let speeds: Vec<f64> = velocities.column_iter().map(|velocity| velocity.norm()).collect();
    let kept = Kept { states: scaled(&kept.states), velocities, speeds, variances: None, ..kept.clone() };
    let data = SlopeData::from_kept(&kept, vec![1.0; kept.speeds.len()]).ok()?;
    let blocks = family.blocks(trend);
    let fit = data.fit(&blocks, &kept.hyper)?;
    let axes = data.axis_errors(&blocks, &fit)?;
    let left_out = &fit.level.left_out;
    let unexplained = 1.0 - left_out.r_squared;
    let all: f64 = data.targets.norm_squared();
    let share = |rows: &Vec<usize>| rows.iter().map(|&row| left_out.residuals[(row, 0)].powi(2)).sum::<f64>() / all;
    let shares = data.groups.iter().map(share).collect();
    let mut actions = data.model(blocks, fit).actions(&kept.states);
    for mut action in actions.column_iter_mut() {
        action.component_div_assign(&factors);
    }
    Some(Round { factors, unexplained, shares, actions, axes })
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
