//! Beyond the paper: constraints with a task, A u = b, as in later work on the same problem.

use std::collections::BTreeMap;

use align::{Bandwidth, Integration, LwprRegressor, PolicyAlign};
use demo_gen::tasks::{Contact, CyclesWithTask, Wiping};
use demo_gen::{Recording, demonstrations, with_velocity_noise};
use gp::{FrontEnd, PushTest, Trend};
use motion::Demonstrations;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::comparison::{Comparison, Method, row_id};
use crate::evaluation::gaussians::{Gaussians, reading_of};
use crate::evaluation::judge::Judge;
use crate::evaluation::lwpr_learners::{aligned, naive};
use crate::evaluation::observation_model::samples_of;
use crate::evaluation::protocol::errors;
use crate::measure::{Measure, RowOf};
use crate::robots::seven_joint_arm;
use crate::seed::{fresh, separate_stream};
use crate::{Experiment, Measures, Row, Setup, Trial};

/// The system of the first generator; the others follow. The noise does not change a generator's data sets.
const FIRST_SYSTEM: u32 = 700;

/// Description of the test samples.
const TESTED_ON: &str = "the true states of ten movements from new starts";

/// Number of test movements.
const FRESH: usize = 10;

/// Number of rows from which the Gaussian processes learn, as in the program.
const MAX_ROWS: usize = 400;

/// The learners, in the order of the rows.
const WHO: [Method; 6] =
    [Method::Naive, Method::PolicyAlign, Method::SlopeGp, Method::SlopeGpPushed, Method::DirectGp, Method::AutoGp];

/// Signal-to-noise ratios of the velocities, in decibels, with their names; `None` for exact velocities.
const NOISE: [(&str, Option<f64>); 3] = [("", None), ("-40-db", Some(40.0)), ("-20-db", Some(20.0))];

/// A system with its constraints.
#[derive(Serialize)]
enum Generator {
    Cycles(CyclesWithTask),
    Wiping(Box<Wiping>),
}

/// The generators in the order of the table. New ones must be last, because the position determines the random numbers.
fn generators() -> anyhow::Result<Vec<(&'static str, Generator)>> {
    let cycles = |largest_task| Generator::Cycles(CyclesWithTask { largest_task, ..CyclesWithTask::default() });
    let wiping = |contact| anyhow::Ok(Generator::Wiping(Box::new(seven_joint_arm(contact)?)));
    Ok(vec![
        ("limit-cycle", cycles(0.0)),
        ("limit-cycle-task", cycles(0.3)),
        ("wiping-height", wiping(Contact::Height)?),
        ("wiping-flat", wiping(Contact::Flat)?),
    ])
}

impl Generator {
    fn record(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
        Ok(match self {
            Generator::Cycles(cycles) => cycles.record(rng)?,
            Generator::Wiping(wiping) => wiping.record(rng)?,
        })
    }

    /// Test movements, which no learner sees. They do not advance the generator of the data set.
    fn fresh(&self, rng: &ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
        let mut rng = fresh(rng);
        Ok(match self {
            Generator::Cycles(cycles) => CyclesWithTask { n_trajectories: FRESH, ..cycles.clone() }.record(&mut rng)?,
            Generator::Wiping(wiping) => {
                let mut wiping = wiping.clone();
                wiping.n_trajectories = FRESH;
                wiping.record(&mut rng)?
            }
        })
    }
}

/// The experiment.
///
/// # Errors
/// If the robot's file is damaged.
pub(crate) fn constraints() -> anyhow::Result<Experiment> {
    let mut setups = Vec::new();
    for (noise, decibels) in NOISE {
        for (number, (name, generator)) in (FIRST_SYSTEM..).zip(generators()?) {
            setups.push(setup(number, &format!("{name}{noise}"), generator, decibels));
        }
    }
    Ok(Experiment {
        id: "constraints",
        section: "none",
        title: "Beyond the paper: constraints with a task",
        data_sets: 5,
        remark: "Constraints A u = b, constant in a movement on the plane, turning with the state on an arm of seven joints that wipes surfaces of random tilt: of its tool's \
                 height alone (b = 0), or of height and orientation, with a task that brings it back to the surface. 50 movements of 100 samples; white noise on velocities at 40 and 20 dB. \
                 All learners have their default settings, but LWPR makes two passes; the Gaussian processes learn from 400 rows with the noise that they estimate, and \"automatic\" is what the program fits. \
                 PolicyAlign has the medium bandwidth; no policy here has a potential, which it needs.",
        decisions: "beyond.md",
        comparisons: setups.iter().map(|setup| Comparison::of(&setup.id, Measure::Nupe, &WHO)).collect(),
        setups,
        ..Experiment::default()
    })
}

fn setup(number: u32, name: &str, generator: Generator, decibels: Option<f64>) -> Setup {
    let row = |method| Row { id: row_id(name, method), of: RowOf::Additional, tested_on: TESTED_ON };
    let trial = ConstraintsTrial { generator, decibels, lwpr: lwpr(), max_rows: MAX_ROWS };
    Setup::new(name, number, 60_000_000, WHO.map(row).into(), trial)
}

/// LWPR with its defaults, except for two passes: ten passes over 5,000 samples only take longer.
fn lwpr() -> LwprRegressor {
    LwprRegressor { passes: 2, ..LwprRegressor::default() }
}

#[derive(Serialize)]
struct ConstraintsTrial {
    generator: Generator,
    /// Signal-to-noise ratio of the velocities in decibels; `None` if they are exact.
    decibels: Option<f64>,
    lwpr: LwprRegressor,
    max_rows: usize,
}

impl Trial for ConstraintsTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let fresh = self.generator.fresh(rng)?;
        let judge = Judge::new(&fresh, &samples_of(&fresh, 0..fresh.len()));
        let recordings = self.generator.record(rng)?;
        let recordings = match self.decibels {
            Some(decibels) => with_velocity_noise(&recordings, decibels, rng)?,
            None => recordings,
        };
        let demonstrations = demonstrations(&recordings)?;
        let naive = naive(&self.lwpr, &demonstrations, rng)?;
        let (bandwidth, integration) = (Bandwidth::Medium, Integration::Velocity);
        let algorithm = PolicyAlign { bandwidth, integration, ..PolicyAlign::default() };
        let policy_align = aligned(&algorithm, &self.lwpr, &demonstrations, &judge, rng).unwrap_or_default();
        let [slope, pushed, direct, either] = self.gaussians(&demonstrations, &judge, rng)?;
        Ok(vec![errors(&judge, &*naive)?, policy_align, slope, pushed, direct, either])
    }
}

impl ConstraintsTrial {
    /// Errors of the slope GP on rows of samples, of the slope GP that may learn from stretches, of the direct GP, and of the choice
    /// between the last two.
    fn gaussians(
        &self,
        demonstrations: &Demonstrations,
        judge: &Judge<'_>,
        rng: &ChaCha8Rng,
    ) -> anyhow::Result<[BTreeMap<Measure, f64>; 4]> {
        let still = Gaussians::new(FrontEnd::of_velocities(demonstrations), self.max_rows);
        let slope = still.slope(Trend::Quadratic, demonstrations, &[], &mut separate_stream(rng))?;
        let pushed = Gaussians { push_test: PushTest::Fit, ..still };
        let both = pushed.both(demonstrations, &[], &mut separate_stream(rng))?;
        let mut either = errors(judge, &both)?;
        either.insert(Measure::ExpectedNupe, both.expected_nupe());
        either.extend(reading_of(&both));
        Ok([errors(judge, &slope)?, errors(judge, both.slope())?, errors(judge, both.direct())?, either])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::generator;

    /// Under A u = b only the slope GP that learns from stretches recovers the policy; every row has its errors.
    #[test]
    fn only_stretches_recover_the_policy_under_a_task() {
        let setup = constraints().unwrap().setups.swap_remove(1);
        assert_eq!(setup.id, "limit-cycle-task");
        let cycles = CyclesWithTask { n_trajectories: 15, ..CyclesWithTask::default() };
        let lwpr = LwprRegressor { passes: 1, ..LwprRegressor::default() };
        let trial = ConstraintsTrial { generator: Generator::Cycles(cycles), decibels: None, lwpr, max_rows: 150 };
        let rows = trial.run(&mut generator(1, setup.system, 0)).unwrap();
        assert_eq!(rows.len(), setup.rows.len());
        let errors: Vec<f64> = rows.iter().map(|row| row[&Measure::Nupe]).collect();
        let [naive, policy_align, slope, pushed, direct, automatic] = errors[..] else { panic!("{errors:?}") };
        assert!(naive.min(policy_align).min(slope).min(direct) > 0.01, "{errors:?}");
        assert!(pushed.max(automatic) < 1e-5, "{errors:?}");
    }
}
