//! Learns the unit of each axis: constraints project at right angles in certain units only.
//!
//! Let z = Cx be the right coordinates, C diagonal, and m = C². The policy is then −M⁻¹∇φ, and (S1) becomes −uᵀ∇φ(x) = uᵀMu, which is
//! linear in m and φ together. Left-out errors are linear in the targets, so the errors of each axis alone determine the left-out error of
//! every m.

mod context;
mod quotient;

use motion::{scaled, upper_median};
use nalgebra::{DMatrix, DVector};
use rand::Rng;

use crate::evidence::family_fit::FamilyFit;
use crate::kernel::block::Block;
use crate::left_out::LeftOutPredictions;
use crate::left_out::comparison::{DIFFERS, difference, much_better};
use crate::left_out::level::Targets;
use crate::rows::kept::{Kept, RowLimits, rescaled, spreads};
use crate::slope::data::SlopeData;
use crate::slope::push_test::PushTest;
use crate::slope::slope_gp::SlopeGp;
use crate::stretches::rows::covered;
use crate::stretches::view::View;
use crate::stretches::{Stretches, Switches};
use crate::{GpError, Rows};
use quotient::least_error;

/// Maximum number of rows, and number of rows that determine the amplitudes: there are few scales to learn.
const ROWS: usize = 600;
const HYPER_ROWS: usize = 300;
/// Number of successive fits, each in the units that the previous one found.
const ROUNDS: usize = 6;
/// Scales that differ by less than this share count as equal.
const SAME: f64 = 0.05;

/// The search ends at units that stay the same and leave more than this share of the left-out error in recorded units; acceptance requires
/// at most half.
const HOPELESS: f64 = 0.75;
/// Share of the movements that must have stretches, because the errors left by stretches and by samples are compared directly.
const COVERED: f64 = 0.5;
/// Maximum ratio of one axis's weight to another's, each multiplied by the axis's spread.
const MOST_WORTH: f64 = 100.0;

/// Units that predict left-out movements better than those recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct LearntScales {
    /// Factor on each axis, (n); the first is 1.
    pub factors: Vec<f64>,
    /// 1 − R² in the recorded units, and in these.
    pub left_out: (f64, f64),
    /// t of the mean gain per trajectory.
    pub t: f64,
}

/// A fit in certain units.
struct Round {
    factors: DVector<f64>,
    /// Whole velocities u, (n, M).
    velocities: DMatrix<f64>,
    data: SlopeData,
    blocks: Vec<Block>,
    fit: FamilyFit,
}

impl Round {
    /// The fit with every axis multiplied by its factor; `None` without a Cholesky factor.
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

    /// The factors of the next round (S25); `None` without a Cholesky factor.
    fn improved(&self) -> Option<DVector<f64>> {
        let axes = self.data.axis_errors(&self.velocities, &self.blocks, &self.fit)?;
        Some(self.factors.component_mul(&least_error(&axes.errors, &axes.targets).map(f64::sqrt)))
    }

    /// Left-out squared error of each trajectory, at most that of predicting nothing, as a share of the total to predict.
    fn shares(&self) -> Vec<f64> {
        let Targets { values, noise_weights, groups, .. } = &self.data.targets;
        let weighed = |of: &DMatrix<f64>, rows: &[usize]| -> f64 {
            rows.iter().map(|&row| of[(row, 0)].powi(2) / noise_weights[row]).sum()
        };
        let all: Vec<f64> = groups.iter().map(|rows| weighed(values, rows)).collect();
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
    /// Learns a factor for each axis with its first family; `None` if the recorded units are as good, in another metric, or if the data are
    /// uninformative. At most eight fits to 600 rows, and as many to rows of stretches if constraints may push and do.
    ///
    /// # Errors
    /// As [`SlopeGp::fit`].
    pub fn learn_scales<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<Option<LearntScales>, GpError> {
        let few = self.row_limits()?.at_most(ROWS, HYPER_ROWS);
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

/// Rows of stretches, in the recorded units; stretches are found with every axis divided by its `spread`. `None` if nothing pushes, or if
/// they cover few movements.
fn stretches(rows: &Rows, kept: &Kept, limits: &RowLimits, spread: &DVector<f64>) -> Option<Kept> {
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
    let own = stretches.rows(&alike, kept, limits)?;
    (covered(&alike, &own, kept) >= COVERED).then(|| own.scaled(spread))
}

/// Units in which these rows are predicted better than in the recorded ones; `spread` is that of each axis.
fn better_units(kept: &Kept, blocks: &[Block], spread: &DVector<f64>) -> Option<LearntScales> {
    let round = |factors| Round::new(kept, blocks.to_vec(), factors);
    let recorded = round(DVector::repeat(spread.len(), 1.0)).filter(|round| !round.left_out().is_nearly_exact())?;
    let mut factors = Some(spread.map(f64::recip));
    let mut best: Option<Round> = None;
    for _ in 0..ROUNDS {
        let Some(now) = factors.take().and_then(round) else { break };
        factors = now.improved();
        // Further rounds would find nearly the same units, and these are far from acceptance.
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
    // An axis with nearly no weight was fitted away, not measured.
    let worth = best.factors.component_mul(spread);
    let sound = worth.max() <= MOST_WORTH * worth.min();
    if sound { accepted(recorded, best, kept) } else { None }
}

/// Whether factors are nearly equal, up to a common factor.
fn alike(a: &DVector<f64>, b: &DVector<f64>) -> bool {
    let ratios = a.component_div(b);
    ratios.max() <= (1.0 + SAME) * ratios.min()
}

/// Replaces factors relative to their median by the nearest power of ten, times 1 or a degree in radians, if they are close to it. Most
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

/// The scales of `learnt`, if they improve prediction by more than chance and change the policy.
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
