//! Adds up squares, one after the other. After an interruption, it resumes with the next one:
//! `cargo run --example long_sum`.

#![allow(clippy::print_stdout, reason = "an example prints")]

use std::io;
use std::time::Duration;

use journal::Journal;

fn main() -> io::Result<()> {
    let path = std::env::temp_dir().join("long_sum.journal");
    let (journal, found) = Journal::open::<(u32, f64)>(&path, "long sum 1")?;
    println!("{} of 20 are done, in {}", found.records.len(), path.display());
    let mut sum: f64 = found.records.iter().map(|(_, square)| square).sum();
    for number in found.records.len() as u32..20 {
        std::thread::sleep(Duration::from_millis(100)); // stands for slow work
        let square = f64::from(number).powi(2);
        journal.append(&(number, square))?;
        sum += square;
    }
    println!("sum: {sum}");
    drop(journal);
    journal::remove(&path, "long sum 1");
    Ok(())
}
