//! Section 4.3: 22 joints of a humanoid, one hand in a plane.

use align::{DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::{HandInPlane, n_leaving_limits};
use gp::FrontEnd;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::baselines::{Baselines, BaselinesTrial};
use crate::evaluation::comparison::{Comparison, Method};
use crate::evaluation::protocol::Protocol;
use crate::evaluation::recipe::Recipe;
use crate::measure::Measure;
use crate::paper::{explanations, paper_table};
use crate::robots::upper_body;
use crate::setting::{Class, SILENT, Setting, TIME_STEP};
use crate::{Experiment, Measures, Row, Setup, Trial};

/// The system whose random stream is used.
const BODY_SYSTEM: u32 = 430;

/// The id of its only row in the paper.
const ROW: &str = "policy_align";

/// The prefix of the rows of other learners.
const CASE: &str = "body";

/// The experiment.
pub(crate) fn asimo22() -> anyhow::Result<Experiment> {
    let scenario = HandInPlane::new(upper_body()?);
    let baselines = baselines();
    let comparison =
        |measure| Comparison::of(CASE, measure, &baselines.methods()).with(Method::PolicyAlign, ROW, measure);
    Ok(Experiment {
        id: "asimo22",
        section: "4.3",
        title: "22 joints of a humanoid, a hand in a plane",
        data_sets: 50,
        remark: "The robot, its posture \"ready\" (shoulder pitch 0.3 rad, roll ±0.3 rad, elbow -1.6 rad) and the attractor (upright, arms hanging) \
                 are fitted; starts from N(ready, 0.1 I), δt = 0.5 s, plain Euler, narrow bandwidth. Table 1's regression (22 passes) with inputs divided by 0.8; \
                 receptive fields count down to an activation of 1e-15, because single starts are far from all others. Starts are within the joints' limits; \
                 movements are not held there, and most leave them somewhere (beyond limits %).",
        reservations: &[
            "Four of five demonstrated movements leave the robot's joint limits somewhere; the paper does not say whether its own do.",
            "The paper has no naive learner here. Ours errs less than PolicyAlign.",
        ],
        decisions: "asimo22.md",
        comparisons: [Measure::Nupe, Measure::Ncpe].map(comparison).into(),
        setups: vec![
            printed(scenario.clone(), SPREAD, &recipe()),
            BaselinesTrial::setup(("beside", BODY_SYSTEM), &[CASE], scenario, vec![PolicyAlign::default()], baselines),
        ],
        paper: paper_table(include_str!("../../paper/asimo22.toml"))?,
        explanations: explanations("asimo22", include_str!("../../paper/asimo22-explained.toml"))?,
        ..Experiment::default()
    })
}

/// The learners other than PolicyAlign. The naive learner has wider receptive fields than PolicyAlign, which reduce its error,
/// and fewer passes.
fn baselines() -> Baselines {
    let regressor = LwprRegressor { passes: 3, ..Recipe::default().naive(22, 2.2).regressor };
    let naive = Some(DirectPolicyLearning { regressor });
    Baselines { naive, ..Baselines::of_gaussians(FrontEnd::FiniteDifferences, 1000) }
}

/// Divisor of PolicyAlign's inputs.
const SPREAD: f64 = 0.8;

/// Receptive fields with an activation below this power of ten do not contribute to a prediction. It excludes hardly any,
/// because starts far from all others have no better ones.
const CUTOFF: f64 = -15.0;

fn recipe() -> Recipe {
    Recipe { cutoff: 10.0_f64.powf(CUTOFF), ..Recipe::default() }
}

/// The printed row.
fn printed(scenario: HandInPlane, spread: f64, recipe: &Recipe) -> Setup {
    let protocol = recipe.protocol(PolicyAlign::default(), 22, spread);
    Setup::new(ROW, BODY_SYSTEM, 85_000_000, vec![Row::of_learner(ROW)], BodyTrial { scenario, protocol })
}

/// The settings, with their origin.
pub(crate) fn settings() -> Vec<Setting> {
    let setting = |name, used, change: fn(&mut HandInPlane, f64)| {
        Setting::new("asimo22", name, Class::Fitted, SILENT, used, move |value| {
            let mut scenario = HandInPlane::new(upper_body()?);
            change(&mut scenario, value);
            Ok(vec![printed(scenario, SPREAD, &recipe())])
        })
    };
    let mut settings = vec![
        Setting::new("asimo22", "divisor of the joints, rad", Class::Fitted, SILENT, SPREAD, |spread| {
            Ok(vec![printed(HandInPlane::new(upper_body()?), spread, &recipe())])
        }),
        setting("attractor, as a share of the way from \"ready\" to hanging arms", 1.0, |scenario, share| {
            scenario.potential.centre += scenario.body.ready() * (1.0 - share);
        }),
        Setting::new("asimo22", "cutoff of predictions, power of ten", Class::Fitted, SILENT, CUTOFF, |exponent| {
            let recipe = Recipe { cutoff: 10.0_f64.powf(exponent), ..recipe() };
            Ok(vec![printed(HandInPlane::new(upper_body()?), SPREAD, &recipe)])
        }),
        setting(TIME_STEP, 0.5, |scenario, time_step| scenario.roll_out.time_step = time_step),
    ];
    settings.extend(
        recipe().settings("asimo22", |recipe| Ok(vec![printed(HandInPlane::new(upper_body()?), SPREAD, recipe)])),
    );
    settings
}

#[derive(Serialize)]
struct BodyTrial {
    scenario: HandInPlane,
    protocol: Protocol,
}

impl Trial for BodyTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.scenario.record(rng)?;
        let mut rows = self.protocol.evaluate(&recordings, rng)?.rows()?;
        let leaving = n_leaving_limits(self.scenario.body.robot(), &recordings)?;
        rows[0].insert(Measure::BeyondLimits, 100.0 * leaving as f64 / recordings.len() as f64);
        Ok(rows)
    }
}
