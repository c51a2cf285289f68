use align::Bandwidth;
use gp::Hypothesis;
use prepare::{Repair, VelocityUse};

use crate::LearnerChoice;

/// An option that is chosen by a word, the same in the program's flags, in configuration files and in Python.
pub trait Choice: Copy + 'static {
    /// All words and their choices.
    const WORDS: &'static [(&'static str, Self)];

    /// The choice for a word; `None` for an unknown word.
    fn of(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, _)| *known == word).map(|(_, choice)| *choice)
    }

    /// The words as a list in a sentence, in quotes: "a", "b" or "c".
    fn listed(quote: &str) -> String {
        let words: Vec<String> = Self::WORDS.iter().map(|(word, _)| format!("{quote}{word}{quote}")).collect();
        let (last, others) = words.split_last().expect("there is a choice");
        format!("{} or {last}", others.join(", "))
    }
}

impl Choice for VelocityUse {
    const WORDS: &'static [(&'static str, Self)] =
        &[("auto", VelocityUse::Auto), ("velocity", VelocityUse::Recorded), ("displacement", VelocityUse::Ignored)];
}

impl Choice for Repair {
    const WORDS: &'static [(&'static str, Self)] = &[("auto", Repair::Auto), ("keep", Repair::Keep)];
}

impl Choice for LearnerChoice {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("auto", LearnerChoice::Auto),
        ("policy-align", LearnerChoice::PolicyAlign),
        ("slope", LearnerChoice::Slope),
        ("direct", LearnerChoice::Direct),
    ];
}

impl Choice for Hypothesis {
    const WORDS: &'static [(&'static str, Self)] =
        &[("free", Hypothesis::Free), ("constrained", Hypothesis::Constrained)];
}

impl Choice for Bandwidth {
    const WORDS: &'static [(&'static str, Self)] =
        &[("narrow", Bandwidth::Narrow), ("medium", Bandwidth::Medium), ("wide", Bandwidth::Wide)];
}
