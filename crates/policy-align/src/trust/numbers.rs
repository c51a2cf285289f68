use gp::{Grouping, Hypothesis, ModelKind};
use serde::{Deserialize, Serialize};

/// The numbers behind a verdict. Shares are of 1; errors are squared, as shares of the policy's variance unless stated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrustNumbers {
    /// Movements learnt from.
    pub episodes: usize,
    /// The reading of the data: whether constraints acted.
    pub reading: Hypothesis,
    /// E′ of the policy handed out: error along the path of movements left out, as a share of the policy's squares.
    pub held_out_error: f64,
    /// The same of every movement that was left out: its place among the episodes, and its error.
    pub episode_errors: Vec<(usize, f64)>,
    /// The same of the direct GP, which is what plain averaging would give.
    pub held_out_error_direct: f64,
    /// Left-out error of the direct policy in all directions, as a share of its variance.
    pub direct_error: f64,
    /// Difference of slope and direct policy.
    pub gap: f64,
    /// Expected error (nUPE) of the Gaussian process's policy on new movements; of one or two, at least `halves`, or 1 if some direction is
    /// hardly seen.
    pub expected_error: f64,
    /// Difference of the slope policies with and without rotation, where both predict about as well.
    pub ambiguity: f64,
    /// Held-out R² of the slope GP.
    pub slope_r_squared: f64,
    /// Mean squared left-out error over its predicted variance; 1 where error bars are right.
    pub z_squared: f64,
    /// n λ_min of the mean of the directions' products: 1 if all directions are observed alike, 0 if one never is.
    pub direction_coverage: f64,
    /// The least observed direction, (n).
    pub unseen_direction: Vec<f64>,
    /// Posterior over prior variance along the direction that is known least.
    pub least_known: f64,
    /// That direction, (n).
    pub least_known_direction: Vec<f64>,
    /// Σ‖π̂_rot‖²/Σ‖π̂‖² of the slope GP.
    pub rotation_share: f64,
    /// t of the test for rotation; none where there is none.
    pub rotation_t: Option<f64>,
    /// Whether the slope policy has a potential.
    pub model: ModelKind,
    /// Difference of the Gaussian processes' policies that every other movement alone would give, or both halves of a single one, as a
    /// share of the policy's variance; none where halves are too few.
    pub halves: Option<f64>,
    /// Share of the states on unconstrained roll-outs from starts between the demonstrated ones at which the Gaussian process's error bars are
    /// as large as half of what its policy varies by.
    pub unknown: f64,
    /// Share of the demonstrated starts from which the policy, rolled out without constraints, leaves the demonstrated region.
    pub leaving: f64,
    /// Share of the squared steps that is noise.
    pub step_noise: f64,
    /// The unit of leave-one-out.
    pub grouping: Grouping,
    /// Numbers of PolicyAlign's policy; none if another learner's is handed out.
    pub aligned: Option<AlignedNumbers>,
}

impl TrustNumbers {
    /// Above this `held_out_error` a policy is doubtful.
    pub const GOOD_HELD_OUT_ERROR: f64 = 0.035;
    /// Above this `expected_error` a Gaussian process's policy is doubtful: it has been too low by a factor of 3.
    pub const GOOD_EXPECTED_ERROR: f64 = 0.06;
    /// The same of PolicyAlign's policy, most of which is a difference that was measured.
    pub const GOOD_MEASURED_ERROR: f64 = 0.1;
    /// Above this difference of `halves` a policy is doubtful, unless so little error is expected that only halves are too few to learn from.
    pub const GOOD_HALVES: f64 = 0.12;
    /// Up to this `expected_error` halves may differ.
    pub const LITTLE_EXPECTED_ERROR: f64 = 0.01;
    /// Below this `direction_coverage` one direction is a guess.
    pub const GOOD_COVERAGE: f64 = 0.1;
    /// Above this share of starts whose roll-outs leave the data the goal lies outside it.
    pub const GOOD_LEAVING: f64 = 0.5;

    /// Above this difference of `halves` the policy is doubtful; none where halves may differ.
    pub fn good_halves(&self) -> Option<f64> {
        (self.expected_error > Self::LITTLE_EXPECTED_ERROR).then_some(Self::GOOD_HALVES)
    }

    /// Above this the `expected_error` of the policy handed out makes it doubtful.
    pub fn good_expected_error(&self) -> f64 {
        if self.aligned.is_some() { Self::GOOD_MEASURED_ERROR } else { Self::GOOD_EXPECTED_ERROR }
    }
}

/// Numbers of PolicyAlign's policy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlignedNumbers {
    /// σ² of the responsibilities, in the learner's units squared; none in files written before it was stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_squared: Option<f64>,
    /// Movements that were aligned.
    pub kept: usize,
    /// Movements that were not aligned.
    pub discarded: usize,
    /// Root mean square of levelled minus learnt potential, over its standard deviation.
    pub residual: f64,
    /// Share of held-out samples outside the policy's support.
    pub unsupported: f64,
    /// Difference of its predictions of movements left out from those of the Gaussian process's policy, as a share of that one's
    /// variance.
    pub difference: f64,
}
