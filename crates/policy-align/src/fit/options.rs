use align::Bandwidth;
use gp::{AutoGp, DirectGp, FrontEnd, Hypothesis, PushTest, SlopeGp};
use serde::{Deserialize, Serialize};

use crate::FitError;

/// Share of the rows whose marginal likelihood sets amplitudes.
const HYPER_SHARE: f64 = 0.5;

/// Options of learning; by default everything is decided from the data.
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// `--learner`.
    pub learner: LearnerChoice,
    /// A reading given by the user, which overrides that of the data (`--reading`).
    pub reading: Option<Hypothesis>,
    /// For PolicyAlign; none: chosen by held-out movements (`--bandwidth`).
    pub bandwidth: Option<Bandwidth>,
    /// For PolicyAlign; none: chosen by held-out movements (`--init-d`).
    pub init_d: Option<f64>,
    /// Folds of the cross-validation over episodes (`--folds`).
    pub folds: usize,
    /// Seed of every random choice (`--seed`).
    pub seed: u64,
    /// Rows on which models are selected, at most, spread in time along the movements (`--max-rows`). If more are recorded and `inducing` is
    /// not 0, the policy may be learnt from more.
    pub max_rows: usize,
    /// Inducing rows, which represent all rows if more than `max_rows` are recorded; 0: only `max_rows` are learnt from (`--inducing`).
    pub inducing: usize,
    /// Text of a URDF whose joints are the channels (`--robot`): constraints of its last links are tried (S40), and its mass matrix as their
    /// metric.
    pub robot: Option<String>,
}

/// The learner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LearnerChoice {
    /// Slope GP or direct GP, as the data say.
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
    /// The slope GP and the direct GP that [`fit`](crate::fit()) lets learn from rows, and chooses between.
    pub fn gaussian_processes(&self) -> AutoGp {
        let &FitOptions { max_rows, inducing, reading, .. } = self;
        let hyper_rows = (max_rows as f64 * HYPER_SHARE) as usize;
        AutoGp {
            front_end: FrontEnd::Velocities, // the rows are made already
            slope: SlopeGp {
                max_rows,
                hyper_rows,
                inducing_rows: inducing,
                push_test: PushTest::Fit,
                ..SlopeGp::default()
            },
            direct: DirectGp { max_rows, hyper_rows, ..DirectGp::default() },
            reading,
        }
    }

    /// The option that asks for whole recordings, if one does, as a flag: then there can be no [`Digest`](crate::Digest).
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
