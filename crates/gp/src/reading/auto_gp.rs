use std::borrow::Cow;
use std::cmp::Ordering;

use motion::{Certainty, LearntPolicy, Policy, Potential};
use nalgebra::{DMatrix, DMatrixView, DVectorView, DVectorViewMut};
use rand::Rng;
use serde::{Deserialize, Serialize};

use crate::direct::direct_gp::{DirectFit, fit_direct};
use crate::direct::free_rows::within_distance;
use crate::kernel::family::Family;
use crate::left_out::comparison::{difference, much_better};
use crate::reading::Hypothesis;
use crate::reading::numbers::{LeftOutRow, ReadingNumbers, TrajectoryErrors};
use crate::reading::slope_and_direct::{LeftOutErrors, SlopeAndDirect};
use crate::slope::cross_path::CrossPathEvidence;
use crate::slope::fit::SlopeFit;
use crate::slope::judgement::{NOTHING_KNOWN, ReportInput, report};
use crate::slope::pushed::{Pushed, pushed};
use crate::slope::search::outcome;
use crate::slope::slope_gp::SlopeGp;
use crate::{GpError, Rows};

/// Fits the slope GP and the direct GP to the same rows, compares them on held-out demonstrations, and returns the policy that the data
/// support (R8). No single learner is right for both free and constrained movement.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AutoGp {
    /// The learner for constrained movement; its limits on rows apply to both.
    pub slope: SlopeGp,
    /// Families of the learner for free movement, as [`DirectGp::families`](crate::DirectGp::families).
    pub direct_families: Vec<Family>,
    /// A reading given by the user, which overrides that of the data.
    pub reading: Option<Hypothesis>,
    /// Whether to look for rows of free motion among constrained ones (R10), unless the reading is given.
    pub free_rows: bool,
}

impl Default for AutoGp {
    fn default() -> Self {
        AutoGp { slope: SlopeGp::default(), direct_families: Family::ALL.to_vec(), reading: None, free_rows: true }
    }
}

/// Both policies, and the selection of the one that the data support.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AutoFit {
    pub(crate) slope: SlopeFit,
    pub(crate) direct: DirectFit,
    /// The direct GP of the free rows, if only some rows were constrained.
    #[serde(rename = "freely", default, skip_serializing_if = "Option::is_none")]
    pub(crate) free_rows_fit: Option<DirectFit>,
    pub(crate) numbers: ReadingNumbers,
    /// The reading at the time of learning. Older stored models have none; the current rule determines theirs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) reading: Option<Hypothesis>,
    pub(crate) overridden: Option<Hypothesis>,
    /// Empty in models stored by versions without this field.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) left_out: Vec<TrajectoryErrors>,
    /// Not stored.
    #[serde(skip)]
    pub(crate) left_out_rows: Vec<LeftOutRow>,
}

impl AutoGp {
    /// Learns from rows. The generator draws one permutation and, if rows are thinned, an offset.
    ///
    /// # Errors
    /// As [`SlopeGp::fit`] and [`DirectGp::fit`](crate::DirectGp::fit).
    pub fn fit<R: Rng + ?Sized>(&self, rows: &Rows, rng: &mut R) -> Result<AutoFit, GpError> {
        let kept = self.slope.row_limits()?.keep(rows, rng)?;
        let (slope, direct) = rayon::join(|| outcome(&self.slope, &kept), || fit_direct(&self.direct_families, &kept));
        let few = SlopeAndDirect { kept, slope: slope?, direct: direct?, free_rows_fit: None };
        let look = self.free_rows && self.reading.is_none();
        let few = if look { few.with_free_rows(&self.direct_families) } else { few };
        // Free rows that explain the others leave no push to explain.
        let free = few.free_rows_fit.is_some() || few.compare_predictions(None).0.agree_on_free_movement();
        let pushed = if free { None } else { pushed(&self.slope, rows, &few.kept, &few.slope) };
        // If the directions of stretches are not informative, nothing pushed.
        let telling = pushed.filter(|pushed| few.compare_predictions(Some(pushed)).0.stretches_tell());
        let (both, pushed) = match telling.map(|pushed| pushed.on_all_rows(rows)) {
            Some(pushed) if pushed.pushes() => (few, Some(pushed)),
            pushed => {
                let all = few.on_all_rows(&self.slope, rows);
                let better = pushed.filter(|pushed| {
                    let tells = all.compare_predictions(Some(pushed)).0.stretches_tell();
                    tells && pushed.expects_less(rows, &all.slope, &all.kept)
                });
                (all, better)
            }
        };
        let (numbers, left_out) = both.compare_predictions(pushed.as_ref());
        let reading = if pushed.is_some() { Hypothesis::Constrained } else { numbers.reading() };
        let SlopeAndDirect { kept, slope, direct, free_rows_fit } = both;
        let (slope, kept) = match pushed {
            Some(Pushed { outcome, kept, .. }) => (outcome, kept),
            None => (slope, kept),
        };
        // If the slope policy is the better one, left-out movements test it in all directions, whatever their own.
        let tested = free_rows_fit.is_none() && (reading == Hypothesis::Constrained || numbers.shows_a_potential());
        let across = if tested { CrossPathEvidence::Tested } else { CrossPathEvidence::Untested };
        let mut report = report(&ReportInput { outcome: &slope, kept: &kept, rows, across });
        if across == CrossPathEvidence::Untested {
            let actions = free_rows_fit.as_ref().map_or(&direct.actions, |free_rows_fit| &free_rows_fit.direct.actions);
            let away = difference(actions, &slope.taken.actions);
            report.expected_nupe = expected_beside((reading, numbers.gap, numbers.p_d), away, report.expected_nupe);
        }
        let slope = SlopeFit { model: slope.taken.model, report };
        let (direct, free_rows_fit) = (direct.fit, free_rows_fit.map(|free_rows_fit| free_rows_fit.direct.fit));
        let LeftOutErrors { trajectories: left_out, rows: left_out_rows } = left_out;
        let (reading, overridden) = (Some(reading), self.reading);
        Ok(AutoFit { slope, direct, free_rows_fit, numbers, reading, overridden, left_out, left_out_rows })
    }
}

impl AutoFit {
    /// The reading of the data.
    pub fn reading(&self) -> Hypothesis {
        self.reading.unwrap_or_else(|| self.numbers.reading())
    }

    /// The user's reading, if given.
    pub fn overridden(&self) -> Option<Hypothesis> {
        self.overridden
    }

    /// The numbers that determine the reading.
    pub fn numbers(&self) -> &ReadingNumbers {
        &self.numbers
    }

    /// Held-out errors of each trajectory.
    pub fn left_out(&self) -> &[TrajectoryErrors] {
        &self.left_out
    }

    /// Whether `other`, a fit of the same trajectories in another metric, predicts left-out trajectories so much better that its metric is
    /// right. The condition is that for learnt scales (S25): it compares the slope GPs' errors as shares of the quantity to predict, each
    /// at most that of predicting nothing.
    pub fn is_much_worse_than(&self, other: &AutoFit) -> bool {
        let share = |of: &TrajectoryErrors| (of.slope / of.seen).min(1.0);
        // Fits of other rows may lack some trajectories; blocks of one trajectory are the same in both.
        let (mut own, mut of) = (self.left_out.iter().peekable(), other.left_out.iter().peekable());
        let mut gains = Vec::new();
        while let (Some(a), Some(b)) = (own.peek(), of.peek()) {
            match a.trajectory.cmp(&b.trajectory) {
                Ordering::Less => own.next(),
                Ordering::Greater => of.next(),
                Ordering::Equal => {
                    gains.push(share(a) - share(b));
                    own.next();
                    of.next()
                }
            };
        }
        let unexplained = |of: &AutoFit| 1.0 - of.slope.report.r_squared;
        much_better(&gains, (unexplained(self), unexplained(other))).is_some()
    }

    /// The rows of samples from which the policies (or with pushes the direct one) were learnt, each predicted without its trajectory.
    /// Empty after reading a stored fit.
    pub fn left_out_rows(&self) -> &[LeftOutRow] {
        &self.left_out_rows
    }

    /// The policy for constrained movement.
    pub fn slope(&self) -> &SlopeFit {
        &self.slope
    }

    /// The policy for free movement, learnt from all rows.
    pub fn direct(&self) -> &DirectFit {
        &self.direct
    }

    /// The direct policy that [`AutoFit::numbers`] describes: learnt from the free rows if constraints deflected others (R10), else from
    /// all.
    pub fn direct_of_free_rows(&self) -> &DirectFit {
        self.free_rows_fit.as_ref().unwrap_or(&self.direct)
    }

    /// The rows that move freely, averaged as for learning, if constraints deflected others (R10); else all rows, unchanged.
    pub fn free_rows<'a>(&self, rows: &'a Rows) -> Cow<'a, Rows> {
        let (Some(free), Some(free_rows_fit)) = (self.numbers.free, &self.free_rows_fit) else {
            return Cow::Borrowed(rows);
        };
        let rows = rows.averaged();
        let is_free = within_distance(
            &free_rows_fit.model.moving_actions(rows.states().as_view()),
            rows.velocities(),
            free.within,
        );
        Cow::Owned(rows.chosen(&|row| is_free[row]))
    }

    /// Expected error (nUPE) of the returned policy (R6).
    pub fn expected_nupe(&self) -> f64 {
        match (self.takes_slope(), self.reading()) {
            (true, _) => self.slope.report.expected_nupe,
            (false, Hypothesis::Constrained) if self.free_rows_fit.is_some() => self.numbers.error_of_free_rows(),
            (false, Hypothesis::Constrained) => self.numbers.p_d.max(self.numbers.gap),
            (false, _) => self.numbers.p_d,
        }
    }

    /// Whether the returned policy is the slope GP's.
    pub fn takes_slope(&self) -> bool {
        self.numbers.takes_slope(self.overridden.unwrap_or(self.reading()))
    }

    fn selected_policy(&self) -> &dyn LearntPolicy {
        if self.takes_slope() { &self.slope } else { self.direct_of_free_rows() }
    }
}

impl Policy for AutoFit {
    fn dim(&self) -> usize {
        self.selected_policy().dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, action: DVectorViewMut<'_, f64>) {
        self.selected_policy().action_into(state, action);
    }

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        self.selected_policy().actions(states)
    }
}

impl LearntPolicy for AutoFit {
    fn potential(&self) -> Option<&dyn Potential> {
        self.selected_policy().potential()
    }

    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        self.selected_policy().support(state)
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, deviation: DVectorViewMut<'_, f64>) -> bool {
        self.selected_policy().action_sd_into(state, deviation)
    }

    fn certainty(&self, states: DMatrixView<'_, f64>) -> Certainty {
        self.selected_policy().certainty(states)
    }

    fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        self.selected_policy().supported(states, least)
    }

    fn warnings(&self) -> Vec<String> {
        let doubt = self.reading().doubt().map(|doubt| doubt.to_string());
        doubt.into_iter().chain(self.selected_policy().warnings()).collect()
    }
}

/// The expected error of the slope policy, given the direct one (R6). `own` is the slope policy's own estimate, `gap` the distance of the
/// direct policy, `p_d` the direct policy's left-out error, and `away` the slope policy's error if the direct one were the truth.
fn expected_beside((reading, gap, p_d): (Hypothesis, f64, f64), away: f64, own: f64) -> f64 {
    let expected = match reading {
        // The direct policy is the right one. Learnt from all movements, its error is between nothing and p_d, and the slope policy's is
        // between `away` and the most that both allow. The estimate is the geometric mean of these bounds.
        Hypothesis::Free => {
            let most = (away.sqrt() + p_d.max(0.0).sqrt()).powi(2);
            (away * own.max(away).min(most)).sqrt()
        }
        _ => own.max(gap),
    };
    expected.min(NOTHING_KNOWN)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The estimate always allows for the distance to the other policy, never exceeds the error of knowing only the mean, and is
        /// bounded by both policies only if nothing is hidden.
        #[test]
        fn expected_error_stays_within_its_bounds(
            gap in 0.0f64..2.0,
            p_d in -0.5f64..1.5,
            away in 0.0f64..2.0,
            own in 0.0f64..=1.0,
        ) {
            let expected = |reading| expected_beside((reading, gap, p_d), away, own);
            for reading in [Hypothesis::Ambiguous, Hypothesis::Unexplained, Hypothesis::Constrained] {
                prop_assert_eq!(expected(reading), own.max(gap).min(1.0));
            }
            let free = expected(Hypothesis::Free);
            let bound = away + p_d.max(0.0) + 2.0 * (away * p_d.max(0.0)).sqrt();
            prop_assert!(free >= away.min(1.0) - 1e-12 && free <= bound.min(1.0) + 1e-12);
            prop_assert!(own < away || own > bound || free <= own + 1e-12);
        }

        /// If the direct policy is exact, its distance is the error.
        #[test]
        fn an_exact_direct_policy_knows_the_error(away in 0.0f64..=1.0, own in 0.0f64..=1.0) {
            let expected = expected_beside((Hypothesis::Free, 0.5, 0.0), away, own);
            prop_assert!((expected - away).abs() <= 1e-12);
        }
    }

    /// A constant direct policy measures nothing.
    #[test]
    fn a_constant_direct_policy_determines_nothing() {
        for away in [f64::NAN, f64::INFINITY] {
            assert_eq!(expected_beside((Hypothesis::Free, 0.5, 0.1), away, 0.2), 1.0);
        }
    }
}
