//! Fig. 6 (Section 4.1): errors on the parabola against the amount of data and against noise on the recorded positions.

use align::{Bandwidth, Integration, PolicyAlign};
use anyhow::Context as _;
use demo_gen::{Recording, ToySystem, with_position_noise};
use gp::FrontEnd;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use smoothing::{Fusion, Smoother};

use crate::evaluation::baselines::Baselines;
use crate::evaluation::comparison::{Comparison, Method};
use crate::evaluation::protocol::Protocol;
use crate::measure::Measure;
use crate::tables::table1::{PARABOLA_SYSTEM, learning_cost, toy_baselines, toy_protocol};
use crate::{Experiment, Measures, Row, Setup, Trial};

/// Amounts of training data, percent of the trajectories.
pub const TRAJECTORIES_PERCENT: [f64; 6] = [10.0, 20.0, 40.0, 60.0, 80.0, 100.0];

/// Noise levels, percent of each dimension's standard deviation.
pub const NOISE_PERCENT: [f64; 6] = [0.0, 2.5, 5.0, 10.0, 15.0, 20.0];

/// Bandwidths, with their names in rows.
pub const BANDWIDTHS: [(&str, Bandwidth); 2] = [("narrow", Bandwidth::Narrow), ("medium", Bandwidth::Medium)];

/// Integration rules, with their names in rows.
pub const RULES: [(&str, Integration); 2] =
    [("velocity", Integration::Velocity), ("displacement", Integration::Displacement)];

/// The left panel: errors against the amount of data.
pub(crate) fn figure6_left() -> Experiment {
    let setup = |(name, bandwidth)| {
        let algorithm = PolicyAlign { bandwidth, ..PolicyAlign::default() };
        setup(name, &TRAJECTORIES_PERCENT, algorithm, Against::Trajectories)
    };
    let baselines = baseline_setup(
        BASELINES_LEFT,
        &TRAJECTORIES_PERCENT,
        Integration::default(),
        Against::Trajectories,
        FrontEnd::FiniteDifferences,
    );
    Experiment {
        id: "figure6_left",
        title: "Figure 6, left: error against the amount of data",
        remark: "Of the 40 trajectories of Table 1's parabola (40 samples each) the first 10 to 100 percent are used. \
                 Regression as in Table 1; test samples from the trajectories that are kept of those used.",
        comparisons_remark: Some(
            "Learnt from `map-20` means: from 20 % of the trajectories. PolicyAlign has the narrow bandwidth.",
        ),
        comparisons: TRAJECTORIES_PERCENT.map(|percent| comparison(BASELINES_LEFT, "narrow", percent)).into(),
        setups: BANDWIDTHS.map(setup).into_iter().chain([baselines]).collect(),
        ..curves()
    }
}

/// The right panel: errors against noise, with two rules of integration.
pub(crate) fn figure6_right() -> Experiment {
    let setup = |(rule, integration): (&str, Integration), (name, bandwidth): (&str, Bandwidth)| {
        let algorithm = PolicyAlign { integration, bandwidth, ..PolicyAlign::default() };
        setup(&format!("{rule}-{name}"), &NOISE_PERCENT, algorithm, Against::Noise)
    };
    let setups = RULES.into_iter().flat_map(|rule| BANDWIDTHS.map(|bandwidth| setup(rule, bandwidth)));
    let comparisons = |((rule, _), name): ((&str, Integration), &'static str)| {
        NOISE_PERCENT.map(|percent| comparison(name, &format!("{rule}-narrow"), percent))
    };
    let baselines = |((_, integration), name): ((&str, Integration), &'static str)| {
        let front_end = match integration {
            Integration::Displacement => FrontEnd::Smoothed(Smoother::default()),
            _ => FrontEnd::Fused(Fusion::default()),
        };
        baseline_setup(name, &NOISE_PERCENT, integration, Against::Noise, front_end)
    };
    Experiment {
        id: "figure6_right",
        title: "Figure 6, right: error against noise",
        remark: "Gaussian noise, in percent of each dimension's standard deviation, on the recorded positions of Table 1's parabola; \
                 recorded velocities are clean. Potentials are integrated from velocities, or from displacements (9). \
                 Regression as in Table 1; errors are against the truth at the true states.",
        comparisons: RULES.into_iter().zip(BASELINES_RIGHT).flat_map(comparisons).collect(),
        comparisons_remark: Some(
            "Learnt from `fused-5` or `smoothed-5` means: with 5 % noise on positions. Not all learn from the same here: naive learner and radial basis take the recorded velocities, which are clean, in all rows. \
             In the rows `fused-…` PolicyAlign takes them too, and the Gaussian processes positions and velocities together; in the rows \
             `smoothed-…` PolicyAlign and the Gaussian processes have noisy positions alone, of which the latter are smoothed.",
        ),
        setups: setups.chain(RULES.into_iter().zip(BASELINES_RIGHT).map(baselines)).collect(),
        ..curves()
    }
}

/// The baselines' cases in the left panel.
pub const BASELINES_LEFT: &str = "map";
/// The baselines' cases in the right panel, in the order of [`RULES`].
pub const BASELINES_RIGHT: [&str; 2] = ["fused", "smoothed"];

/// Number of rows from which the Gaussian processes learn.
const ROWS: usize = 500;

/// A line of the table: the errors of the baselines, and of PolicyAlign, whose row has another name.
fn comparison(case: &str, policy_align: &str, percent: f64) -> Comparison {
    let methods = toy_baselines(FrontEnd::FiniteDifferences, ROWS).methods();
    let row = format!("{policy_align}-{percent}");
    Comparison::of(&format!("{case}-{percent}"), Measure::Nupe, &methods).with(Method::PolicyAlign, &row, Measure::Nupe)
}

fn baseline_setup(
    case: &str,
    percent: &[f64],
    integration: Integration,
    against: Against,
    front_end: FrontEnd,
) -> Setup {
    let cases: Vec<String> = percent.iter().map(|percent| format!("{case}-{percent}")).collect();
    let trial = |baselines: Baselines| {
        let algorithm = PolicyAlign { integration, ..PolicyAlign::default() };
        let protocol = Protocol { algorithm, candidates: vec![], held_out: baselines.held_out };
        let (system, percent) = (ToySystem::default(), percent.to_vec());
        CurveTrial { system, protocol, baselines: Some(baselines), against, percent }
    };
    let setup = toy_baselines(front_end, ROWS).setup((case, PARABOLA_SYSTEM), &cases, trial);
    Setup { cost: setup.cost * percent.len() as u64, ..setup }
}

/// Common properties of both panels.
fn curves() -> Experiment {
    Experiment { section: "4.1", data_sets: 20, decisions: "figure6.md", ..Experiment::default() }
}

fn setup(id: &str, percent: &[f64], algorithm: PolicyAlign, against: Against) -> Setup {
    let row = |percent: &f64| Row::of_learner(&format!("{id}-{percent}"));
    let (system, protocol) = (ToySystem::default(), toy_protocol(algorithm));
    let trial = CurveTrial { system, protocol, baselines: None, against, percent: percent.to_vec() };
    let cost = percent.iter().map(|&percent| learning_cost(trial.trajectories(percent), trial.system.n_samples)).sum();
    let rows = percent.iter().map(row).collect();
    Setup::new(id, PARABOLA_SYSTEM, cost, rows, trial)
}

/// The quantity that varies along a curve.
#[derive(Debug, Clone, Copy, Serialize)]
enum Against {
    Trajectories,
    Noise,
}

/// One curve: all its points come from the same data set.
#[derive(Serialize)]
struct CurveTrial {
    system: ToySystem,
    protocol: Protocol,
    /// Baselines that learn instead of the candidates, if any.
    #[serde(rename = "beside")]
    baselines: Option<Baselines>,
    against: Against,
    percent: Vec<f64>,
}

impl CurveTrial {
    /// The data of one point of the curve.
    fn at(&self, percent: f64, recordings: &[Recording], noise: &ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
        match self.against {
            Against::Trajectories => Ok(recordings[..self.trajectories(percent)].to_vec()),
            Against::Noise => Ok(with_position_noise(recordings, percent / 100.0, &mut noise.clone())?),
        }
    }

    /// The measures at one point.
    fn point(&self, observed: &[Recording], rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        match &self.baselines {
            Some(baselines) => baselines.train(observed, std::slice::from_ref(&self.protocol.algorithm), rng)?.rows(),
            None => self.protocol.evaluate(observed, rng)?.rows(),
        }
    }

    fn trajectories(&self, percent: f64) -> usize {
        match self.against {
            Against::Trajectories => (self.system.n_trajectories as f64 * percent / 100.0).round() as usize,
            Against::Noise => self.system.n_trajectories,
        }
    }
}

impl Trial for CurveTrial {
    /// Every point starts from the same random numbers, so that a curve shows only the effect of the varied quantity.
    /// Without a change, a point equals Table 1's own result.
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.system.record(rng)?;
        let learning = rng.clone();
        let noise = ChaCha8Rng::from_rng(rng);
        let mut rows = Vec::new();
        for &percent in &self.percent {
            let observed = self.at(percent, &recordings, &noise)?;
            let of_point = self.point(&observed, &mut learning.clone());
            rows.extend(of_point.with_context(|| format!("{:?}, {percent} %", self.against))?);
        }
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::generator;
    use crate::tables::table1::table1;

    fn run(experiment: &Experiment, id: &str) -> Measures {
        let setup = experiment.setups.iter().find(|setup| setup.id == id).unwrap();
        let measures = setup.trial.run(&mut generator(1, setup.system, 3)).unwrap();
        assert_eq!(measures.len(), setup.rows.len());
        measures
    }

    #[test]
    fn curves_at_unchanged_settings_equal_table_1() {
        let mut table = run(&table1().unwrap(), "parabola-40x40-medium").remove(0);
        // Only the table has test movements that no learner sees.
        assert!(table.remove(&Measure::NupeFresh).is_some());
        let [left, right] = [run(&figure6_left(), "medium"), run(&figure6_right(), "displacement-medium")];
        assert_eq!(left.last(), Some(&table));
        assert_eq!(right.first(), Some(&table));
        assert!(left[..5].iter().chain(&right[1..]).all(|row| *row != table));
    }
}
