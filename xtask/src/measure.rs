//! The figures that experiments report, and how each is judged.

use serde::{Deserialize, Serialize};

/// A figure of the paper, in the order of its tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Measure {
    /// Error of the learnt potential (A3).
    PotentialNmse,
    /// Error of the unconstrained policy (A1).
    Nupe,
    /// Error of the policy under the training constraints (A2).
    Ncpe,
    /// Discarded trajectories, percent.
    Disc,
    /// Error of the aligned local potentials (A4).
    AlignmentNmse,
}

/// By which rule ours and the paper's figure are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// An error of the learner: lower is better.
    LearnerError,
    /// A share of trajectories: neither direction is better.
    Share,
}

impl Measure {
    /// The measure's name in tables and records.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Measure::PotentialNmse => "potential_nmse",
            Measure::Nupe => "nupe",
            Measure::Ncpe => "ncpe",
            Measure::Disc => "disc",
            Measure::AlignmentNmse => "alignment_nmse",
        }
    }

    /// How it is judged.
    pub(crate) fn kind(self) -> Kind {
        match self {
            Measure::Disc => Kind::Share,
            _ => Kind::LearnerError,
        }
    }

    /// A value as tables print it.
    pub(crate) fn show(self, value: f64) -> String {
        match self {
            Measure::Disc => format!("{value:.2}"),
            _ => format!("{value:.4}"),
        }
    }
}
