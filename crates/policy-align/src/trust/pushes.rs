//! Findings on constraints that push.

use prepare::numbers::percent;

use crate::{Finding, Topic, Verdict};

/// Pushes below this share of the policy's speed are negligible. If movements are only predictable with such pushes, these do not explain
/// how they differ.
const PUSHES: f64 = 0.01;

/// Adds a finding on pushes of a share `push` of the policy's speed. It is a remark if the policy was learnt in spite of them, which also
/// resolves the finding on a press; otherwise it is a doubt.
pub(crate) fn pushed(push: f64, learnt: bool, findings: &mut Vec<Finding>) {
    let what = format!("constraints pushed, on average with {} of the policy's speed", percent(push));
    let finding = match learnt {
        true if push < PUSHES => Finding::doubt(
            "movements are predicted only with pushes too small to matter: pushes do not explain how movements differ",
            "if that is a goal, an object or a load, record it and name its columns with --context",
        ),
        true => {
            settle(findings);
            let next = "the policy was learnt from the directions in which velocities differ: nothing to do";
            Finding::remark(what, next)
        }
        false => Finding::doubt(what, "--learner slope, which learns from the directions in which velocities differ"),
    };
    findings.insert(0, finding);
}

/// The policy was learnt from presses along varying directions, so the finding on them becomes a remark.
fn settle(findings: &mut [Finding]) {
    let of_press = findings.iter_mut().filter(|finding| finding.topic == Topic::Pressing);
    of_press.for_each(|finding| finding.verdict = Verdict::Good);
}
