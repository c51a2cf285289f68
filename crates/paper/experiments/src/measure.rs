//! The figures that experiments report, and how each is judged.

use serde::{Deserialize, Serialize};

/// A figure of the paper, in the order of its tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Error of the learnt potential (A3).
    PotentialNmse,
    /// Error of the unconstrained policy (A1).
    Nupe,
    /// Error of the policy under the training constraints (A2).
    Ncpe,
    /// Error of the policy under a constraint that no demonstration shows (A2).
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
    /// [`Measure::Nupe`] on movements from new starts, which nobody learnt from.
    NupeFresh,
    /// [`Measure::NcpeUnseen`] on held-out samples of all movements.
    NcpeUnseenAll,
    /// [`Measure::Naive`] on held-out samples of all movements.
    NaiveAll,
    /// [`Measure::PolicyAlign`] on held-out samples of all movements.
    PolicyAlignAll,
    /// Test samples outside every receptive field, percent; they count with the mean.
    Unsupported,
    /// Demonstrated movements that leave the robot's joint limits somewhere, percent.
    BeyondLimits,
    /// What a learner expects [`Measure::Nupe`] to be.
    ExpectedNupe,
    /// Data sets in which the slope GP finds rotation, percent.
    Rotation,
    /// Data sets that are read as free movement, percent.
    ReadFree,
    /// Data sets that are read as constrained by constraints that vary, percent.
    ReadConstrained,
    /// Data sets that two readings explain, percent.
    ReadAmbiguous,
    /// Data sets that no reading explains, percent.
    ReadUnexplained,
}

/// By which rule ours and the paper's figure are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// An error that is left to the learner.
    LearnerError,
    /// An error of the baseline: it is to be as large as the paper's.
    BaselineError,
    /// An error that the set-up decides, not the learner: that of alignment follows from the time step.
    SetUpError,
    /// A share of trajectories.
    Share,
}

/// Whose errors stand in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowOf {
    /// A learner that is to be as good as it can.
    Learner,
    /// The baseline.
    Baseline,
    /// A learner that the paper does not have: it stands in comparisons only.
    Additional,
}

impl Measure {
    /// The measure's name in tables and records.
    pub fn name(self) -> &'static str {
        self.names().0
    }

    /// The measure's name for readers; of a share it ends with "%".
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

    /// Whether it is in percent.
    fn is_share(self) -> bool {
        self.label().ends_with('%')
    }

    /// How it is judged in a row.
    pub(crate) fn kind(self, row: RowOf) -> Kind {
        match (self, row) {
            _ if self.is_share() => Kind::Share,
            (Measure::Naive | Measure::NaiveAll, _) | (_, RowOf::Baseline) => Kind::BaselineError,
            (Measure::AlignmentNmse, _) => Kind::SetUpError,
            (_, RowOf::Learner | RowOf::Additional) => Kind::LearnerError,
        }
    }

    /// A figure of the paper: with the digits that it was printed with, as far as they say something.
    pub fn show_printed(self, value: f64) -> String {
        let shown = format!("{value:.4}");
        if self.is_share() || shown.parse() != Ok(value) { self.show(value) } else { shown }
    }

    /// A value as tables print it.
    pub fn show(self, value: f64) -> String {
        self.show_like(value, value)
    }

    /// A standard deviation with the decimals of its mean, as far as something is left of it.
    pub fn show_sd(self, sd: f64, mean: f64) -> String {
        let shown = self.show_like(sd, mean);
        if sd != 0.0 && shown.parse() == Ok(0.0) && !self.is_share() { self.show(sd) } else { shown }
    }

    /// A value with the decimals that suit another one.
    fn show_like(self, value: f64, other: f64) -> String {
        match self {
            _ if self.is_share() => format!("{value:.2}"),
            // What is exact but for rounding.
            _ if other != 0.0 && other.abs() < 1e-5 => format!("{value:.0e}"),
            // Table 2 has errors below a thousandth.
            _ if other.abs() < 1e-3 => format!("{value:.6}"),
            _ => format!("{value:.4}"),
        }
    }
}
