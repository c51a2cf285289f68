//! Findings on the residuals r − nᵀπ̂ of movements against a policy.

use gp::Rows;
use motion::Policy;
use prepare::Prepared;

use super::friction::friction;
use super::goals::differing_goals;
use super::numbers::TrustNumbers;
use super::slow_starts::slow_starts;
use super::unexplained::unexplained;
use crate::Finding;
use crate::along::along_movements;

/// Findings on the difference between speeds and the policy's component along them; the policy was learnt `from_pushes` or not. With a
/// robot's inertia there are none, because it rotates that component.
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
    // Noise and pushes also leave residuals.
    if rows.variances().is_none() && !from_pushes {
        let predicted = numbers.held_out_error <= TrustNumbers::GOOD_HELD_OUT_ERROR;
        findings.extend(unexplained(movements, predicted));
    }
    findings
}
