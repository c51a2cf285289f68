//! Movements that are slower than the policy's component along them.

use motion::Policy;
use nalgebra::{Matrix2, Vector2};
use prepare::numbers::percent;

use crate::{Finding, Verdict};

/// Least missing speed, as a share of the root mean square, and its t over movements: friction has a t of 5 and more, all else below 3.5. The policy
/// absorbs some of it, so that the share is too low.
const MISSING: f64 = 0.01;
const LEAST_T: f64 = 4.0;
/// Fewer movements determine no t.
const FEW: usize = 5;

/// Says that what constraints turn aside is slower than r = nᵀπ, by about the same everywhere.
pub(crate) fn friction(policy: &dyn Policy, rows: &gp::Rows) -> Option<Finding> {
    let (missing, t) = missing_speed(policy, rows)?;
    (missing > MISSING && t > LEAST_T).then(|| Finding {
        verdict: Verdict::Doubtful,
        what: format!(
            "movements that constraints turn aside are too slow, by at least {} of the speed: friction, or constraints that give way",
            percent(missing)
        ),
        next: "reduce friction and hold constraints firmly, or record the velocities that were commanded".to_owned(),
    })
}

/// Least squares of r − nᵀπ̂ = −f + ε nᵀπ̂ over rows: f in root mean squares of the speed, and its t with movements as units.
fn missing_speed(policy: &dyn Policy, rows: &gp::Rows) -> Option<(f64, f64)> {
    let movements = rows.indices().iter().map(|index| index.trajectory).max()? + 1;
    let mut samples = vec![Vec::new(); movements];
    let (mut matrix, mut vector, mut power) = (Matrix2::zeros(), Vector2::zeros(), 0.0);
    for ((x, u), index) in rows.states().column_iter().zip(rows.velocities().column_iter()).zip(rows.indices()) {
        let Some(n) = u.try_normalize(0.0) else { continue };
        let along = n.dot(&policy.action(x));
        let (factors, error) = (Vector2::new(-1.0, along), u.norm() - along);
        matrix += factors * factors.transpose();
        vector += factors * error;
        power += u.norm_squared();
        samples[index.trajectory].push((factors, error));
    }
    let inverse = matrix.try_inverse()?;
    let fit = inverse * vector;
    let influence = |samples: &Vec<(Vector2<f64>, f64)>| {
        samples.iter().map(|(factors, error)| (inverse * factors).x * (error - factors.dot(&fit))).sum::<f64>()
    };
    let deviation = samples.iter().map(|samples| influence(samples).powi(2)).sum::<f64>().sqrt();
    let counted = samples.iter().filter(|samples| !samples.is_empty()).count();
    (counted >= FEW).then(|| (fit.x / (power / rows.len() as f64).sqrt(), fit.x / deviation))
}
