use align::Bandwidth;
use gp::{AutoGp, Hypothesis, PushTest, SlopeGp};
use serde::{Deserialize, Serialize};

use crate::FitError;

/// Share of `max_rows` that determines amplitudes by marginal likelihood.
const HYPER_SHARE: f64 = 0.5;

/// Options for learning; by default everything is chosen from the data.
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// `--learner`.
    pub learner: LearnerChoice,
    /// Reading given by the user, which overrides that of the data (`--reading`).
    pub reading: Option<Hypothesis>,
    /// Bandwidth for PolicyAlign; `None`: chosen by cross-validation (`--bandwidth`).
    pub bandwidth: Option<Bandwidth>,
    /// `init_d` for PolicyAlign; `None`: chosen by cross-validation (`--init-d`).
    pub init_d: Option<f64>,
    /// Folds of the cross-validation over episodes (`--folds`).
    pub folds: usize,
    /// Random seed (`--seed`).
    pub seed: u64,
    /// Largest number of rows for model selection, spread in time along the movements (`--max-rows`). If there are more rows and `inducing`
    /// is not 0, the policy may be learnt from more.
    pub max_rows: usize,
    /// Number of inducing rows, which represent all rows if there are more than `max_rows`; 0: the policy is learnt from `max_rows` alone
    /// (`--inducing`).
    pub inducing: usize,
    /// Text of a URDF whose joints are the channels (`--robot`). The fit tries constraints on its last links (S40), and its mass matrix as
    /// the metric.
    pub robot: Option<String>,
}

/// The learner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LearnerChoice {
    /// Slope GP or direct GP, chosen from the data.
    #[default]
    Auto,
    /// Aligned potentials and LWPR.
    PolicyAlign,
    /// The slope GP.
    Slope,
    /// The direct GP.
    Direct,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions {
            learner: LearnerChoice::Auto,
            reading: None,
            bandwidth: None,
            init_d: None,
            folds: 5,
            seed: 1,
            max_rows: 400,
            inducing: 500,
            robot: None,
        }
    }
}

impl FitOptions {
    /// The slope GP and the direct GP between which [`fit`](crate::fit()) chooses.
    pub fn gaussian_processes(&self) -> AutoGp {
        let &FitOptions { max_rows, inducing, reading, .. } = self;
        let hyper_rows = (max_rows as f64 * HYPER_SHARE) as usize;
        AutoGp {
            slope: SlopeGp {
                max_rows,
                hyper_rows,
                inducing_rows: inducing,
                push_test: PushTest::Fit,
                ..SlopeGp::default()
            },
            reading,
            free_rows: self.learner != LearnerChoice::Direct,
            ..AutoGp::default()
        }
    }

    /// The flag of the option that needs whole recordings, if there is one. Then a [`Digest`](crate::Digest) cannot be used.
    pub fn needs_whole_recordings(&self) -> Option<&'static str> {
        match (self.learner, &self.robot) {
            (LearnerChoice::PolicyAlign, _) => Some("--learner policy-align"),
            (_, Some(_)) => Some("--robot"),
            _ => None,
        }
    }

    pub(super) fn check(&self) -> Result<(), FitError> {
        let wrong = |name, value, requirement| Err(FitError::Option { name, value, requirement });
        if self.folds < 2 {
            return wrong("--folds", self.folds as f64, "be at least 2");
        }
        if self.max_rows < 50 {
            return wrong("--max-rows", self.max_rows as f64, "be at least 50");
        }
        if self.max_rows > gp::MOST_ROWS {
            return wrong("--max-rows", self.max_rows as f64, "be at most 10000");
        }
        if self.inducing > gp::MOST_ROWS {
            return wrong("--inducing", self.inducing as f64, "be at most 10000");
        }
        match self.init_d {
            Some(init_d) if !(init_d > 0.0 && init_d.is_finite()) => {
                wrong("--init-d", init_d, "be positive and finite")
            }
            _ => Ok(()),
        }
    }
}
