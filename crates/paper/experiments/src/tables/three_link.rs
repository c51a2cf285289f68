//! Section 4.4: a planar arm under constraints that always hide the same direction.

use align::PolicyAlign;
use demo_gen::{ThreeLinkArm, n_leaving_limits};
use gp::FrontEnd;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::baselines::{Baselines, BaselinesTrial};
use crate::evaluation::candidate::Candidate;
use crate::evaluation::comparison::{Comparison, Method};
use crate::evaluation::protocol::{Protocol, TESTED_ON};
use crate::evaluation::recipe::Recipe;
use crate::measure::{Measure, RowOf};
use crate::paper::{explanations, paper_table};
use crate::setting::{Class, SILENT, Setting, TIME_STEP};
use crate::{Experiment, Measures, Row, Setup, Trial};

/// The system whose random stream is used.
pub const ARM_SYSTEM: u32 = 440;

/// The prefix of the rows of other learners.
const CASE: &str = "arm";

/// The experiment.
pub(crate) fn three_link() -> anyhow::Result<Experiment> {
    let baselines = baselines(1500);
    let comparison = |measure| {
        Comparison::of(CASE, measure, &baselines.methods()).with(Method::PolicyAlign, "policy_align", measure).with(
            Method::Naive,
            "naive",
            measure,
        )
    };
    Ok(Experiment {
        id: "three_link",
        section: "4.4",
        title: "The three-link arm, pathological constraints",
        data_sets: 50,
        remark: "Unit links, starts uniform in [-1, 1]^3 (the axes of Figure 9), δt = 0.5 s, plain Euler, narrow bandwidth. Both learners have Table 1's \
                 regression (3 passes). The printed errors of the naive baseline are compared with \
                 its errors on held-out samples of all movements, since it discards none.",
        decisions: "three-link.md",
        comparisons: [Measure::Nupe, Measure::Ncpe].map(comparison).into(),
        setups: vec![
            printed(arm()?, &Recipe::default())?,
            BaselinesTrial::setup(("beside", ARM_SYSTEM), &[CASE], arm()?, vec![PolicyAlign::default()], baselines),
        ],
        paper: paper_table(include_str!("../../paper/three_link.toml"))?,
        explanations: explanations("three_link", include_str!("../../paper/three_link-explained.toml"))?,
        ..Experiment::default()
    })
}

/// The learners other than PolicyAlign and the naive learner.
pub(crate) fn baselines(max_rows: usize) -> Baselines {
    Baselines::of_gaussians(FrontEnd::FiniteDifferences, max_rows)
}

/// The arm of Section 4.4.
///
/// # Errors
/// If the robot's file is damaged.
pub fn arm() -> anyhow::Result<ThreeLinkArm> {
    Ok(ThreeLinkArm::new(include_str!("../../../../../robots/planar_three_link.urdf"))?)
}

/// How PolicyAlign learns the arm.
pub(crate) fn protocol(recipe: &Recipe) -> Protocol {
    recipe.protocol(PolicyAlign::default(), 3, 1.0)
}

/// The printed rows.
fn printed(arm: ThreeLinkArm, recipe: &Recipe) -> anyhow::Result<Setup> {
    let rows = [("policy_align", RowOf::Learner), ("naive", RowOf::Baseline)];
    let mut protocol = protocol(recipe);
    // In the order of the rows.
    protocol.candidates.push(Candidate::other(recipe.naive(3, 1.0))?);
    let rows = rows.map(|(id, of)| Row { id: id.to_owned(), of, tested_on: TESTED_ON }).into();
    Ok(Setup::new("three_link", ARM_SYSTEM, 4_000_000, rows, ArmTrial { arm, protocol }))
}

/// The settings, with the origin of their values.
pub(crate) fn settings() -> Vec<Setting> {
    let setting = |name, class, paper, used, change: fn(&mut ThreeLinkArm, f64)| {
        Setting::new("three_link", name, class, paper, used, move |value| {
            let mut arm = arm()?;
            change(&mut arm, value);
            Ok(vec![printed(arm, &Recipe::default())?])
        })
    };
    let mut settings = vec![
        setting("starts within ±, rad", Class::Paper, "axes of Figure 9", 1.0, |arm, range| arm.start_range = range),
        setting(TIME_STEP, Class::Fitted, SILENT, 0.5, |arm, time_step| arm.roll_out.time_step = time_step),
    ];
    settings.extend(Recipe::default().settings("three_link", |recipe| Ok(vec![printed(arm()?, recipe)?])));
    settings
}

#[derive(Serialize)]
struct ArmTrial {
    arm: ThreeLinkArm,
    protocol: Protocol,
}

impl Trial for ArmTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.arm.record(rng)?;
        let mut rows = self.protocol.evaluate(&recordings, rng)?.rows()?;
        let leaving = n_leaving_limits(&self.arm.robot, &recordings)?;
        rows[0].insert(Measure::BeyondLimits, 100.0 * leaving as f64 / recordings.len() as f64);
        Ok(rows)
    }
}
