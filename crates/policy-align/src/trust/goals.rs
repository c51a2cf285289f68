//! Goals that differ from one movement to the next.

use motion::Policy;
use nalgebra::{DMatrix, DVector};
use prepare::numbers::percent;
use prepare::{Prepared, end_places};

use super::numbers::TrustNumbers;
use crate::{Finding, Verdict};

/// Share of what the policy does not explain that a constant velocity of each movement explains.
const OWN: f64 = 0.5;
/// So many rows of a movement for each dimension, or they explain themselves.
const ROWS: usize = 4;
const NEXT: &str = "if the goal, an object or a load differs, record it and name its columns with --context, or learn each goal from its own movements";

/// Says what makes movements differ where the policy does not predict them. It accuses no policy that does, with however many goals.
pub(crate) fn differing_goals(
    policy: &dyn Policy,
    prepared: &Prepared,
    rows: &gp::Rows,
    numbers: &TrustNumbers,
) -> Option<Finding> {
    if predicts(numbers) {
        return None;
    }
    let places = end_places(&prepared.demonstrations).filter(|&places| places > 1);
    let what = match (places, own_share(policy, rows)) {
        (Some(places), _) => format!("movements are not predicted well and end at {places} places"),
        (None, Some(share)) if share > OWN => format!(
            "something that is constant in a movement and differs between them explains {} of the error",
            percent(share)
        ),
        _ => return None,
    };
    Some(Finding { verdict: Verdict::Doubtful, what, next: NEXT.to_owned() })
}

fn predicts(numbers: &TrustNumbers) -> bool {
    numbers.held_out_error <= TrustNumbers::GOOD_HELD_OUT_ERROR
        && numbers.expected_error <= TrustNumbers::GOOD_EXPECTED_ERROR
        && numbers.halves.is_none_or(|halves| halves <= TrustNumbers::GOOD_HALVES)
}

/// Share of Σ(r − nᵀπ̂)² that nᵀc explains with one c (n) a movement.
fn own_share(policy: &dyn Policy, rows: &gp::Rows) -> Option<f64> {
    let (dim, movements) = (policy.dim(), rows.indices().iter().map(|index| index.trajectory).max()? + 1);
    let mut normal = vec![(DMatrix::<f64>::zeros(dim, dim), DVector::<f64>::zeros(dim), 0); movements];
    let mut all = 0.0;
    for ((x, u), index) in rows.states().column_iter().zip(rows.velocities().column_iter()).zip(rows.indices()) {
        let Some(n) = u.try_normalize(0.0) else { continue };
        let error = n.dot(&(u - policy.action(x)));
        let (matrix, vector, count) = &mut normal[index.trajectory];
        matrix.ger(1.0, &n, &n, 1.0);
        vector.axpy(error, &n, 1.0);
        *count += 1;
        all += error * error;
    }
    let enough = normal.iter().filter(|(_, _, count)| *count > 0).all(|(_, _, count)| *count >= ROWS * dim);
    let explained = |(matrix, vector, _): (DMatrix<f64>, DVector<f64>, usize)| {
        let floor = 1e-6 * matrix.trace();
        let inverse = (matrix + DMatrix::identity(dim, dim) * floor).try_inverse();
        inverse.map_or(0.0, |inverse| vector.dot(&(inverse * &vector)))
    };
    (enough && all > 0.0).then(|| normal.into_iter().map(explained).sum::<f64>() / all)
}
