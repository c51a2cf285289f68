//! Do halves of the movements tell the same?

use gp::{CurlTest, GpError, ModelKind, Rows, SlopeFit, SlopeGp};
use motion::Policy;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::actions::{actions, spread, states};

/// Σ‖π̂_even − π̂_odd‖² over Σ‖π̂ − mean π̂‖² at the rows' states, of the slope policies that every other movement alone
/// would give; none if halves are too few to learn from.
///
/// The error to expect is a quarter of it at most, if each half has twice the error of the whole and the errors of both
/// have nothing to do with each other. What both lack, it cannot see.
pub(super) fn of_slope(slope: &SlopeFit, rows: &Rows, (max_rows, seed): (usize, u64)) -> Option<f64> {
    let report = slope.report();
    let curl_test = if report.model == ModelKind::Potential { CurlTest::AssumePotential } else { CurlTest::Fit };
    let gp = SlopeGp {
        families: vec![report.family],
        max_rows: max_rows / 2,
        hyper_rows: max_rows / 4,
        curl_test,
        ..SlopeGp::default()
    };
    let half = |odd: usize| -> Result<SlopeFit, GpError> {
        let rows = rows.clone().without(|trajectory, _| trajectory % 2 == odd);
        gp.fit(&rows, &mut ChaCha8Rng::seed_from_u64(seed))
    };
    let (even, odd) = rayon::join(|| half(1), || half(0));
    disagreement(slope, [&even.ok()?, &odd.ok()?], rows)
}

fn disagreement(whole: &dyn Policy, [even, odd]: [&dyn Policy; 2], rows: &Rows) -> Option<f64> {
    let states = states(rows);
    let apart = (actions(even, &states) - actions(odd, &states)).norm_squared();
    let disagreement = apart / spread(&actions(whole, &states));
    disagreement.is_finite().then_some(disagreement)
}
