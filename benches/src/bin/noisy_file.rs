//! Writes noisy movements, and the true policy, for `benches/peers/growth.py`.
//!
//! usage: noisy_file MOVEMENTS SAMPLES RECORDING.csv TRUTH.csv: writes MOVEMENTS movements of SAMPLES samples among wells in the plane,
//! with 5 % noise on velocities (`episode,t,x1,x2,v1,v2`), and 500 states with the policy there (`x1,x2,u1,u2`).

use std::fs::File;
use std::io::{self, BufWriter, Write as _};

use benches::{Wells, write_noisy};

const NOISE: f64 = 0.05;

fn main() -> io::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [movements, samples, recording, truth] = &words[..] else {
        panic!("usage: noisy_file MOVEMENTS SAMPLES RECORDING.csv TRUTH.csv")
    };
    let [movements, samples] = [movements, samples].map(|number| number.parse().expect("counts are whole numbers"));
    let wells = Wells::new(1, 2);
    let mut out = BufWriter::new(File::create(recording)?);
    write_noisy(&mut out, &wells, (movements, samples), NOISE, 1)?;
    out.flush()?;
    let mut out = BufWriter::new(File::create(truth)?);
    writeln!(out, "x1,x2,u1,u2")?;
    let (states, actions) = wells.truth();
    for (x, u) in states.column_iter().zip(actions.column_iter()) {
        writeln!(out, "{},{},{},{}", x[0], x[1], u[0], u[1])?;
    }
    out.flush()
}
