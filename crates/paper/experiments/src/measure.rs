//! The measures that experiments report, and the rule by which each is judged.

use serde::{Deserialize, Serialize};

/// A measure, in the order of the paper's tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Error of the learnt potential (A3).
    PotentialNmse,
    /// Error of the unconstrained policy (A1).
    Nupe,
    /// Error of the policy under the training constraints (A2).
    Ncpe,
    /// Error of the policy under a constraint that no demonstration contains (A2).
    NcpeUnseen,
    /// Discarded trajectories, percent.
    Disc,
    /// Error of the aligned local potentials (A4).
    AlignmentNmse,
    /// Error of direct policy learning under the row's constraint (A2).
    Naive,
    /// Error of PolicyAlign under the row's constraint (A2).
    PolicyAlign,
    /// [`Measure::Nupe`] on held-out samples of all movements.
    NupeAll,
    /// [`Measure::Ncpe`] on held-out samples of all movements.
    NcpeAll,
    /// [`Measure::Nupe`] on test movements from new starts, which no learner sees.
    NupeFresh,
    /// [`Measure::NcpeUnseen`] on held-out samples of all movements.
    NcpeUnseenAll,
    /// [`Measure::Naive`] on held-out samples of all movements.
    NaiveAll,
    /// [`Measure::PolicyAlign`] on held-out samples of all movements.
    PolicyAlignAll,
    /// Test samples outside every receptive field, percent. Their prediction is the mean.
    Unsupported,
    /// Demonstrated movements that leave the robot's joint limits somewhere, percent.
    BeyondLimits,
    /// A learner's own estimate of [`Measure::Nupe`].
    ExpectedNupe,
    /// Data sets in which the slope GP finds rotation, percent.
    Rotation,
    /// Data sets that are read as free movement, percent.
    ReadFree,
    /// Data sets that are read as movements under varying constraints, percent.
    ReadConstrained,
    /// Data sets that two readings explain, percent.
    ReadAmbiguous,
    /// Data sets that no reading explains, percent.
    ReadUnexplained,
}

/// The rule by which our number is compared with the paper's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// An error that depends on the learner.
    LearnerError,
    /// An error of the baseline, which should be as large as the paper's.
    BaselineError,
    /// An error that depends on the set-up and not on the learner: that of alignment follows from the time step.
    SetUpError,
    /// A share of trajectories.
    Share,
}

/// The kind of learner whose errors a row contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowOf {
    /// A learner whose errors should be as small as possible.
    Learner,
    /// The baseline.
    Baseline,
    /// A learner that is not in the paper; it appears only in comparisons.
    Additional,
}

impl Measure {
    /// The measure's name in tables and records.
    pub fn name(self) -> &'static str {
        self.names().0
    }

    /// The measure's name for readers; the name of a share ends with "%".
    pub fn label(self) -> &'static str {
        self.names().1
    }

    fn names(self) -> (&'static str, &'static str) {
        match self {
            Measure::PotentialNmse => ("potential_nmse", "potential nMSE"),
            Measure::Nupe => ("nupe", "nUPE"),
            Measure::Ncpe => ("ncpe", "nCPE"),
            Measure::NcpeUnseen => ("ncpe_unseen", "nCPE, unseen"),
            Measure::Disc => ("disc", "discarded %"),
            Measure::AlignmentNmse => ("alignment_nmse", "alignment nMSE"),
            Measure::Naive => ("naive", "naive"),
            Measure::PolicyAlign => ("policy_align", "PolicyAlign"),
            Measure::NupeAll => ("nupe_all", "nUPE, all movements"),
            Measure::NcpeAll => ("ncpe_all", "nCPE, all movements"),
            Measure::NupeFresh => ("nupe_fresh", "nUPE, fresh movements"),
            Measure::NcpeUnseenAll => ("ncpe_unseen_all", "nCPE, unseen, all movements"),
            Measure::NaiveAll => ("naive_all", "naive, all movements"),
            Measure::PolicyAlignAll => ("policy_align_all", "PolicyAlign, all movements"),
            Measure::Unsupported => ("unsupported", "unsupported %"),
            Measure::BeyondLimits => ("beyond_limits", "beyond limits %"),
            Measure::ExpectedNupe => ("expected_nupe", "nUPE expected"),
            Measure::Rotation => ("rotation", "rotation found %"),
            Measure::ReadFree => ("read_free", "read as free %"),
            Measure::ReadConstrained => ("read_constrained", "read as constrained %"),
            Measure::ReadAmbiguous => ("read_ambiguous", "read as ambiguous %"),
            Measure::ReadUnexplained => ("read_unexplained", "read as unexplained %"),
        }
    }

    /// Whether it is a percentage.
    fn is_share(self) -> bool {
        self.label().ends_with('%')
    }

    /// The rule for this measure in a row.
    pub(crate) fn kind(self, row: RowOf) -> Kind {
        match (self, row) {
            _ if self.is_share() => Kind::Share,
            (Measure::Naive | Measure::NaiveAll, _) | (_, RowOf::Baseline) => Kind::BaselineError,
            (Measure::AlignmentNmse, _) => Kind::SetUpError,
            (_, RowOf::Learner | RowOf::Additional) => Kind::LearnerError,
        }
    }

    /// A number of the paper, with its printed digits as far as they are significant.
    pub fn show_printed(self, value: f64) -> String {
        let shown = format!("{value:.4}");
        if self.is_share() || shown.parse() != Ok(value) { self.show(value) } else { shown }
    }

    /// A value as tables show it.
    pub fn show(self, value: f64) -> String {
        self.show_like(value, value)
    }

    /// A standard deviation with the decimals of its mean; if that rounds it to zero, with its own.
    pub fn show_sd(self, sd: f64, mean: f64) -> String {
        let shown = self.show_like(sd, mean);
        if sd != 0.0 && shown.parse() == Ok(0.0) && !self.is_share() { self.show(sd) } else { shown }
    }

    /// A value with the decimals that suit `other`.
    fn show_like(self, value: f64, other: f64) -> String {
        match self {
            _ if self.is_share() => format!("{value:.2}"),
            // Exact except for rounding errors.
            _ if other != 0.0 && other.abs() < 1e-5 => format!("{value:.0e}"),
            // Table 2 has errors below a thousandth.
            _ if other.abs() < 1e-3 => format!("{value:.6}"),
            _ => format!("{value:.4}"),
        }
    }
}
