//! Aligns the trajectories of one file and prints the result and its time as JSON: the counterpart of
//! `benches/peers/compare_align.py`.
//!
//! The file contains one line `trajectories samples dimensions repetitions bandwidth` and then all states as
//! little-endian f64, one after the other.

use std::fs;
use std::time::Instant;

use align::{Aligned, Bandwidth, PolicyAlign};
use benches::{cpu_seconds, peak_megabytes};
use motion::Demonstrations;
use nalgebra::DMatrix;

fn main() {
    let path = std::env::args().nth(1).expect("usage: align_file FILE");
    let (demonstrations, bandwidth, repetitions) = read(&path);
    let learner = PolicyAlign { bandwidth, ..PolicyAlign::default() };
    let (mut wall, mut cpu, mut last) = (f64::INFINITY, f64::INFINITY, None);
    for _ in 0..repetitions.max(1) {
        drop(last.take()); // Frees the result, so that two repetitions are never in memory together.
        let (started, cpu_before) = (Instant::now(), cpu_seconds());
        last = Some(learner.align(std::hint::black_box(&demonstrations)).expect("the data can be aligned"));
        wall = wall.min(started.elapsed().as_secs_f64());
        cpu = cpu.min(cpu_seconds() - cpu_before);
    }
    print_json(&last.expect("at least one repetition"), wall, cpu);
}

fn read(path: &str) -> (Demonstrations, Bandwidth, usize) {
    let bytes = fs::read(path).expect("the file can be read");
    let end = bytes.iter().position(|&byte| byte == b'\n').expect("the file starts with a line");
    let header = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let words: Vec<&str> = header.split_whitespace().collect();
    let number = |at: usize| words[at].parse::<usize>().expect("counts are whole numbers");
    let bandwidth = match words[4] {
        "narrow" => Bandwidth::Narrow,
        "medium" => Bandwidth::Medium,
        "wide" => Bandwidth::Wide,
        sigma_squared => Bandwidth::Fixed(sigma_squared.parse().expect("a bandwidth is a name or a number")),
    };
    let states = bytes[end + 1..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("chunks of 8")));
    let states: Vec<f64> = states.collect();
    let trajectories =
        states.chunks_exact(number(1) * number(2)).map(|t| DMatrix::from_column_slice(number(2), number(1), t));
    let demonstrations = Demonstrations::from_states(trajectories, 1.0).expect("the trajectories are sound");
    assert_eq!(demonstrations.n_trajectories(), number(0), "the file is complete");
    (demonstrations, bandwidth, number(3))
}

#[allow(clippy::print_stdout)] // This program prints its results.
fn print_json(aligned: &Aligned, wall: f64, cpu: f64) {
    println!(
        "{{\"wall\":{wall:e},\"cpu\":{cpu:e},\"peak_megabytes\":{},\"sigma_squared\":{:e},\"lambda_2\":{:e},\"kept\":{:?},\"offsets\":{:?},\"linear\":{:?},\"laplacian\":{:?}}}",
        peak_megabytes(),
        aligned.sigma_squared(),
        aligned.lambda_2().unwrap_or(0.0),
        aligned.kept(),
        aligned.offsets().as_slice(),
        aligned.objective().map_or(&[][..], |objective| objective.linear.as_slice()),
        aligned.objective().map_or(&[][..], |objective| objective.laplacian.as_slice()),
    );
}
