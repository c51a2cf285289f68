//! Descriptions of a model.

use gp::Hypothesis;
use policy_align::{Learnt, Model, Verdict};
use prepare::numbers::percent;

use crate::cli::given::value_word;
use crate::cli::lines::{counted, short};

/// The model's verdict in words.
pub(crate) fn verdict(model: &Model) -> &'static str {
    match model.trust.verdict {
        Verdict::Good => "good: all checks passed",
        Verdict::Doubtful => "doubtful: read the findings before using it",
        Verdict::DoNotUse => "do not use",
    }
}

/// A `--context` flag with the median context of a model.
pub(crate) fn context_flag(model: &Model) -> String {
    let values = model.context.iter().map(|channel| format!("{}={}", channel.name, short(channel.median)));
    let values: Vec<String> = values.collect();
    if values.is_empty() { String::new() } else { format!(" --context {}", value_word(&values.join(","))) }
}

/// The context of a model's policy, such as `goal_x 0.3, goal_y 0.2`, for up to two channels; `None` without a context.
pub(crate) fn at_context(model: &Model) -> Option<String> {
    let values = model.context.iter().zip(&model.chosen_context);
    let words: Vec<String> = values.map(|(channel, value)| format!("{} {}", channel.name, short(*value))).collect();
    match words.len() {
        0 => None,
        1 | 2 => Some(words.join(", ")),
        _ => Some("one context".to_owned()),
    }
}

/// Description of the learner.
pub(crate) fn learner(model: &Model) -> String {
    match &model.learnt {
        Learnt::PolicyAlign(policy) => {
            let fields = policy.global_potential().regression().model().receptive_fields(0).count();
            format!("aligned potentials and LWPR, {}", counted(fields, "receptive field"))
        }
        Learnt::Slope(_) => "slope GP: a potential, from its slopes along the movements".to_owned(),
        Learnt::Direct(_) => "direct GP: velocities as observed".to_owned(),
        Learnt::Auto(both) => {
            let reading = both.overridden().unwrap_or(both.reading());
            let taken = if both.takes_slope() { "slope GP" } else { "direct GP" };
            let reading = match reading {
                Hypothesis::TooFew => "too few movements".to_owned(),
                reading => format!("{reading:?}").to_lowercase(),
            };
            let free = both.numbers().free.map(|free| format!("; {} of the samples move freely", percent(free.share)));
            format!("{taken}, chosen automatically (reading: {reading}{})", free.unwrap_or_default())
        }
    }
}
