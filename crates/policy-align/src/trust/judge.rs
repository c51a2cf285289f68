use std::cmp::Reverse;

use gp::{Grouping, Hypothesis};
use motion::upper_median;
use prepare::direction_by_channels;
use prepare::numbers::{percent, short};

use super::numbers::TrustNumbers;
use crate::{Finding, LearnerChoice, StateChannel, Trust, Verdict};

/// Left-out error along the path above which a policy is wrong.
const WRONG: f64 = 0.5;
/// Expected error of PolicyAlign's policy above which it is wrong.
const FAR: f64 = 0.8;
/// An episode is named if its error exceeds the median by this factor.
const ODD: f64 = 10.0;
/// Unconstrained motion covers all directions; less coverage than this may be a constraint.
const SPREAD: f64 = 0.25;
/// Largest share of uncertain states between the demonstrations; above it, other movements will meet such states.
const UNKNOWN: f64 = 0.1;

/// Input of a verdict.
pub(crate) struct VerdictInput<'a> {
    pub(crate) numbers: TrustNumbers,
    /// All findings so far: of readers, of `prepare` and on the policy's residuals.
    pub(crate) findings: &'a [Finding],
    pub(crate) state: &'a [StateChannel],
    /// Names of the movements in the training data.
    pub(crate) episodes: &'a [String],
    pub(crate) learner: LearnerChoice,
    /// The reading given by the user, if any.
    pub(crate) given: Option<Hypothesis>,
}

/// The findings, the worst first, and the resulting verdict.
pub(crate) fn judge(evidence: VerdictInput<'_>) -> Trust {
    let VerdictInput { numbers, findings, state, episodes, learner, given } = evidence;
    let mut findings = findings.to_vec();
    about_reading(&numbers, state, (learner, given), &mut findings);
    about_episodes(&numbers, episodes, &mut findings);
    about_error(&numbers, &mut findings);
    findings.sort_by_key(|finding| Reverse(finding.verdict));
    Trust { verdict: Verdict::worst(&findings), findings, numbers }
}

fn about_reading(
    numbers: &TrustNumbers,
    state: &[StateChannel],
    given: (LearnerChoice, Option<Hypothesis>),
    findings: &mut Vec<Finding>,
) {
    let direction = direction_by_channels(&numbers.unseen_direction, state);
    let coverage = short(numbers.direction_coverage);
    match numbers.reading {
        Hypothesis::Constrained => {}
        Hypothesis::Ambiguous => about_two_readings(numbers, given, findings),
        Hypothesis::Free if numbers.direction_coverage < SPREAD => findings.push(Finding::doubt(
            format!("no constraint was detected, but movements hardly vary along {direction} (coverage {coverage})"),
            "either the policy does not move that way or a constraint always blocks it: record movements in that direction",
        )),
        Hypothesis::Free => findings.push(Finding::remark(
            "no constraint was detected; one common to all movements cannot be detected",
            "if there is one, record movements without it",
        )),
        Hypothesis::Unexplained => findings.push(Finding::new(
            if numbers.held_out_error > WRONG { Verdict::DoNotUse } else { Verdict::Doubtful },
            format!(
                "held-out movements are not predicted: error {} without constraints, {} with",
                percent(numbers.direct_error),
                percent(numbers.held_out_error)
            ),
            "record more movements or reduce noise, or record what else the motion depends on (time, load, target); what is constant during a movement can be given as --context",
        )),
        Hypothesis::TooFew => {
            findings.push(Finding::doubt("too few movements to detect constraints", "record at least five"));
        }
    }
    if numbers.direction_coverage < TrustNumbers::GOOD_COVERAGE {
        findings.push(Finding::doubt(
            format!("almost no movement along {direction} (coverage {coverage})"),
            "record movements in that direction, or --ignore a channel that is no coordinate or follows from others",
        ));
    }
}

/// The finding that the data fit both no constraint and one common constraint. A reading given by the user resolves it, if the learner uses
/// readings.
fn about_two_readings(numbers: &TrustNumbers, given: (LearnerChoice, Option<Hypothesis>), findings: &mut Vec<Finding>) {
    let what = format!(
        "two readings explain these movements equally well, no constraint or one common to all: their policies differ by {}",
        percent(numbers.gap)
    );
    match given {
        (LearnerChoice::Auto, Some(Hypothesis::Free)) => {
            findings.push(Finding::remark(
                what,
                "the policy is right if nothing was constrained, as given (--reading)",
            ));
        }
        (LearnerChoice::Auto, Some(_)) => {
            findings.push(Finding::remark(what, "the policy is right if constraints acted, as given (--reading)"));
        }
        (LearnerChoice::Auto, None) => findings.push(Finding::doubt(
            what,
            "set --reading free or --reading constrained, or record movements that cross the same places in other directions",
        )),
        _ => findings.push(Finding::doubt(
            what,
            "record movements that cross the same places in other directions, or use --learner auto with --reading free or --reading constrained",
        )),
    }
}

/// Names the source of a number if the model's policy is not the Gaussian process's.
fn by_gp(numbers: &TrustNumbers) -> &'static str {
    if numbers.aligned.is_some() { " by the Gaussian process" } else { "" }
}

fn about_error(numbers: &TrustNumbers, findings: &mut Vec<Finding>) {
    let expected = numbers.expected_error;
    let measured = numbers.aligned.is_some();
    let by_gp = by_gp(numbers);
    if measured && expected > FAR && numbers.halves.is_some_and(|halves| halves < TrustNumbers::GOOD_HALVES) {
        findings.push(Finding::new(
            Verdict::DoNotUse,
            format!("the Gaussian process confidently learns another policy: they differ by {}", percent(expected)),
            "use --learner auto",
        ));
    } else if expected > numbers.good_expected_error() {
        findings.push(Finding::doubt(
            format!("the expected error is {} of the policy's variance", percent(expected)),
            "record more movements, from other starts",
        ));
    }
    let held = numbers.held_out_error;
    if held > TrustNumbers::GOOD_HELD_OUT_ERROR {
        findings.push(Finding::new(
            if held > WRONG { Verdict::DoNotUse } else { Verdict::Doubtful },
            format!("held-out movements are predicted with an error of {}", percent(held)),
            "record more movements, especially where errors are largest",
        ));
    }
    if let Some(halves) = numbers.halves.filter(|&halves| halves > TrustNumbers::GOOD_HALVES) {
        let (verdict, next) = match numbers.good_halves() {
            Some(_) => (Verdict::Doubtful, "record more movements, from other starts, or reduce noise"),
            None => {
                (Verdict::Good, "half of the movements do not suffice, all of them do: the expected error is small")
            }
        };
        findings.push(Finding::new(
            verdict,
            format!("policies learnt{by_gp} from two halves of the movements differ by {}", percent(halves)),
            next,
        ));
    }
    if numbers.unknown > UNKNOWN {
        findings.push(Finding::doubt(
            format!(
                "between the demonstrations, the policy{by_gp} is uncertain on {} of the way",
                percent(numbers.unknown)
            ),
            "record movements from starts in between; a roll-out shows where support ends",
        ));
    }
    if numbers.leaving > TrustNumbers::GOOD_LEAVING {
        findings.push(Finding::doubt(
            format!(
                "unconstrained roll-outs leave the data from {} of the starts: the goal lies outside, or time runs backwards",
                percent(numbers.leaving)
            ),
            "plot a roll-out; record movements up to their goal",
        ));
    }
    if numbers.grouping == Grouping::BlocksOfTime {
        findings.push(Finding::doubt(
            "prediction was tested on parts of the same movements",
            "record at least three movements",
        ));
    }
}

/// Names an episode whose error, predicted from the others, is much larger than usual: another task, a tracking fault, or an isolated
/// region. It makes the policy doubtful if the other episodes alone would be predicted well.
fn about_episodes(numbers: &TrustNumbers, episodes: &[String], findings: &mut Vec<Finding>) {
    let errors: Vec<f64> = numbers.episode_errors.iter().map(|&(_, error)| error).collect();
    let worst = numbers.episode_errors.iter().max_by(|(_, a), (_, b)| a.total_cmp(b));
    let (Some(usual), Some(&(episode, error))) = (upper_median(errors), worst) else { return };
    let is_odd = error > ODD * usual && error > TrustNumbers::GOOD_HELD_OUT_ERROR;
    if is_odd && numbers.grouping != Grouping::BlocksOfTime {
        let others = numbers.episode_errors.iter().filter(|(other, _)| *other != episode).map(|(_, error)| error);
        let of_others = others.sum::<f64>() / (numbers.episode_errors.len() - 1) as f64;
        let spoils = numbers.held_out_error > TrustNumbers::GOOD_HELD_OUT_ERROR
            && of_others <= TrustNumbers::GOOD_HELD_OUT_ERROR;
        let (episode, error, usual) = (&episodes[episode], percent(error), percent(usual));
        findings.push(Finding::new(
            if spoils { Verdict::Doubtful } else { Verdict::Good },
            format!("episode {episode} is predicted worst{}: error {error}, median {usual}", by_gp(numbers)),
            "check it: another task, a tracking fault, or a place that no other movement visits? --hold-out learns without it",
        ));
    }
}
