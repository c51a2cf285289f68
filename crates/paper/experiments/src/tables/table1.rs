//! Table 1 (Section 4.1): the toy system, with three set-ups and three bandwidths.

use align::{Bandwidth, DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::{Redraw, ToyPotential, ToySystem};
use gp::FrontEnd;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::baselines::{Baselines, BaselinesTrial};
use crate::evaluation::comparison::Comparison;
use crate::evaluation::constraint_consistent::ConstraintConsistent;
use crate::evaluation::fresh::{add_errors, fresh};
use crate::evaluation::protocol::Protocol;
use crate::evaluation::recipe::Recipe;
use crate::measure::Measure;
use crate::paper::{explanations, paper_table};
use crate::setting::{Class, SILENT, Setting};
use crate::{Experiment, Measures, Row, Setup, Trial};

/// The parabola's system number, which selects its random stream; those of the literal reading start at 100.
pub const PARABOLA_SYSTEM: u32 = 0;
/// The sinusoid's system number.
pub const SINUSOIDAL_SYSTEM: u32 = 1;
const LONG_SINUSOIDAL_SYSTEM: u32 = 2;
const LITERAL: u32 = 100;

/// The table with constraints that are redrawn every 20 samples.
pub(crate) fn table1() -> anyhow::Result<Experiment> {
    Ok(Experiment {
        id: "table1",
        section: "4.1",
        title: "Table 1: the toy system",
        data_sets: 100,
        remark: "The constraint is drawn anew every 20 samples, two draws at 40 samples and five at 100, which makes the printed errors \
                 of the wide bandwidth come out. LWPR has the defaults of its library in all rows and learns the potentials as they are (23); it sees the samples as often as there are inputs, twice, fields count from an activation of 0.001, \
                 and a fifth of them is held out.",
        reservations: &RESERVATIONS,
        decisions: "table1.md",
        comparisons_remark: Some(BANDWIDTH_IS_OF_POLICY_ALIGN),
        comparisons: comparisons(),
        setups: setups(Redraw::Every(REDRAW), 0, max_rows),
        paper: paper_table(include_str!("../../paper/table1.toml"))?,
        explanations: explanations("table1", include_str!("../../paper/table1-explained.toml"))?,
        ..Experiment::default()
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
        decisions: "table1.md",
        comparisons_remark: Some(BANDWIDTH_IS_OF_POLICY_ALIGN),
        another_reading_of: Some("table1"),
        comparisons: comparisons(),
        setups: setups(Redraw::Segments(3), LITERAL, |_| LITERAL_ROWS),
        paper: paper_table(include_str!("../../paper/table1.toml"))?,
        explanations: explanations("table1-literal", include_str!("../../paper/table1-literal-explained.toml"))?,
        ..Experiment::default()
    })
}

/// Number of samples after which the constraint is redrawn.
const REDRAW: usize = 20;

const RESERVATIONS: [&str; 1] = [
    "Section 4.1 calls the error of alignment \"only marginally different\" from the potential's. Here they differ by up to a factor of two.",
];

/// Explains why three rows agree for some learners.
const BANDWIDTH_IS_OF_POLICY_ALIGN: &str = "The bandwidth (narrow, medium, wide) is PolicyAlign's: it discards movements by it. The others \
                                            learn from all movements, the same in all three rows; nUPE is on the movements that PolicyAlign keeps.";

/// Number of rows from which the Gaussian processes learn. For the longer movements it is their default, because fewer
/// rows cost two digits of accuracy.
fn max_rows(size: usize) -> usize {
    if size < 100 { 1000 } else { 1500 }
}

/// Number of rows from which the Gaussian processes learn in the literal reading, which gives no new information about
/// them.
const LITERAL_ROWS: usize = 500;

/// Bandwidths, with their names in rows.
const BANDWIDTHS: [(&str, Bandwidth); 3] =
    [("narrow", Bandwidth::Narrow), ("medium", Bandwidth::Medium), ("wide", Bandwidth::Wide)];

/// The three systems: number, name, number of trajectories and of samples, potential.
fn systems() -> [(u32, &'static str, usize, ToyPotential); 3] {
    [
        (PARABOLA_SYSTEM, "parabola", 40, ToyPotential::parabola()),
        (SINUSOIDAL_SYSTEM, "sinusoidal", 40, ToyPotential::sinusoidal()),
        (LONG_SINUSOIDAL_SYSTEM, "sinusoidal", 100, ToyPotential::sinusoidal()),
    ]
}

/// The common properties of a table's rows.
struct Toy {
    redraw: Redraw,
    /// The first of its random streams.
    first_system: u32,
    start_range: f64,
    time_step: f64,
    /// Number of movements of a row; `None` for as many as its samples.
    movements: Option<usize>,
    recipe: Recipe,
}

impl Toy {
    fn new(redraw: Redraw, first_system: u32) -> Toy {
        let ToySystem { start_range, time_step, .. } = ToySystem::default();
        Toy { redraw, first_system, start_range, time_step, movements: None, recipe: Recipe::default() }
    }

    /// A system with `size` samples per movement, and as many movements unless `movements` is set.
    fn system(&self, size: usize, potential: ToyPotential) -> ToySystem {
        let Toy { redraw, start_range, time_step, .. } = *self;
        let n_trajectories = self.movements.unwrap_or(size);
        ToySystem { potential, n_trajectories, n_samples: size, redraw, start_range, time_step }
    }

    /// The printed rows.
    fn printed(&self) -> Vec<Setup> {
        let mut setups = Vec::new();
        for (number, name, size, potential) in systems() {
            let system = self.system(size, potential);
            for (bandwidth_name, bandwidth) in BANDWIDTHS {
                let id = format!("{name}-{size}x{size}-{bandwidth_name}");
                let row = Row::of_learner(&id);
                let algorithm = PolicyAlign { bandwidth, ..PolicyAlign::default() };
                let protocol = self.recipe.protocol(algorithm, 2, 1.0);
                let (cost, system_number) = (learning_cost(size, size), self.first_system + number);
                let trial = ToyTrial { system: system.clone(), protocol };
                setups.push(Setup::new(&id, system_number, cost, vec![row], trial));
            }
        }
        setups
    }
}

/// The printed table with a change.
fn changed(change: impl Fn(&mut Toy)) -> Vec<Setup> {
    let mut toy = Toy::new(Redraw::Every(REDRAW), 0);
    change(&mut toy);
    toy.printed()
}

/// The settings of the table, with the origin of their values.
pub(crate) fn settings() -> Vec<Setting> {
    let setting = |name, class, paper, used, change: fn(&mut Toy, f64)| {
        Setting::new("table1", name, class, paper, used, move |value| Ok(changed(|toy| change(toy, value))))
    };
    let library = |name, used, change| setting(name, Class::LibraryDefault, SILENT, used, change);
    let mut settings = vec![
        setting(
            "samples to the next constraint",
            Class::Fitted,
            "\"re-sampled twice\"",
            REDRAW as f64,
            |toy, samples| {
                toy.redraw = Redraw::Every(samples.round() as usize);
            },
        ),
        setting("starts within ±", Class::Paper, "axes of Figure 5", 2.0, |toy, range| toy.start_range = range),
        setting("δt of the toy system", Class::Paper, "(9) has no δt", 1.0, |toy, time_step| {
            toy.time_step = time_step;
        }),
        setting("divisor of the potentials", Class::Paper, "(23) has none", 1.0, |toy, by| toy.recipe.divisor = by),
        library("init_D", 25.0, |toy, init_d| toy.recipe.params.init_d = init_d),
        library("w_gen", 0.1, |toy, w_gen| toy.recipe.params.w_gen = w_gen),
        library("penalty", 1e-6, |toy, penalty| toy.recipe.params.penalty = penalty),
        library("init_alpha", 50.0, |toy, alpha| toy.recipe.params.init_alpha = alpha),
    ];
    settings.extend(Recipe::default().settings("table1", |recipe| Ok(changed(|toy| toy.recipe = recipe.clone()))));
    settings
}

/// Other settings that texts quote.
pub(crate) fn asked_about() -> Vec<Setting> {
    let with = |movements: f64| Ok(changed(|toy| toy.movements = Some(movements.round() as usize)));
    vec![Setting::new("table1", "movements", Class::Paper, "40 or 100", 40.0, with)]
}

fn setups(redraw: Redraw, first_system: u32, max_rows: fn(usize) -> usize) -> Vec<Setup> {
    let toy = Toy::new(redraw, first_system);
    let mut setups = toy.printed();
    for (number, name, size, potential) in systems() {
        let algorithms = BANDWIDTHS.map(|(_, bandwidth)| PolicyAlign { bandwidth, ..PolicyAlign::default() }).into();
        let baselines = toy_baselines(FrontEnd::FiniteDifferences, max_rows(size));
        let id = (&*format!("{name}-{size}x{size}-beside"), first_system + number);
        let scene = toy.system(size, potential);
        setups.push(BaselinesTrial::setup(id, &cases(name, size), scene, algorithms, baselines));
    }
    setups
}

/// The cases of a system, one per bandwidth.
fn cases(name: &str, size: usize) -> [String; 3] {
    BANDWIDTHS.map(|(bandwidth, _)| format!("{name}-{size}x{size}-{bandwidth}"))
}

/// Comparisons of the learners on each system with each bandwidth.
fn comparisons() -> Vec<Comparison> {
    let baselines = toy_baselines(FrontEnd::FiniteDifferences, 1);
    let cases = systems().into_iter().flat_map(|(_, name, size, _)| cases(name, size));
    let lines = |case: String| [Measure::Nupe, Measure::NupeFresh].map(|measure| baselines.comparison(&case, measure));
    cases.flat_map(lines).collect()
}

/// The learners of the toy system other than PolicyAlign.
pub fn toy_baselines(front_end: FrontEnd, max_rows: usize) -> Baselines {
    Baselines {
        naive: Some(toy_naive()),
        constraint_consistent: Some(ConstraintConsistent::default()),
        ..Baselines::of_gaussians(front_end, max_rows)
    }
}

/// One row of the table.
#[derive(Serialize)]
struct ToyTrial {
    system: ToySystem,
    protocol: Protocol,
}

/// How PolicyAlign learns the toy system.
pub(crate) fn toy_protocol(algorithm: PolicyAlign) -> Protocol {
    Recipe::default().protocol(algorithm, 2, 1.0)
}

/// The regression that all rows use.
pub fn toy_regressor() -> LwprRegressor {
    Recipe::default().regressor(2, 1.0)
}

/// The naive learner of the toy system.
pub fn toy_naive() -> DirectPolicyLearning {
    Recipe::default().naive(2, 1.0)
}

/// Work of aligning and regression, in the unit of [`Setup::cost`].
pub(crate) fn learning_cost(n_trajectories: usize, n_samples: usize) -> u64 {
    // Measured: per sample, regression takes about as long as 100 distance evaluations.
    (n_trajectories * n_samples * (n_trajectories + 100)) as u64
}

impl Trial for ToyTrial {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.system.record(rng)?;
        let evaluation = self.protocol.evaluate(&recordings, rng)?;
        let mut rows = evaluation.rows()?;
        add_errors(&mut rows, evaluation.learnt(), &fresh(&self.system, rng)?)?;
        Ok(rows)
    }
}
