//! Split-half agreement: do halves of the movements, or of a single one, give the same policy?

use std::borrow::Cow;

use gp::{AutoFit, CurlTest, DirectGp, GpError, Grouping, ModelKind, PushTest, Rows, SlopeGp};
use motion::Policy;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::actions::{spread, states};

/// How halves are learnt from: rows at most that the whole was learnt from, and the seed of its choices.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) max_rows: usize,
    pub(super) seed: u64,
}

/// Σ‖π̂_even − π̂_odd‖² over Σ‖π̂ − mean π̂‖² at the rows' states, of the slope policies that every other movement alone
/// would give, or both halves of a single one; none if halves are too few to learn from.
///
/// The error to expect of many movements is a quarter of it at most, if each half has twice the error of the whole and the errors of both
/// have nothing to do with each other. Of one or two movements all of it is expected. What both halves lack, it cannot detect.
pub(super) fn of_slope(readings: &AutoFit, rows: &Rows, limits: Limits) -> Option<f64> {
    let report = readings.slope().report();
    let curl_test = if report.model == ModelKind::Potential { CurlTest::AssumePotential } else { CurlTest::Fit };
    let gp = SlopeGp {
        families: vec![report.family],
        max_rows: limits.max_rows / 2,
        hyper_rows: limits.max_rows / 4,
        curl_test,
        push_test: if report.push.is_some() || report.task_space.is_some() {
            PushTest::Fit
        } else {
            PushTest::AssumeNone
        },
        ..SlopeGp::default()
    };
    let learn = |rows: &Rows| gp.fit(rows, &mut ChaCha8Rng::seed_from_u64(limits.seed));
    // Stretches are found on samples, all else on their means.
    let with_spaces = |spaces| rows.clone().with_task_spaces(spaces).map(Cow::Owned);
    let learnt_from = match report.task_space {
        Some(space) => with_spaces(vec![rows.task_spaces()[space].clone()]).ok()?,
        None if report.push.is_none() => rows.averaged(),
        None if rows.task_spaces().is_empty() => Cow::Borrowed(rows),
        None => with_spaces(Vec::new()).ok()?,
    };
    disagreement((readings, readings.slope()), (rows, &learnt_from), &learn)
}

/// The same of direct policies.
pub(super) fn of_direct(readings: &AutoFit, rows: &Rows, limits: Limits) -> Option<f64> {
    let gp = DirectGp {
        families: vec![readings.direct().family()],
        max_rows: limits.max_rows / 2,
        hyper_rows: limits.max_rows / 4,
        ..DirectGp::default()
    };
    let learn = |rows: &Rows| gp.fit(rows, &mut ChaCha8Rng::seed_from_u64(limits.seed));
    disagreement((readings, readings.direct()), (rows, &rows.averaged()), &learn)
}

/// Samples of the only movement, if there is one alone.
fn only_movement(readings: &AutoFit, rows: &Rows) -> Option<usize> {
    let (first, last) = (rows.indices().first()?, rows.indices().last()?);
    let alone = readings.numbers().grouping == Grouping::BlocksOfTime && first.trajectory == last.trajectory;
    alone.then_some(last.sample + 1)
}

fn disagreement<P: Policy + Send>(
    (readings, whole): (&AutoFit, &dyn Policy),
    (rows, learnt_from): (&Rows, &Rows),
    learn: &(dyn Fn(&Rows) -> Result<P, GpError> + Sync),
) -> Option<f64> {
    let middle = only_movement(readings, learnt_from).map(|samples| samples / 2);
    let is_odd = |trajectory: usize, sample: usize| middle.map_or(trajectory % 2 == 1, |middle| sample >= middle);
    let half = |odd: bool| learn(&learnt_from.without(|trajectory, sample| is_odd(trajectory, sample) == odd));
    let (even, odd) = rayon::join(|| half(true), || half(false));
    let states = states(rows);
    let apart = (even.ok()?.actions(states.as_view()) - odd.ok()?.actions(states.as_view())).norm_squared();
    let disagreement = apart / spread(&whole.actions(states.as_view()));
    disagreement.is_finite().then_some(disagreement)
}
