use gp::{Grouping, Reading};

use super::numbers::TrustNumbers;
use super::words::{direction, percent};
use crate::{Finding, StateChannel, Trust, Verdict};

/// What is known when it comes to a verdict.
pub(crate) struct Evidence<'a> {
    pub(crate) numbers: TrustNumbers,
    /// Found while preparing.
    pub(crate) findings: &'a [Finding],
    pub(crate) state: &'a [StateChannel],
}

/// The findings, the worst first, and the verdict that follows.
pub(crate) fn judge(evidence: Evidence<'_>) -> Trust {
    let Evidence { numbers, findings, state } = evidence;
    let mut findings = findings.to_vec();
    let mut found = |verdict, what: String, next: &str| findings.push(Finding { verdict, what, next: next.to_owned() });
    about_reading(&numbers, state, &mut found);
    about_error(&numbers, &mut found);
    findings.sort_by(|a, b| b.verdict.cmp(&a.verdict));
    let verdict = findings.first().map_or(Verdict::Good, |finding| finding.verdict);
    Trust { verdict, findings, numbers }
}

fn about_reading(numbers: &TrustNumbers, state: &[StateChannel], found: &mut dyn FnMut(Verdict, String, &str)) {
    match numbers.reading {
        Reading::Free | Reading::Constrained => {}
        Reading::Ambiguous => found(
            Verdict::Doubtful,
            format!(
                "two readings explain these movements equally well: nothing was constrained, or the same constraint always (they differ by {})",
                percent(numbers.gap)
            ),
            "only you know: --reading free or --reading constrained, or record movements that pass the same places in other directions",
        ),
        Reading::Unexplained => found(
            Verdict::DoNotUse,
            format!(
                "left-out movements are not predicted: errors {} and {}",
                percent(numbers.direct_error),
                percent(numbers.held_out_error)
            ),
            "too few movements, too much noise, or the movement does not depend on the place alone (time, load, target)",
        ),
        Reading::TooFew => found(
            Verdict::Doubtful,
            "too few movements to tell whether constraints acted".to_owned(),
            "record at least five",
        ),
    }
    if numbers.direction_coverage < 0.1 {
        found(
            Verdict::Doubtful,
            format!(
                "hardly anything ever moved along {} (coverage {:.3})",
                direction(&numbers.unseen_direction, state),
                numbers.direction_coverage
            ),
            "record movements that go that way",
        );
    }
}

fn about_error(numbers: &TrustNumbers, found: &mut dyn FnMut(Verdict, String, &str)) {
    let expected = numbers.expected_error;
    if expected > 0.15 {
        found(
            Verdict::Doubtful,
            format!("the policy expects an error of {} of its variance", percent(expected)),
            "record more movements, from other starts",
        );
    }
    let held = numbers.held_out_error;
    if held > 0.5 {
        found(
            Verdict::DoNotUse,
            format!("left-out movements are predicted with an error of {}", percent(held)),
            "record more",
        );
    } else if held > 0.15 {
        found(
            Verdict::Doubtful,
            format!("left-out movements are predicted with an error of {}", percent(held)),
            "record more",
        );
    }
    if numbers.grouping == Grouping::BlocksOfTime {
        found(
            Verdict::Doubtful,
            "prediction was tested on parts of the same movements".to_owned(),
            "record at least three movements",
        );
    }
}
