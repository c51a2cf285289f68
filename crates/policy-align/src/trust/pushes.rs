//! Constraints that pushed.

use prepare::{Prepared, pressing};

use crate::{Finding, Verdict};

/// Pushes below this share of the policy's speed do not matter: where only they make movements predictable, something else differs.
const PUSHES: f64 = 0.01;

/// Adds what pushes mean: a remark where the policy was learnt in spite of them, which also settles the finding on a press, and a doubt elsewhere.
pub(crate) fn pushed(push: f64, learnt: bool, prepared: &Prepared, findings: &mut Vec<Finding>) {
    let (verdict, next) = match learnt {
        true if push < PUSHES => (
            Verdict::Doubtful,
            "that is too little to matter, so movements differ by something else: if it is a goal or a load, record it and name its columns with --context",
        ),
        true => {
            settle(prepared, findings);
            (Verdict::Good, "the policy was learnt from the directions in which velocities differ: nothing to do")
        }
        false => (Verdict::Doubtful, "--learner slope, which learns from the directions in which velocities differ"),
    };
    let what = format!("constraints pushed, on average with {:.0} % of the policy's speed", 100.0 * push);
    findings.push(Finding { verdict, what, next: next.to_owned() });
}

/// A press along directions that differ is learnt from.
fn settle(prepared: &Prepared, findings: &mut [Finding]) {
    let press = pressing(&prepared.demonstrations, &prepared.state);
    findings
        .iter_mut()
        .filter(|finding| Some(&**finding) == press.as_ref())
        .for_each(|finding| finding.verdict = Verdict::Good);
}
