//! Beyond the paper: movements that distinguish learners where the paper's no longer do.

use std::collections::BTreeMap;

use align::{Bandwidth, LwprRegressor, PolicyAlign};
use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind};
use demo_gen::demonstrations;
use gp::Trend;
use lwpr::LwprParams;
use motion::Demonstrations;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::comparison::{Comparison, Method, row_id};
use crate::evaluation::gaussians::{Gaussians, own_expectations, rows};
use crate::evaluation::judge::Judge;
use crate::evaluation::lwpr_learners::{aligned, naive};
use crate::evaluation::observation_model::{ObservationModel, samples_of};
use crate::evaluation::protocol::errors;
use crate::measure::{Measure, RowOf};
use crate::seed::separate_stream;
use crate::{Experiment, Measures, Row, Setup, Trial};

/// The system of the first case; the others follow.
const FIRST_SYSTEM: u32 = 500;

/// Description of the test samples.
const TESTED_ON: &str = "the true states of all samples";

/// The learners, in the order of the rows.
const WHO: [Method; 6] =
    [Method::Naive, Method::PolicyAlign, Method::SlopeGp, Method::SlopeGpNoTrend, Method::DirectGp, Method::AutoGp];

/// A kind of data set.
struct Case {
    name: &'static str,
    system: BeyondSystem,
    observation: ObservationModel,
    /// Number of rows from which the Gaussian processes learn.
    max_rows: usize,
}

/// The cases in the order of the table. New ones must be last, because the position determines the random numbers.
fn cases() -> Vec<Case> {
    use ConstraintKind::{Free, OneForAll, Varying};
    use ObservationModel::{NoisyStates, Positions, Velocities};
    use PolicyKind::{Handwriting, LimitCycle, Planes, Sinusoidal, Swirl, Wells};
    let case = |name, policy, n_trajectories, constraint, observation, max_rows| {
        let system = BeyondSystem { policy, n_trajectories, constraint, ..BeyondSystem::default() };
        Case { name, system, observation, max_rows }
    };
    vec![
        case("sinus-2d-10-demonstrations", Sinusoidal, 10, Varying, Velocities, 900),
        case("sinus-2d-5-demonstrations", Sinusoidal, 5, Varying, Velocities, 900),
        case("wells-3d", Wells { dim: 3 }, 60, Varying, Velocities, 500),
        case("wells-22d", Wells { dim: 22 }, 100, Varying, Velocities, 900),
        case("softplus-6d", Planes { dim: 6, edge: 0.1 }, 60, Varying, Velocities, 700),
        case("relu-2d", Planes { dim: 2, edge: 0.0 }, 60, Varying, Velocities, 900),
        case("relu-3d", Planes { dim: 3, edge: 0.0 }, 60, Varying, Velocities, 900),
        case("relu-6d", Planes { dim: 6, edge: 0.0 }, 60, Varying, Velocities, 900),
        case("swirl-3d", Swirl { dim: 3 }, 60, Varying, Velocities, 500),
        case("limit-cycle-2d", LimitCycle, 20, Varying, Velocities, 500),
        case("sinus-2d-noise-20-velocities", Sinusoidal, 40, Varying, NoisyStates(0.2), 700),
        case("wells-3d-noise-20-velocities", Wells { dim: 3 }, 60, Varying, NoisyStates(0.2), 700),
        case("sinus-2d-positions-noise-1", Sinusoidal, 40, Varying, Positions(0.01), 700),
        case("sinus-2d-positions-noise-5", Sinusoidal, 40, Varying, Positions(0.05), 700),
        case("wells-3d-positions-noise-1", Wells { dim: 3 }, 60, Varying, Positions(0.01), 700),
        case("wells-3d-positions-noise-5", Wells { dim: 3 }, 60, Varying, Positions(0.05), 700),
        case("wells-22d-positions-noise-1", Wells { dim: 22 }, 100, Varying, Positions(0.01), 700),
        case("limit-cycle-2d-positions-noise-1", LimitCycle, 40, Varying, Positions(0.01), 500),
        case("sinus-2d-free", Sinusoidal, 20, Free, Velocities, 500),
        case("handwriting-free", Handwriting, 7, Free, Velocities, 500),
        case("wells-3d-one-constraint-for-all", Wells { dim: 3 }, 20, OneForAll, Velocities, 500),
    ]
}

/// The experiment.
pub(crate) fn beyond() -> Experiment {
    let cases = cases();
    let comparisons = cases.iter().map(|case| Comparison::of(case.name, Measure::Nupe, &WHO)).collect();
    Experiment {
        id: "beyond",
        section: "none",
        title: "Beyond the paper: learners side by side",
        data_sets: 5,
        remark: "Policies drawn anew for every data set, in 2 to 22 dimensions; movements of 40 samples, flows instead of Euler maps; \
                 random constraints that turn with the state, about one forbidden direction in four, drawn anew every 20 samples. \
                 All learners have their default settings, except LWPR in 22 dimensions, where wider fields and one pass serve it better; PolicyAlign has the narrow or \
                 the medium bandwidth, whichever has the lower true error in that data set. Nothing is held out: the policy is hidden at the states that are seen. \"Automatic\" is the slope GP or the direct \
                 GP, as the data are read.",
        decisions: "beyond.md",
        comparisons,
        setups: (FIRST_SYSTEM..).zip(cases).map(setup).collect(),
        ..Experiment::default()
    }
}

/// A planar case for figures: the number of its system, the system, and the Gaussian processes.
pub fn case_on_the_plane() -> (u32, BeyondSystem, Gaussians) {
    let case = cases().swap_remove(0);
    let gaussians = case.gaussians();
    (FIRST_SYSTEM, case.system, gaussians)
}

impl Case {
    fn gaussians(&self) -> Gaussians {
        Gaussians::new(self.observation.front_end(), self.max_rows)
    }

    /// LWPR with its defaults, except in 22 dimensions. There states are so far apart that fields of the default width
    /// contain hardly more than one sample. Wider fields improve both LWPR learners (the table in
    /// docs/decisions/beyond.md) and take a fortieth of the time.
    fn lwpr(&self) -> LwprRegressor {
        let regressor = LwprRegressor::default();
        if self.system.policy.dim() < 22 {
            return regressor;
        }
        let params = LwprParams { init_d: 0.3, ..regressor.params };
        LwprRegressor { params, passes: 1, ..regressor }
    }
}

fn setup((number, case): (u32, Case)) -> Setup {
    let (gaussians, lwpr) = (case.gaussians(), case.lwpr());
    let Case { name, system, observation, max_rows } = case;
    let row = |method| Row { id: row_id(name, method), of: RowOf::Additional, tested_on: TESTED_ON };
    let rows = max_rows.min(39 * system.n_trajectories);
    let cost = Gaussians::cost(rows) * (20 + system.policy.dim() as u64) / 10;
    Setup::new(name, number, cost, WHO.map(row).into(), BeyondTrial { system, observation, lwpr, gaussians })
}

#[derive(Serialize)]
struct BeyondTrial {
    system: BeyondSystem,
    #[serde(rename = "seen")]
    observation: ObservationModel,
    lwpr: LwprRegressor,
    gaussians: Gaussians,
}

impl Trial for BeyondTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.system.record(rng)?;
        let recordings = self.observation.of(recordings, rng)?;
        let demonstrations = demonstrations(&recordings)?;
        let judge = Judge::new(&recordings, &samples_of(&recordings, 0..recordings.len()));
        let naive = naive(&self.lwpr, &demonstrations, rng)?;
        let both = self.gaussians.both(&demonstrations, &[], &mut separate_stream(rng))?;
        let no_trend = self.gaussians.slope(Trend::None, &demonstrations, &[], &mut separate_stream(rng))?;
        let [slope, direct, either] = rows(&judge, &both)?;
        let mut of_no_trend = errors(&judge, &no_trend)?;
        of_no_trend.extend(own_expectations(&no_trend));
        let policy_align = self.policy_align(&demonstrations, &judge, rng);
        Ok(vec![errors(&judge, &*naive)?, policy_align, slope, of_no_trend, direct, either])
    }
}

impl BeyondTrial {
    /// The better result of two bandwidths; empty if neither aligns enough movements to learn from.
    fn policy_align(
        &self,
        demonstrations: &Demonstrations,
        judge: &Judge<'_>,
        rng: &mut ChaCha8Rng,
    ) -> BTreeMap<Measure, f64> {
        let learnt = |bandwidth| {
            let algorithm =
                PolicyAlign { bandwidth, integration: self.observation.integration(), ..PolicyAlign::default() };
            aligned(&algorithm, &self.lwpr, demonstrations, judge, rng)
        };
        let found = [Bandwidth::Narrow, Bandwidth::Medium].into_iter().filter_map(learnt);
        found.min_by(|a, b| a[&Measure::Nupe].total_cmp(&b[&Measure::Nupe])).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::generator;

    /// From ten constrained movements only the slope GP recovers the policy; every row has its errors.
    #[test]
    fn only_the_slope_gp_recovers_the_policy() {
        let setup = beyond().setups.swap_remove(0);
        let rows = setup.trial.run(&mut generator(1, setup.system, 0)).unwrap();
        assert_eq!(rows.len(), setup.rows.len());
        let errors: Vec<f64> = rows.iter().map(|row| row[&Measure::Nupe]).collect();
        let [naive, policy_align, slope, no_trend, direct, reading] = errors[..] else { panic!("{errors:?}") };
        assert!(naive.min(policy_align).min(direct) > 0.1, "{errors:?}");
        assert!(slope.max(no_trend).max(reading) < 1e-4, "{errors:?}");
    }
}
