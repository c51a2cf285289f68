//! Wrong stretches among many (S44), caused by an undetected switch, or by noise taken for a direction.

use motion::upper_median;

use crate::Rows;
use crate::rows::kept::positions;
use crate::slope::pushed::Pushed;
use crate::slope::search::SlopeOutcome;

/// Multiple of the median error above which a stretch counts as contradicted.
const TIMES: f64 = 25.0;
/// Maximum noise factor of a stretch, against overflow.
const MOST: f64 = 1e30;
/// Maximum number of rounds: a better model finds more contradicted stretches, and clears others.
const ROUNDS: usize = 4;
/// Number of compared rows per stretch, on average, and in total.
const EACH: usize = 4;
const ALL: usize = 20_000;

impl Pushed {
    /// The search in which the noise of stretches that other movements contradict is raised to their errors, if that predicts the other
    /// stretches no worse. Contradicted stretches still count in regions without other movements.
    pub(super) fn with_contradicted(self, rows: &Rows) -> Pushed {
        let rows = &*self.of_samples(rows);
        let mut errors = self.errors(rows);
        let mut taken = self;
        for _ in 0..ROUNDS {
            let Some(clearer) = taken.with_doubts(rows, &errors) else { break };
            let now = clearer.errors(rows);
            let (sum, before) = (clearer.sum(&now), clearer.sum(&errors));
            if !(sum.is_finite() && sum <= before) {
                break;
            }
            (taken, errors) = (clearer, now);
        }
        taken
    }

    /// The search with raised noise for the stretches with the largest errors; `None` if these are the same as before.
    fn with_doubts(&self, rows: &Rows, errors: &[Option<f64>]) -> Option<Pushed> {
        let Pushed { kept, gp, .. } = self;
        let median = upper_median(errors.iter().copied().flatten().collect()).filter(|&median| median > 0.0)?;
        let mut stretches = self.stretches.clone();
        for (stretch, error) in stretches.all.iter_mut().zip(errors) {
            let doubt = error.map_or(1.0, |error| (error / median).min(MOST));
            stretch.doubt = if doubt > TIMES { doubt } else { 1.0 };
        }
        let mut both = stretches.all.iter().zip(&self.stretches.all);
        if both.all(|(a, b)| a.is_contradicted() == b.is_contradicted()) {
            return None;
        }
        // In a task space there are many rows, and few models are left to try.
        match stretches.through {
            Some(_) => self.of_nearly_best(gp, rows, kept, stretches),
            None => Pushed::search(gp, rows, kept, stretches),
        }
    }

    /// Sum over the stretches that are not contradicted.
    fn sum(&self, errors: &[Option<f64>]) -> f64 {
        let each = errors.iter().zip(&self.stretches.all).filter(|(_, stretch)| !stretch.is_contradicted());
        each.filter_map(|(error, _)| *error).sum()
    }

    /// E of (S44) of each stretch, contradicted or not; `None` for a stretch without rows.
    fn errors(&self, rows: &Rows) -> Vec<Option<f64>> {
        let Pushed { outcome: SlopeOutcome { data, taken, .. }, kept, stretches, .. } = self;
        let Some(some) = stretches.of_any(rows, kept, (EACH * stretches.all.len()).min(ALL)) else {
            return vec![None; stretches.all.len()];
        };
        let actions = taken.model.actions(&some.states);
        // Predicts rows that were not learnt from by the full model. Otherwise most stretches would have no residual.
        let mut residuals: Vec<f64> = (0..some.rows.len())
            .map(|row| some.speeds[row] - some.velocities.column(row).dot(&actions.column(row)) / some.speeds[row])
            .collect();
        for (at, place) in positions(&some.rows, &kept.rows).into_iter().enumerate() {
            residuals[place] = data.unit * taken.left_out.residuals[(at, 0)];
        }
        let weights = some.of_stretches.as_ref().map(|of| &of.weights);
        let mut sums = vec![(0.0, 0_usize); stretches.all.len()];
        for (row, residual) in residuals.into_iter().enumerate() {
            let Some(stretch) = stretches.position_of(some.indices[row]) else { continue };
            sums[stretch].0 += residual.powi(2) / weights.map_or(1.0, |weights| weights[row]);
            sums[stretch].1 += 1;
        }
        sums.into_iter().map(|(sum, count)| (count > 0).then(|| sum / count as f64)).collect()
    }
}
