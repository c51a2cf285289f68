//! Refuses flags on the command line that would have no effect. Flags in a configuration file may be meant for other
//! commands.

use policy_align::{Choice as _, LearnerChoice};
use serde::Serialize;

use crate::cli::failure::Failure;
use crate::cli::options::flags::{FitFlags, ReadFlags, given};
use crate::cli::options::rollout_flags::RollOutFlags;

/// Flags that only some learners use, with these learners.
const OF_LEARNERS: [(&str, &[LearnerChoice]); 5] = [
    ("bandwidth", &[LearnerChoice::PolicyAlign]),
    ("init_d", &[LearnerChoice::PolicyAlign]),
    ("folds", &[LearnerChoice::PolicyAlign]),
    ("reading", &[LearnerChoice::Auto]),
    ("robot", &[LearnerChoice::Auto, LearnerChoice::Slope]),
];

/// Refuses flags that the learner does not use.
pub(crate) fn of_learner(flags: &FitFlags, learner: LearnerChoice) -> Result<(), Failure> {
    let flags = keys(flags);
    let unused = OF_LEARNERS.iter().find(|(key, learners)| {
        flags.iter().any(|(given, value)| given == key && value != "auto") && !learners.contains(&learner)
    });
    let Some((key, learners)) = unused else { return Ok(()) };
    let (flag, own) = (flag(key), word(learner));
    let others: Vec<String> = learners.iter().map(|other| format!("--learner {}", word(*other))).collect();
    let remedy = format!("no {flag}, or {}", others.join(" or "));
    Err(Failure::usage(format!("{flag} has no effect with --learner {own}"), flag, remedy))
}

/// Refuses flags for reading, except `--context`, when no file is read.
pub(crate) fn of_reading(flags: &ReadFlags) -> Result<(), Failure> {
    match keys(flags).iter().find(|(key, _)| key != "context") {
        Some((key, _)) => {
            let flag = flag(key);
            let remedy = format!("--files with recordings, or no {flag}");
            Err(Failure::usage("no recordings are read", flag, remedy))
        }
        None => Ok(()),
    }
}

/// The first of these flags that is set.
pub(crate) fn of_roll_outs(flags: &RollOutFlags) -> Option<String> {
    keys(flags).first().map(|(key, _)| flag(key))
}

/// The flag for a key.
fn flag(key: &str) -> String {
    format!("--{}", key.replace('_', "-"))
}

/// Keys and values of the flags that are set. Values that no table can hold are refused elsewhere.
fn keys(flags: &impl Serialize) -> Vec<(String, String)> {
    let value = |value: &toml::Value| value.as_str().unwrap_or_default().to_owned();
    given(flags).map_or_else(|_| Vec::new(), |table| table.iter().map(|(key, of)| (key.clone(), value(of))).collect())
}

fn word(learner: LearnerChoice) -> &'static str {
    LearnerChoice::WORDS.iter().find(|(_, choice)| *choice == learner).map_or("auto", |(word, _)| word)
}
