//! Measures learning and prediction in Rust alone: `speed FILE.csv`, for `policy-align-py/benches/speed.py`, which
//! measures the same in Python. Prints the shortest of several runs in seconds: fit, and 10⁵ actions.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use align::Bandwidth;
use demo_io::ReadOptions;
use motion::Policy as _;
use motion::Recordings;
use nalgebra::{DMatrix, DVector};
use policy_align::{FitOptions, LearnerChoice, Model, PrepareOptions, Progress, fit, prepare};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which file?")?;
    let recordings = demo_io::read(path.as_ref(), &ReadOptions::default(), &mut |_| ())?;
    let slope = FitOptions { learner: LearnerChoice::Slope, max_rows: 100, ..FitOptions::default() };
    let (bandwidth, init_d) = (Some(Bandwidth::Medium), Some(10.0));
    let aligned = FitOptions { learner: LearnerChoice::PolicyAlign, bandwidth, init_d, ..slope.clone() };
    println!("fit {}", least(7, || learnt(&recordings, &slope).map(drop))?);
    for (name, options) in [("slope", slope), ("policy_align", aligned)] {
        let model = learnt(&recordings, &options)?;
        println!(
            "{name} {}",
            least(7, || {
                asked(&model);
                Ok(())
            })?
        );
    }
    Ok(())
}

fn learnt(recordings: &Recordings, options: &FitOptions) -> Result<Model, Box<dyn Error>> {
    let prepared = prepare(recordings, &PrepareOptions::default())?;
    let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_| () };
    Ok(fit(&prepared, options, &mut progress)?)
}

/// Predicts 10⁵ actions in one loop.
fn asked(model: &Model) {
    let n = model.state.len();
    let states = DMatrix::from_fn(n, 100_000, |row, column| ((row + 1) as f64 * 0.7 * column as f64).sin());
    let policy = model.policy();
    let (mut action, mut sum) = (DVector::zeros(n), 0.0);
    for state in states.column_iter() {
        policy.action_into(state, action.as_view_mut());
        sum += action[0];
    }
    std::hint::black_box(sum);
}

fn least(runs: usize, work: impl Fn() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut seconds = f64::INFINITY;
    for _ in 0..runs {
        let begin = Instant::now();
        work()?;
        seconds = begin.elapsed().as_secs_f64().min(seconds);
    }
    Ok(seconds)
}
