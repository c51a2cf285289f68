//! Reads recordings from CSV, writes them in another format, and prints a reader's error for a faulty file.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::fs;

use demo_io::{Nan, ReadOptions, read, write};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let [table, arrays, faulty] = ["reach.csv", "reach.npz", "faulty.csv"].map(|name| folder.path().join(name));

    fs::write(&table, "episode,t,x,y\n0,0.0,1.5,2.0\n0,0.1,1.25,2.5\n0,0.2,1.125,2.75\n1,0.0,0,1\n1,0.1,0.5,1\n")?;
    let recordings = read(&table, &ReadOptions::default(), &mut |_bytes| ())?;
    let names: Vec<&str> = recordings.state.iter().map(|channel| channel.name.as_str()).collect();
    println!("state {names:?}, time step {} s", recordings.time_step());
    for episode in &recordings.episodes {
        println!("episode {}: {} samples, {:.1} s", episode.name, episode.n_samples(), episode.times.duration());
    }

    write(&arrays, &recordings)?;
    let again = read(&arrays, &ReadOptions::default(), &mut |_bytes| ())?;
    let same = again.episodes.iter().zip(&recordings.episodes).all(|(a, b)| a.positions == b.positions);
    println!("written as NPZ and read again: {} episodes, the same numbers: {same}", again.episodes.len());

    fs::write(&faulty, "t,x\n0.0,1.5\n0.1,\n0.2,1.125\n")?;
    if let Err(error) = read(&faulty, &ReadOptions::default(), &mut |_bytes| ()) {
        println!("\nerror {}: {error}", error.code());
    }
    let options = ReadOptions { nan: Nan::Fill, ..ReadOptions::default() };
    let filled = read(&faulty, &options, &mut |_bytes| ())?;
    println!("\nwith Nan::Fill: {:?}", filled.episodes[0].positions.as_slice());
    for finding in &filled.findings {
        println!("finding: {}", finding.what);
    }
    Ok(())
}
