//! Constraints that pushed.

use prepare::{Prepared, pressing};

use crate::{Finding, Verdict};

/// Pushes below this share of the policy's speed do not matter: where only they make movements predictable, something else differs.
const PUSHES: f64 = 0.01;

/// Adds what pushes mean, of a share `push` of the policy's speed: a remark where the policy was learnt in spite of them, which also settles the
/// finding on a press, and a doubt elsewhere.
pub(crate) fn pushed(push: f64, learnt: bool, prepared: &Prepared, findings: &mut Vec<Finding>) {
    let what = format!("constraints pushed, on average with {:.0} % of the policy's speed", 100.0 * push);
    let finding = match learnt {
        true if push < PUSHES => found(
            Verdict::Doubtful,
            "movements are predicted only with pushes too small to matter: they differ by something else".to_owned(),
            "if that is a goal, an object or a load, record it and name its columns with --context",
        ),
        true => {
            settle(prepared, findings);
            let next = "the policy was learnt from the directions in which velocities differ: nothing to do";
            found(Verdict::Good, what, next)
        }
        false => found(
            Verdict::Doubtful,
            what,
            "--learner slope, which learns from the directions in which velocities differ",
        ),
    };
    findings.insert(0, finding);
}

fn found(verdict: Verdict, what: String, next: &str) -> Finding {
    Finding { verdict, what, next: next.to_owned() }
}

/// A press along directions that differ is learnt from.
fn settle(prepared: &Prepared, findings: &mut [Finding]) {
    let press = pressing(&prepared.demonstrations, &prepared.state);
    let of_press = findings.iter_mut().filter(|finding| Some(&**finding) == press.as_ref());
    of_press.for_each(|finding| finding.verdict = Verdict::Good);
}
