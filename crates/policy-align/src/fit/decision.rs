//! The decisions of a fit, with their reasons.

use gp::{AutoFit, FreeRows, Hypothesis, RowsDropped};
use prepare::numbers::{percent, squared_error};

use super::digest::Digest;
use super::options::{FitOptions, LearnerChoice};
use crate::{Decision, LeftOut, Prepared, Subject};

/// How samples became the rows of a Gaussian process; `None` if each sample is a row.
pub(super) fn rows_decision(readings: &AutoFit) -> Option<Decision> {
    let gp::TrustReport { rows, inducing, rows_dropped, task_space, .. } = readings.slope().report();
    let RowsDropped { averaged, thinned, still, noisy, in_no_stretch, contradicted } = *rows_dropped;
    let found = rows + still + noisy + thinned;
    let mut why = Vec::new();
    if averaged > 0 {
        why.push(format!("means of {} samples where velocities differ by noise alone", found + averaged));
    }
    why.extend(inducing.map(|inducing| format!("{inducing} of them represent all")));
    if thinned > 0 {
        // In a task space, each sample has several equations.
        let others = if task_space.is_some() { "other equations" } else { "others" };
        why.push(format!("{thinned} {others}, evenly spread, are not learnt from"));
    }
    if in_no_stretch > 0 {
        why.push(format!("{in_no_stretch} states are in no stretch of one constraint"));
    }
    if contradicted > 0 {
        why.push(format!("{contradicted} states in stretches that other movements contradict count less"));
    }
    let flag = if thinned == 0 && inducing.is_none() { "--max-rows" } else { "--inducing" };
    (!why.is_empty()).then(|| Decision::new(Subject::Rows, rows.to_string(), why.join("; ")).with_flag(flag))
}

/// The samples that were held in memory together; `None` if all were.
pub(super) fn digests_decision(prepared: &Prepared, digests: &[Digest], readings: &AutoFit) -> Option<Decision> {
    let further: usize = digests.iter().map(|digest| digest.data.samples).sum();
    let rows: usize = digests.iter().map(|digest| digest.indices.len()).sum();
    let why = match readings.slope().report().push {
        // Stretches can only be found in samples.
        Some(_) => format!(
            "constraints push, and only means are kept of {further} further samples, which do not show pushes: they are not learnt from"
        ),
        None => format!(
            "decisions and findings are those of these samples; {rows} rows of {further} further samples are learnt from as well"
        ),
    };
    let at_hand = format!("{} samples", prepared.demonstrations.n_samples());
    (!digests.is_empty()).then(|| Decision::new(Subject::AtOnce, at_hand, why))
}

/// All movements except those kept; PolicyAlign could not align them with the others.
pub(super) fn discarded(kept: &[usize], episodes: &[String]) -> Vec<LeftOut> {
    let others = (0..episodes.len()).filter(|episode| !kept.contains(episode));
    let why = "not aligned: no other movement passes near it";
    others.map(|at| LeftOut { episode: episodes[at].clone(), why: why.to_owned() }).collect()
}

pub(super) fn learner_decision(options: &FitOptions, readings: &AutoFit) -> Decision {
    let given = |learner| Decision::new(Subject::Learner, learner, "given");
    match options.learner {
        LearnerChoice::PolicyAlign => given("policy-align"),
        LearnerChoice::Slope => given("slope GP"),
        LearnerChoice::Direct => given("direct GP"),
        LearnerChoice::Auto => {
            let (numbers, reading) = (readings.numbers(), readings.reading());
            let learner = if readings.takes_slope() { "slope GP" } else { "direct GP" };
            let why = match options.reading {
                Some(reading) => format!("reading given: {reading:?}").to_lowercase(),
                None => format!(
                    "{}: error relative to the motion {} with direction, {} without",
                    found((reading, numbers.free), readings.takes_slope()),
                    squared_error(numbers.a_s),
                    squared_error(numbers.a_d)
                ),
            };
            Decision::new(Subject::Learner, learner, why).with_flag("--reading")
        }
    }
}

/// Whether the data show constraints, in words.
fn found((reading, free): (Hypothesis, Option<FreeRows>), takes_slope: bool) -> String {
    if let Some(free) = free {
        return format!("constraints detected, but {} of the samples move freely", percent(free.share));
    }
    let found = match reading {
        Hypothesis::Free if takes_slope => "few or no constraints detected, and directions predict better",
        Hypothesis::Free => "no constraints detected",
        Hypothesis::Constrained => "constraints detected",
        Hypothesis::Ambiguous => "free or constrained, both readings fit",
        Hypothesis::Unexplained => "neither reading fits",
        Hypothesis::TooFew => "too few movements to detect constraints",
    };
    found.to_owned()
}
