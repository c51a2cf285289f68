//! Compares a slope GP that uses all rows with one that uses 1,500 exact rows, both fitted to the same rows in one process:
//! error on held-out movements, processor time, and whether the expected error is within a factor of ten of the true one.
//!
//! `RAYON_NUM_THREADS=1 cargo bench -p benches --bench all_rows -- [data sets of each kind] [NAME]`; by default five data sets, and
//! all kinds instead of those whose names contain NAME. Prints for each kind the medians of both errors and of the ratios of error and
//! time, and how often the expected error is within a factor of ten of the true one.

#![allow(clippy::print_stdout)] // This program prints its results.

use std::error::Error;

use benches::cpu_seconds;
use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind};
use demo_gen::{Recording, Redraw, RollOut, demonstrations};
use gp::{FrontEnd, PushTest, Rows, SlopeGp};
use motion::Policy as _;
use nalgebra::DMatrix;
use policy_align::FitOptions;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Number of held-out movements, and the stride of their test samples.
const FRESH: usize = 20;
const EVERY: usize = 5;
/// Duration of a movement in seconds, and number of its Euler steps.
const SECONDS: f64 = 40.0;
const STEPS: usize = 2000;

/// Data sets of one kind. The noise of velocities along every axis is this share of their root mean square.
struct Kind {
    name: &'static str,
    policy: PolicyKind,
    constraint: ConstraintKind,
    movements: usize,
    samples: usize,
    noise: f64,
}

/// Error, expected error and processor time of one fit.
struct Judged {
    error: f64,
    expected: f64,
    seconds: f64,
}

fn kinds() -> Vec<Kind> {
    use ConstraintKind::{Free, HalfFree, OneForAll, Varying};
    use PolicyKind::{Handwriting, LimitCycle, Planes, Sinusoidal, Swirl, Wells};
    let (kinks, softplus) = (Planes { dim: 2, edge: 0.0 }, Planes { dim: 6, edge: 0.1 });
    let policies = [
        ("sinusoid, 2-D", Sinusoidal, Varying),
        ("three wells, 3-D", Wells { dim: 3 }, Varying),
        ("three wells, 6-D", Wells { dim: 6 }, Varying),
        ("kinks, 2-D", kinks, Varying),
        ("softplus, 6-D", softplus, Varying),
        ("swirl, 3-D", Swirl { dim: 3 }, Varying),
        ("three wells, 3-D, half free", Wells { dim: 3 }, HalfFree),
        ("limit cycle, a corridor, free", LimitCycle, Free),
        ("handwriting, a corridor, free", Handwriting, Free),
        ("three wells, 3-D, one constraint", Wells { dim: 3 }, OneForAll),
    ];
    let sizes = [(60, 40), (60, 100), (200, 100)];
    let of = |(name, policy, constraint), (movements, samples), noise| Kind {
        name,
        policy,
        constraint,
        movements,
        samples,
        noise,
    };
    let each = |(size, noise)| policies.iter().map(move |&policy| of(policy, size, noise)).collect::<Vec<_>>();
    let mut kinds: Vec<Kind> = sizes.into_iter().flat_map(|size| [(size, 0.0), (size, 0.05)]).flat_map(each).collect();
    kinds.extend([0.0, 0.05].map(|noise| of(policies[1], (1250, 40), noise)));
    kinds
}

/// Training rows, test states, and the policy there.
type Drawn = (Rows, DMatrix<f64>, DMatrix<f64>);

impl Kind {
    /// Training rows, and states of other movements with the policy there, (n, Q) each.
    fn draw(&self, seed: u64) -> Result<Drawn, Box<dyn Error>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (samples, sub_steps) = (self.samples, STEPS / self.samples);
        let system = BeyondSystem {
            policy: self.policy,
            constraint: self.constraint,
            n_trajectories: self.movements + FRESH,
            redraw: Redraw::Every(samples / 2),
            roll_out: RollOut { n_samples: samples, time_step: SECONDS / samples as f64, sub_steps },
        };
        let recordings = system.record(&mut rng)?;
        let (shown, fresh) = recordings.split_at(self.movements);
        let rows = FrontEnd::Velocities.rows(&demonstrations(shown)?)?;
        let deviation = self.noise * rows.velocities().norm() / (rows.velocities().len() as f64).sqrt();
        let velocities = rows.velocities().map(|u| u + deviation * rng.sample::<f64, _>(StandardNormal));
        let rows = Rows::new(rows.states().clone(), velocities, rows.indices().to_vec())?;
        let count = rows.len();
        let rows = if self.noise > 0.0 { rows.with_variances(vec![deviation.powi(2); count])? } else { rows };
        let columns = |of: fn(&Recording) -> &DMatrix<f64>| {
            let columns = fresh.iter().flat_map(|recording| of(recording).column_iter().step_by(EVERY));
            DMatrix::from_columns(&columns.collect::<Vec<_>>())
        };
        Ok((rows, columns(|recording| &recording.truth.states), columns(|recording| &recording.truth.actions)))
    }
}

fn judged(
    gp: &SlopeGp,
    rows: &Rows,
    (states, truth): (&DMatrix<f64>, &DMatrix<f64>),
) -> Result<Judged, Box<dyn Error>> {
    let before = cpu_seconds();
    let fit = gp.fit(rows, &mut ChaCha8Rng::seed_from_u64(1))?;
    let seconds = cpu_seconds() - before;
    let mean = truth.column_mean();
    let spread: f64 = truth.column_iter().map(|action| (action - &mean).norm_squared()).sum();
    let error = (fit.actions(states.as_view()) - truth).norm_squared() / spread;
    Ok(Judged { error, expected: fit.report().expected_nupe, seconds })
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    motion::upper_median(values.collect()).unwrap_or(f64::NAN)
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let sets = words.iter().find_map(|word| word.parse().ok()).unwrap_or(5);
    let name = words.into_iter().find(|word| word.parse::<u64>().is_err()).unwrap_or_default();
    let kinds: Vec<Kind> = kinds().into_iter().filter(|kind| kind.name.contains(&name)).collect();
    if kinds.is_empty() {
        return Err(format!("no kind has {name:?} in its name; run without a name to see all").into());
    }
    // The program's learner, without its search for constraints that push, and the one for comparison.
    let all = SlopeGp { push_test: PushTest::AssumeNone, ..FitOptions::default().gaussian_processes().slope };
    let exact = SlopeGp { max_rows: 1500, inducing_rows: 0, ..SlopeGp::default() };
    println!("| | movements | noise | all rows | 1,500 exact | ratio | CPU s | CPU ratio | within ten times |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for kind in kinds {
        let mut fits = Vec::new();
        for seed in 1..=sets {
            let (rows, states, truth) = kind.draw(seed)?;
            let fit = |gp| judged(gp, &rows, (&states, &truth));
            fits.push((fit(&all)?, fit(&exact)?));
        }
        let of = |value: fn(&(Judged, Judged)) -> f64| median(fits.iter().map(value));
        let near = fits.iter().filter(|(all, _)| (0.1..=10.0).contains(&(all.expected / all.error))).count();
        println!(
            "| {} | {} × {} | {} % | {:.1e} | {:.1e} | {:.2} | {:.1} | {:.2} | {near} of {sets} |",
            kind.name,
            kind.movements,
            kind.samples,
            100.0 * kind.noise,
            of(|(all, _)| all.error),
            of(|(_, exact)| exact.error),
            of(|(all, exact)| all.error / exact.error),
            of(|(all, _)| all.seconds),
            of(|(all, exact)| all.seconds / exact.seconds),
        );
    }
    Ok(())
}
