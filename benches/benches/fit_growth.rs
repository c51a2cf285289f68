//! Processor time, memory and error of a fit as a function of the number of samples: movements of 500 noisy samples in a CSV file, from
//! reading to the model with its trust numbers, as in `policy-align fit`.
//!
//! `cargo bench -p benches --bench fit_growth -- [dimensions] [samples]...`; without numbers d = 2, 10⁴, 10⁵, 10⁶.

#![allow(clippy::print_stdout)] // This program prints its results.

use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use benches::{Wells, cpu_seconds, peak_megabytes, write_noisy};
use motion::Policy as _;
use nalgebra::DMatrix;
use policy_align::demo_io::{self, ReadOptions};
use policy_align::{FitOptions, Model, PrepareOptions, Progress, Subject, fit, prepare};

const SAMPLES: usize = 500;
const NOISE: f64 = 0.05;

fn main() -> Result<(), Box<dyn Error>> {
    let numbers: Vec<usize> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let dim = numbers.first().copied().unwrap_or(2);
    let counts = if numbers.len() > 1 { numbers[1..].to_vec() } else { vec![10_000, 100_000, 1_000_000] };
    let wells = Wells::new(1, dim);
    println!(
        "{:>9} {:>8} {:>8} {:>6} {:>8} {:>7} {:>9} {:>9}",
        "samples", "CPU s", "wall s", "exp.", "peak MB", "rows", "nUPE", "expected"
    );
    let mut before: Option<(usize, f64)> = None;
    for count in counts {
        let file = std::env::temp_dir().join(format!("fit-growth-{}.csv", std::process::id()));
        let mut out = BufWriter::new(File::create(&file)?);
        write_noisy(&mut out, &wells, (count / SAMPLES, SAMPLES), NOISE, 1)?;
        out.flush()?;
        let (started, cpu_before) = (Instant::now(), cpu_seconds());
        let model = learn(&file);
        let (wall, cpu) = (started.elapsed().as_secs_f64(), cpu_seconds() - cpu_before);
        std::fs::remove_file(&file)?;
        let model = model?;
        let exponent = before.map(|(fewer, less)| (cpu / less).ln() / (count as f64 / fewer as f64).ln());
        let exponent = exponent.map_or(String::new(), |exponent| format!("{exponent:.2}"));
        let rows =
            model.decisions.iter().find(|decision| decision.what == Subject::Rows).map_or("all", |rows| &rows.value);
        let (error, expected) = (error(&model, &wells), model.trust.numbers.expected_error);
        let peak = peak_megabytes();
        println!("{count:9} {cpu:8.2} {wall:8.2} {exponent:>6} {peak:8.0} {rows:>7} {error:9.2e} {expected:9.2e}");
        before = Some((count, cpu));
    }
    Ok(())
}

fn learn(file: &std::path::Path) -> Result<Model, Box<dyn Error>> {
    let recordings = demo_io::read(file, &ReadOptions::default(), &mut |_bytes| ())?;
    let prepared = prepare(recordings, &PrepareOptions::default())?;
    let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_step| () };
    Ok(fit(&prepared, &FitOptions::default(), &mut progress)?)
}

/// nUPE: the mean squared error of the policy over its variance.
fn error(model: &Model, wells: &Wells) -> f64 {
    let (states, wanted) = wells.truth();
    let policy = model.policy();
    let learnt = DMatrix::from_columns(&states.column_iter().map(|state| policy.action(state)).collect::<Vec<_>>());
    let mean = wanted.column_mean();
    let spread: f64 = wanted.column_iter().map(|action| (action - &mean).norm_squared()).sum();
    (learnt - wanted).norm_squared() / spread
}
