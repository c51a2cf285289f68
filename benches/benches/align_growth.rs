//! Processor time and memory of an alignment as a function of the number of movements of the toy system, 100 samples each,
//! narrow bandwidth.
//!
//! `cargo bench -p benches --bench align_growth -- [dimensions] [K]...`; without numbers d = 2, K = 10³, 10⁴, 10⁵.

#![allow(clippy::print_stdout)] // This program prints its results.

use std::time::Instant;

use align::PolicyAlign;
use benches::{cpu_seconds, peak_megabytes, toy_demonstrations};

fn main() {
    let numbers: Vec<usize> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let dim = numbers.first().copied().unwrap_or(2);
    let counts = if numbers.len() > 1 { numbers[1..].to_vec() } else { vec![1_000, 10_000, 100_000] };
    println!(
        "{:>7} {:>9} {:>9} {:>6} {:>9} {:>7} {:>10}",
        "K", "CPU s", "wall s", "exp.", "peak MB", "kept", "lambda_2"
    );
    let mut before: Option<(usize, f64)> = None;
    for count in counts {
        let demonstrations = toy_demonstrations(1, count, 100, dim);
        let (started, cpu_before) = (Instant::now(), cpu_seconds());
        let aligned = PolicyAlign::default().align(&demonstrations).expect("the data can be aligned");
        let (wall, cpu) = (started.elapsed().as_secs_f64(), cpu_seconds() - cpu_before);
        let exponent = before.map(|(fewer, less)| (cpu / less).ln() / (count as f64 / fewer as f64).ln());
        let exponent = exponent.map_or(String::new(), |exponent| format!("{exponent:.2}"));
        println!(
            "{count:7} {cpu:9.3} {wall:9.3} {exponent:>6} {:9.0} {:7} {:10.2e}",
            peak_megabytes(),
            aligned.kept().len(),
            aligned.lambda_2().unwrap_or(0.0),
        );
        before = Some((count, cpu));
    }
}
