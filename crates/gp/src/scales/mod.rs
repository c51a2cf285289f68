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
use crate::left_out::LeftOutPredictions;
use crate::left_out::comparison::{DIFFERS, difference, much_better};
use crate::rows::kept::{Kept, Selection, rescaled, spreads};
use crate::slope::data::SlopeData;
use crate::slope::push_test::PushTest;
use crate::slope::slope_gp::SlopeGp;
use crate::stretches::rows::covered;
use crate::stretches::view::View;
use crate::stretches::{Stretches, Switches};
use crate::{GpError, Rows};
use quotient::least_error;

/// Rows at most, and those of them that set the amplitudes: scales are few.
const ROWS: usize = 600;
const HYPER_ROWS: usize = 300;
/// Fits one after the other, each in the units that the one before found.
const ROUNDS: usize = 6;
/// Scales that differ by less than this share are one.
const SAME: f64 = 0.05;

/// Share of the left-out error in recorded units above which other units that stay are given up: half of it is needed.
const HOPELESS: f64 = 0.75;
/// Share of the movements that must have stretches: what they leave and what samples leave is compared as it is.
const COVERED: f64 = 0.5;
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
    /// Whole velocities u, (n, M).
    velocities: DMatrix<f64>,
    data: SlopeData,
    blocks: Vec<Block>,
    fit: FamilyFit,
}

impl Round {
    /// With every axis multiplied by its factor; none without Cholesky factor.
    fn new(kept: &Kept, blocks: Vec<Block>, factors: DVector<f64>) -> Option<Round> {
        let kept = kept.scaled(&factors);
        let weights = kept.of_stretches.as_ref().map_or_else(|| vec![1.0; kept.speeds.len()], |of| of.weights.clone());
        let data = SlopeData::from_kept(&kept, weights).ok()?;
        let fit = data.fit(&blocks, &kept.hyper, None)?;
        Some(Round { factors, velocities: kept.observed().clone(), data, blocks, fit })
    }

    fn left_out(&self) -> &LeftOutPredictions {
        &self.fit.level.left_out
    }

    /// 1 − R².
    fn unexplained(&self) -> f64 {
        1.0 - self.left_out().r_squared
    }

    /// The factors of the next round (S25); none without Cholesky factor.
    fn improved(&self) -> Option<DVector<f64>> {
        let axes = self.data.axis_errors(&self.velocities, &self.blocks, &self.fit)?;
        Some(self.factors.component_mul(&least_error(&axes.errors, &axes.targets).map(f64::sqrt)))
    }

    /// Left-out squared error of each trajectory, at most that of predicting nothing, as a share of everything to predict.
    fn shares(&self) -> Vec<f64> {
        let SlopeData { targets, noise_weights, groups, .. } = &self.data;
        let weighed = |of: &DMatrix<f64>, rows: &[usize]| -> f64 {
            rows.iter().map(|&row| of[(row, 0)].powi(2) / noise_weights[row]).sum()
        };
        let all: Vec<f64> = groups.iter().map(|rows| weighed(targets, rows)).collect();
        let errors = groups.iter().map(|rows| weighed(&self.left_out().residuals, rows));
        let everything: f64 = all.iter().sum();
        errors.zip(&all).map(|(error, all)| error.min(*all) / everything).collect()
    }

    /// π̂ at the rows, in units of the recording.
    fn actions(self, kept: &Kept) -> DMatrix<f64> {
        let states = rescaled(&kept.states, &self.factors);
        let actions = self.data.model(self.blocks, self.fit).actions(&states);
        scaled(&actions, &self.factors.map(f64::recip))
    }
}

impl SlopeGp {
    /// Learns a factor for every axis with its first family; none if the units recorded are as good, in another metric, or where nothing tells.
    /// At most eight fits to 600 rows, and as many to rows of stretches where constraints may push and do.
    ///
    /// # Errors
    /// As [`SlopeGp::fit`].
    pub fn learn_scales<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<Option<LearntScales>, GpError> {
        let few = self.selection()?.at_most(ROWS, HYPER_ROWS);
        let kept = few.keep(rows, rng)?;
        let dim = rows.dim();
        let spread = spreads(&kept.states).rows(0, dim).into_owned();
        if dim == 1 || spread.min() <= 0.0 || rows.momenta().is_some() {
            return Ok(None);
        }
        let blocks = self.families[0].blocks(self.trend);
        let of_samples = better_units(&kept, &blocks, &spread);
        let of_stretches = match self.push_test {
            PushTest::AssumeNone => None,
            PushTest::Fit => stretches(rows, &kept, &few, &spread),
        };
        let of_stretches = of_stretches.and_then(|kept| better_units(&kept, &blocks, &spread));
        let found = of_samples.into_iter().chain(of_stretches);
        Ok(found.min_by(|a, b| a.left_out.1.total_cmp(&b.left_out.1)))
    }
}

/// Rows of stretches, found with every axis divided by its `spread`, in the recorded units; none where nothing pushes, or of few movements.
fn stretches(rows: &Rows, kept: &Kept, selection: &Selection, spread: &DVector<f64>) -> Option<Kept> {
    let (dim, factors) = (rows.dim(), spread.map(f64::recip));
    let states = rescaled(rows.states(), &factors);
    let velocities = scaled(rows.velocities(), &factors);
    let alike = Rows::new(states.rows(0, dim).into_owned(), velocities, rows.indices().to_vec()).ok()?;
    let alike = alike.with_context(&states.rows(dim, states.nrows() - dim).into_owned()).ok()?;
    let alike = match rows.labels() {
        Some(labels) => alike.with_labels(labels.to_vec()).ok()?,
        None => alike,
    };
    let stretches =
        Stretches::of(&alike, &View::recorded(&alike), Switches::Sought).filter(Stretches::push_is_significant)?;
    let own = stretches.rows(&alike, kept, selection)?;
    (covered(&alike, &own, kept) >= COVERED).then(|| own.scaled(spread))
}

/// Units in which these rows are predicted better than in the recorded ones; axes vary by `spread`.
fn better_units(kept: &Kept, blocks: &[Block], spread: &DVector<f64>) -> Option<LearntScales> {
    let round = |factors| Round::new(kept, blocks.to_vec(), factors);
    let recorded = round(DVector::repeat(spread.len(), 1.0)).filter(|round| !round.left_out().is_nearly_exact())?;
    let mut factors = Some(spread.map(f64::recip));
    let mut best: Option<Round> = None;
    for _ in 0..ROUNDS {
        let Some(now) = factors.take().and_then(round) else { break };
        factors = now.improved();
        // Further rounds find nearly these units again, and they are nowhere near being taken.
        let stays = factors.as_ref().is_some_and(|next| alike(next, &now.factors));
        if stays && now.unexplained() > HOPELESS * recorded.unexplained() {
            return None;
        }
        if best.as_ref().is_none_or(|best| now.unexplained() < best.unexplained()) {
            best = Some(now);
        }
    }
    let best = best?;
    let best = match round(in_plain_units(&best.factors)) {
        Some(plain) if plain.unexplained() <= best.unexplained() => plain,
        _ => best,
    };
    // An axis that is worth next to nothing was explained away, not measured.
    let worth = best.factors.component_mul(spread);
    let sound = worth.max() <= MOST_WORTH * worth.min();
    if sound { accepted(recorded, best, kept) } else { None }
}

/// Whether factors that differ by one for all are the same, nearly.
fn alike(a: &DVector<f64>, b: &DVector<f64>) -> bool {
    let ratios = a.component_div(b);
    ratios.max() <= (1.0 + SAME) * ratios.min()
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
    let left_out = (recorded.unexplained(), learnt.unexplained());
    let t = much_better(&gains, left_out).filter(|_| most / least > 1.0 + SAME)?;
    let differs = difference(&recorded.actions(kept), &learnt.actions(kept)) > DIFFERS;
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
