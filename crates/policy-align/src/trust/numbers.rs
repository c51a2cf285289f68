use gp::{Grouping, Hypothesis, ModelKind};
use serde::{Deserialize, Serialize};

/// The numbers behind a verdict. Shares are fractions of 1; errors are squared and relative to the policy's variance unless stated
/// otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrustNumbers {
    /// Number of movements in the training data.
    pub episodes: usize,
    /// The reading of the data: whether the movements were constrained.
    pub reading: Hypothesis,
    /// E′ of the model's policy: error along the path of left-out movements, relative to the policy's mean square.
    pub held_out_error: f64,
    /// `held_out_error` of every left-out movement: index of the episode, and error.
    pub episode_errors: Vec<(usize, f64)>,
    /// `held_out_error` of the direct GP, which amounts to plain averaging.
    pub held_out_error_direct: f64,
    /// Left-out error of the direct policy in all directions, relative to its variance.
    pub direct_error: f64,
    /// Difference between the slope and the direct policy.
    pub gap: f64,
    /// Expected error (nUPE) of the Gaussian process's policy on new movements. With one or two movements it is at least `halves`, or 1 if
    /// some direction is hardly observed.
    pub expected_error: f64,
    /// Difference between the slope policies with and without rotation, if both predict about equally well.
    pub ambiguity: f64,
    /// Held-out R² of the slope GP.
    pub slope_r_squared: f64,
    /// Mean of the squared left-out errors over their predicted variances; 1 if error bars are right.
    pub z_squared: f64,
    /// n λ_min of the mean outer product of the directions: 1 if all directions are observed equally, 0 if one is never observed.
    pub direction_coverage: f64,
    /// The least observed direction, (n).
    pub unseen_direction: Vec<f64>,
    /// Ratio of posterior to prior variance along the least known direction.
    pub least_known: f64,
    /// The least known direction, (n).
    pub least_known_direction: Vec<f64>,
    /// Σ‖π̂_rot‖²/Σ‖π̂‖² of the slope GP.
    pub rotation_share: f64,
    /// t of the test for rotation; `None` without a test.
    pub rotation_t: Option<f64>,
    /// Whether the slope policy has a potential.
    pub model: ModelKind,
    /// Difference between the Gaussian processes' policies learnt from every other movement and from the rest, or from both halves of a
    /// single movement, relative to the policy's variance; `None` if the halves have too few data.
    pub halves: Option<f64>,
    /// Share of the states on unconstrained roll-outs from starts between the demonstrated ones at which the Gaussian process's error bars
    /// exceed half of its policy's standard deviation.
    pub unknown: f64,
    /// Share of the demonstrated starts from which the policy, rolled out without constraints, leaves the demonstrated region.
    pub leaving: f64,
    /// Share of the squared steps that is noise.
    pub step_noise: f64,
    /// The unit of cross-validation: movements, or blocks of time.
    pub grouping: Grouping,
    /// Numbers of PolicyAlign's policy; `None` with another learner.
    pub aligned: Option<AlignedNumbers>,
}

impl TrustNumbers {
    /// A policy is doubtful above this `held_out_error`.
    pub const GOOD_HELD_OUT_ERROR: f64 = 0.035;
    /// A Gaussian process's policy is doubtful above this `expected_error`, which has been too low by up to a factor of 3.
    pub const GOOD_EXPECTED_ERROR: f64 = 0.06;
    /// PolicyAlign's policy is doubtful above this `expected_error`, most of which is a measured difference.
    pub const GOOD_MEASURED_ERROR: f64 = 0.1;
    /// A policy is doubtful above this difference of `halves`, unless the expected error is so small that the halves merely have too few
    /// data.
    pub const GOOD_HALVES: f64 = 0.12;
    /// Up to this `expected_error`, the halves may differ.
    pub const LITTLE_EXPECTED_ERROR: f64 = 0.01;
    /// Below this `direction_coverage`, the policy along one direction is a guess.
    pub const GOOD_COVERAGE: f64 = gp::LeastSeen::COVERED;
    /// Above this share of roll-outs that leave the data, the goal lies outside the data.
    pub const GOOD_LEAVING: f64 = 0.5;

    /// The policy is doubtful above this difference of `halves`; `None` if the halves may differ.
    pub fn good_halves(&self) -> Option<f64> {
        (self.expected_error > Self::LITTLE_EXPECTED_ERROR).then_some(Self::GOOD_HALVES)
    }

    /// The model's policy is doubtful above this `expected_error`.
    pub fn good_expected_error(&self) -> f64 {
        if self.aligned.is_some() { Self::GOOD_MEASURED_ERROR } else { Self::GOOD_EXPECTED_ERROR }
    }
}

/// Numbers of PolicyAlign's policy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlignedNumbers {
    /// σ² of the responsibilities, in squared learner's units; `None` in files written before it was stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_squared: Option<f64>,
    /// Number of aligned movements.
    pub kept: usize,
    /// Number of movements that were not aligned.
    pub discarded: usize,
    /// Root mean square difference between aligned and learnt potential, over its standard deviation.
    pub residual: f64,
    /// Share of held-out samples outside the policy's support.
    pub unsupported: f64,
    /// Difference between its predictions of left-out movements and those of the Gaussian process's policy, relative to the latter's
    /// variance.
    pub difference: f64,
}
