use align::Bandwidth;
use gp::Hypothesis;
use prepare::{Repair, VelocityUse};

use crate::LearnerChoice;

/// A choice by its word, the same in the program's flags, in files of flags and in Python.
pub trait Choice: Copy + 'static {
    /// Every word, and what it chooses.
    const WORDS: &'static [(&'static str, Self)];

    /// What a word chooses; none if it is no such word.
    fn of(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, _)| *known == word).map(|(_, choice)| *choice)
    }

    /// The words in a sentence, between quotes: "a", "b" or "c".
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
