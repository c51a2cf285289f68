//! Wrong stretches among many (S44): a switch that was not seen, or noise taken for a direction.

use motion::upper_median;

use crate::Rows;
use crate::rows::kept::positions;
use crate::slope::pushed::Pushed;
use crate::slope::search::Outcome;

/// Error of a stretch, in that of the median, above which it is contradicted.
const TIMES: f64 = 25.0;
/// Most noise of a stretch, in that of others: what overflows tells nothing.
const MOST: f64 = 1e30;
/// How often they are looked for: a better model shows more of them, and that some are none.
const ROUNDS: usize = 4;
/// Rows of each stretch that are compared, on average, and of all.
const EACH: usize = 4;
const ALL: usize = 20_000;

impl Pushed {
    /// The search in which stretches that other movements contradict are as noisy as their errors, if that predicts the others no worse. They
    /// still tell something where no other movement was.
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

    /// The search in which stretches of the largest errors are as noisy; none if they are those that are already.
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
        // In a task space rows are many, and of a few models already.
        match stretches.through {
            Some(_) => self.of_nearly_best(gp, rows, kept, stretches),
            None => Pushed::search(gp, rows, kept, stretches),
        }
    }

    /// Of the stretches that are not contradicted.
    fn sum(&self, errors: &[Option<f64>]) -> f64 {
        let each = errors.iter().zip(&self.stretches.all).filter(|(_, stretch)| !stretch.is_contradicted());
        each.filter_map(|(error, _)| *error).sum()
    }

    /// E of (S44) of each stretch, contradicted or not; none of those that have no rows.
    fn errors(&self, rows: &Rows) -> Vec<Option<f64>> {
        let Pushed { outcome: Outcome { data, taken, .. }, kept, stretches, .. } = self;
        let Some(some) = stretches.of_any(rows, kept, (EACH * stretches.all.len()).min(ALL)) else {
            return vec![None; stretches.all.len()];
        };
        let actions = taken.model.actions(&some.states);
        // Those that were not learnt from are predicted as they are: most stretches then have none that was.
        let mut residuals: Vec<f64> = (0..some.rows.len())
            .map(|row| some.speeds[row] - some.velocities.column(row).dot(&actions.column(row)) / some.speeds[row])
            .collect();
        for (at, place) in positions(&some.rows, &kept.rows).into_iter().enumerate() {
            residuals[place] = data.speed * taken.left_out.residuals[(at, 0)];
        }
        let weights = some.of_stretches.as_ref().map(|of| &of.weights);
        let mut sums = vec![(0.0, 0_usize); stretches.all.len()];
        for (row, residual) in residuals.into_iter().enumerate() {
            let Some(stretch) = stretches.place(some.indices[row]) else { continue };
            sums[stretch].0 += residual.powi(2) / weights.map_or(1.0, |weights| weights[row]);
            sums[stretch].1 += 1;
        }
        sums.into_iter().map(|(sum, count)| (count > 0).then(|| sum / count as f64)).collect()
    }
}
