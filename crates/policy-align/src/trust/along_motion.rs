//! What movements say against a policy: findings on r − nᵀπ̂.

use gp::Rows;
use motion::Policy;
use prepare::Prepared;

use super::friction::friction;
use super::goals::differing_goals;
use super::numbers::TrustNumbers;
use super::starts::slow_starts;
use super::unexplained::unexplained;
use crate::Finding;
use crate::along::along_movements;

/// Findings on velocities beside a policy's part along them, which was learnt `from_pushes` or not. There are none with a robot's inertia, which turns that part.
pub(crate) fn along_the_motion(
    policy: &dyn Policy,
    rows: &Rows,
    prepared: &Prepared,
    numbers: &TrustNumbers,
    from_pushes: bool,
) -> Vec<Finding> {
    if rows.momenta().is_some() {
        return Vec::new();
    }
    let movements = along_movements(policy, rows);
    let mut findings = Vec::new();
    findings.extend(differing_goals(&movements, prepared, numbers));
    findings.extend(friction(&movements, rows.len()));
    findings.extend(slow_starts(&movements, rows));
    // Noise and pushes are not of the policy either.
    if rows.variances().is_none() && !from_pushes {
        let predicted = numbers.held_out_error <= TrustNumbers::GOOD_HELD_OUT_ERROR;
        findings.extend(unexplained(movements, predicted));
    }
    findings
}
