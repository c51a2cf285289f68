//! Table 1 (Section 4.1): the toy system, three set-ups by three bandwidths.

use align::{Bandwidth, DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::{Redraw, ToyPotential, ToySystem};
use gp::FrontEnd;
use lwpr::{LwprParams, MetricAdaptation};
use nalgebra::DVector;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use super::beside::{Beside, BesideTrial, DATA_SETS};
use super::constraint_consistent::ConstraintConsistent;
use super::contest::Contest;
use super::exam::examine;
use super::fresh::{add_errors, fresh};
use super::gaussians::Gaussians;
use super::pupil::Pupil;
use super::settings::{SILENT, Setting};
use super::{Experiment, Measures, Row, Setup, Trial};
use crate::measure::Measure;
use crate::paper::{explanations, paper_table};

/// The systems of the table, by their random streams; those of the literal reading follow from 100. The parabola.
pub const PARABOLA_SYSTEM: u32 = 0;
/// The sinusoid.
pub const SINUSOIDAL_SYSTEM: u32 = 1;
const LONG_SINUSOIDAL_SYSTEM: u32 = 2;
const LITERAL: u32 = 100;

/// The table with constraints that are drawn anew every 20 samples.
pub(crate) fn table1() -> anyhow::Result<Experiment> {
    Ok(Experiment {
        id: "table1",
        section: "4.1",
        title: "Table 1: the toy system",
        data_sets: 100,
        remark: "The constraint is drawn anew every 20 samples, two draws at 40 samples and five at 100, which makes the printed discard \
                 rates come out. Regression, the same in all rows: init_D 10, w_gen 0.5, penalty 1e-5, adaptive diagonal metric, 10 passes.",
        reservations: &RESERVATIONS,
        decisions: "table1.md",
        contests_remark: Some(BANDWIDTH_IS_OF_POLICY_ALIGN),
        another_reading_of: None,
        contests: contests(),
        setups: setups(Redraw::Every(REDRAW), 0, max_rows),
        paper: paper_table(include_str!("../paper/table1.toml"))?,
        explanations: explanations("table1", include_str!("../paper/table1-explained.toml"))?,
    })
}

/// The table with the constraint "re-sampled twice" taken literally: three equal segments.
pub(crate) fn table1_literal() -> anyhow::Result<Experiment> {
    Ok(Experiment {
        id: "table1-literal",
        section: "4.1",
        title: "Table 1, taken literally",
        data_sets: 100,
        remark: "As Table 1, but the constraint is \"re-sampled twice\" during each movement to the letter: three segments of equal length.",
        reservations: &[],
        decisions: "table1.md",
        contests_remark: Some(BANDWIDTH_IS_OF_POLICY_ALIGN),
        another_reading_of: Some("table1"),
        contests: contests(),
        setups: setups(Redraw::Segments(3), LITERAL, |_| LITERAL_ROWS),
        paper: paper_table(include_str!("../paper/table1.toml"))?,
        explanations: explanations("table1-literal", include_str!("../paper/table1-literal-explained.toml"))?,
    })
}

/// Samples after which the constraint is drawn anew.
const REDRAW: usize = 20;

const RESERVATIONS: [&str; 2] = [
    "Section 4.1 calls the error of alignment \"only marginally different\" from the potential's. Here they differ by up to a factor of two.",
    "From the narrow to the medium bandwidth the printed nUPE of the sinusoid rises with 40 x 40 samples and falls with 100 x 100. Here it stays about \
     the same with 40 x 40 and rises with 100 x 100.",
];

/// What is the same in three rows, and why.
const BANDWIDTH_IS_OF_POLICY_ALIGN: &str = "The bandwidth (narrow, medium, wide) is PolicyAlign's: it discards movements by it. The others \
                                            learn from all movements, the same in all three rows; nUPE is on the movements that PolicyAlign keeps.";

/// Rows that the Gaussian processes learn from: all that they take by themselves of the longer movements, where fewer cost
/// two digits.
fn max_rows(size: usize) -> usize {
    if size < 100 { 1000 } else { 1500 }
}

/// Rows that the Gaussian processes learn from in the literal reading, which shows them nothing new.
const LITERAL_ROWS: usize = 500;

/// Names in rows.
const BANDWIDTHS: [(&str, Bandwidth); 3] =
    [("narrow", Bandwidth::Narrow), ("medium", Bandwidth::Medium), ("wide", Bandwidth::Wide)];

/// The three systems: number, name, trajectories and samples, potential.
fn systems() -> [(u32, &'static str, usize, ToyPotential); 3] {
    [
        (PARABOLA_SYSTEM, "parabola", 40, ToyPotential::parabola()),
        (SINUSOIDAL_SYSTEM, "sinusoidal", 40, ToyPotential::sinusoidal()),
        (LONG_SINUSOIDAL_SYSTEM, "sinusoidal", 100, ToyPotential::sinusoidal()),
    ]
}

/// The printed rows.
fn printed(redraw: Redraw, first_system: u32, regressor: &LwprRegressor) -> Vec<Setup> {
    printed_of(|size| size, redraw, first_system, regressor)
}

/// The printed rows, with as many movements as `movements` makes of theirs.
fn printed_of(
    movements: impl Fn(usize) -> usize,
    redraw: Redraw,
    first_system: u32,
    regressor: &LwprRegressor,
) -> Vec<Setup> {
    let mut setups = Vec::new();
    for (number, name, size, potential) in systems() {
        let system = ToySystem { potential, n_trajectories: movements(size), n_samples: size, redraw };
        for (bandwidth_name, bandwidth) in BANDWIDTHS {
            let id = format!("{name}-{size}x{size}-{bandwidth_name}");
            let row = Row::of_learner(&id);
            let algorithm = PolicyAlign { bandwidth, ..PolicyAlign::default() };
            let (cost, system_number) = (learning_cost(size, size), first_system + number);
            let pupils = vec![Pupil::PolicyAlign(regressor.clone())];
            let trial = Box::new(ToyTrial { system: system.clone(), algorithm, pupils });
            setups.push(Setup { id, rows: vec![row], system: system_number, data_sets: None, cost, trial });
        }
    }
    setups
}

/// What is fitted.
pub(super) fn settings() -> Vec<Setting> {
    let setting = |name, paper, used, with| Setting { experiment: "table1", name, paper, used, with };
    vec![
        setting("samples to the next constraint", "\"re-sampled twice\"", REDRAW as f64, |value| {
            Ok(printed(Redraw::Every(value.round() as usize), 0, &toy_regressor()))
        }),
        setting("init_D of the regression", SILENT, 10.0, |init_d| {
            Ok(tuned(|regressor| regressor.params.init_d = init_d))
        }),
        setting("w_gen of the regression", SILENT, 0.5, |w_gen| Ok(tuned(|regressor| regressor.params.w_gen = w_gen))),
        setting("penalty of the regression", SILENT, 1e-5, |penalty| {
            Ok(tuned(|regressor| regressor.params.penalty = penalty))
        }),
        setting("passes of the regression", SILENT, 10.0, |passes| {
            Ok(tuned(|regressor| regressor.passes = passes.round() as usize))
        }),
    ]
}

/// What texts ask about, though nothing is fitted there.
pub(super) fn unfitted() -> Vec<Setting> {
    let setting = |name, used, with| Setting { experiment: "table1", name, paper: SILENT, used, with };
    vec![
        setting("whether the metric adapts", 1.0, |adapts| {
            let adaptation = if adapts == 0.0 { MetricAdaptation::Fixed } else { toy_regressor().params.adaptation };
            Ok(tuned(|regressor| regressor.params.adaptation = adaptation))
        }),
        setting("movements", 40.0, |movements| {
            Ok(printed_of(|_| movements.round() as usize, Redraw::Every(REDRAW), 0, &toy_regressor()))
        }),
    ]
}

/// The printed rows with another regression.
fn tuned(change: impl Fn(&mut LwprRegressor)) -> Vec<Setup> {
    let mut regressor = toy_regressor();
    change(&mut regressor);
    printed(Redraw::Every(REDRAW), 0, &regressor)
}

fn setups(redraw: Redraw, first_system: u32, max_rows: fn(usize) -> usize) -> Vec<Setup> {
    let mut setups = printed(redraw, first_system, &toy_regressor());
    for (number, name, size, potential) in systems() {
        let scene = ToySystem { potential, n_trajectories: size, n_samples: size, redraw };
        let algorithms = BANDWIDTHS.map(|(_, bandwidth)| PolicyAlign { bandwidth, ..PolicyAlign::default() }).into();
        let beside = toy_beside(FrontEnd::Map, max_rows(size));
        setups.push(Setup {
            id: format!("{name}-{size}x{size}-beside"),
            rows: cases(name, size).iter().flat_map(|case| beside.rows(case)).collect(),
            system: first_system + number,
            data_sets: Some(DATA_SETS),
            cost: beside.cost(),
            trial: Box::new(BesideTrial { scene, algorithms, beside }),
        });
    }
    setups
}

/// A system in each bandwidth.
fn cases(name: &str, size: usize) -> [String; 3] {
    BANDWIDTHS.map(|(bandwidth, _)| format!("{name}-{size}x{size}-{bandwidth}"))
}

/// The learners on each system, in each bandwidth.
fn contests() -> Vec<Contest> {
    let beside = toy_beside(FrontEnd::Map, 1);
    let cases = systems().into_iter().flat_map(|(_, name, size, _)| cases(name, size));
    let lines = |case: String| [Measure::Nupe, Measure::NupeFresh].map(|measure| beside.contest(&case, measure));
    cases.flat_map(lines).collect()
}

/// Who learns the toy system beside PolicyAlign.
pub fn toy_beside(front_end: FrontEnd, max_rows: usize) -> Beside {
    let LwprRegressor { params, passes, cutoff } = toy_regressor();
    let naive = Some(DirectPolicyLearning { params, passes, cutoff });
    Beside {
        naive,
        constraint_consistent: Some(ConstraintConsistent::default()),
        gaussians: Gaussians::new(front_end, max_rows),
    }
}

/// One row of the table.
#[derive(Serialize)]
struct ToyTrial {
    system: ToySystem,
    algorithm: PolicyAlign,
    pupils: Vec<Pupil>,
}

/// Who learns the toy system.
pub(super) fn toy_pupils() -> Vec<Pupil> {
    vec![Pupil::PolicyAlign(toy_regressor())]
}

/// The regression of all rows.
pub fn toy_regressor() -> LwprRegressor {
    let norm_in = Some(DVector::repeat(2, 1.0));
    let params = LwprParams { init_d: 10.0, w_gen: 0.5, penalty: 1e-5, norm_in, ..LwprParams::default() };
    LwprRegressor { params, passes: 10, ..LwprRegressor::default() }
}

/// Work of aligning and regression, in the unit of [`Setup::cost`].
pub(super) fn learning_cost(n_trajectories: usize, n_samples: usize) -> u64 {
    // Measured: regression takes about as long as 100 distance evaluations a sample.
    (n_trajectories * n_samples * (n_trajectories + 100)) as u64
}

impl Trial for ToyTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.system.record(rng)?;
        let exam = examine(&recordings, &self.algorithm, &self.pupils, rng)?;
        let mut rows = exam.rows()?;
        add_errors(&mut rows, exam.learnt(), &fresh(&self.system, rng)?)?;
        Ok(rows)
    }
}
