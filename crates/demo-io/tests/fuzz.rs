//! Damaged files: each reader returns recordings or an error within a second, and allocates no more memory than a bound
//! that depends on the file's size.
//!
//! `DEMO_IO_FUZZ=1000000 cargo test -p demo-io --all-features --test fuzz` tries this many files of every kind;
//! `DEMO_IO_FUZZ_ONLY=parquet` selects one kind, `DEMO_IO_FUZZ_FROM=14986` starts from a seed.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::Duration;

use common::{Files, read_with};
use cpu_time::ThreadTime;
use demo_io::{Piece, ReadError, ReadOptions, SamplesAre, pieces_of, read_pieces, write};
use motion::{Channel, Episode, Recordings, Source};
use nalgebra::DMatrix;
use rand::rngs::StdRng;
use rand::{Rng as _, RngExt as _, SeedableRng as _};

/// Number of damaged files of each kind, unless the environment variable sets another.
const FILES: u64 = 150;

/// A complete file and its reading options.
struct Sample {
    name: &'static str,
    content: Vec<u8>,
    options: ReadOptions,
}

fn recordings() -> Recordings {
    let numbers = |k: usize, shift: f64| {
        DMatrix::from_fn(2, 8, |row, column| (k as f64 + row as f64 + column as f64 * 0.3 + shift).sin())
    };
    let episode = |k: usize| Episode {
        name: format!("take {k}"),
        source: Source { file: String::new(), records: None },
        times: (0..8).map(|sample| f64::from(sample) * 0.05).collect(),
        positions: numbers(k, 0.0),
        velocities: Some(numbers(k, 1.0)),
        constraint: Some(format!("rail {k}").into()),
        context: nalgebra::DVector::zeros(0),
    };
    let channel = |name: &str| Channel { name: name.to_owned(), unit: Some("m".to_owned()) };
    Recordings { state: vec![channel("x"), channel("y")], episodes: (0..3).map(episode).collect(), findings: vec![] }
}

/// A sample of every format that this build supports.
fn samples() -> Vec<Sample> {
    let files = Files::new();
    let mut samples = Vec::new();
    let mut add =
        |name: &'static str, content: Vec<u8>, options: ReadOptions| samples.push(Sample { name, content, options });
    let written = ["a.csv", "a.tsv", "a.npz", "a.jsonl"].into_iter().chain(cfg!(feature = "mcap").then_some("a.mcap"));
    for name in written {
        let path = files.path().join(name);
        write(&path, &recordings()).unwrap();
        add(name, std::fs::read(path).unwrap(), ReadOptions::default());
    }
    let lines = "{\"episode\": 0, \"t\": 0.0, \"q\": [0.5, 1.5]}\n{\"episode\": 0, \"t\": 0.1, \"q\": [0.25, 2.5]}\n";
    add("samples.jsonl", lines.as_bytes().to_vec(), ReadOptions::default());
    add(
        "dates.csv",
        b"t;x;y\n2023-11-14 22:13:20.05;0,5;1\n2023-11-14 22:13:20.10;0,25;2\n".to_vec(),
        ReadOptions::default(),
    );
    add("blanks.txt", b"# t x y\n0  1.5 2\n1  2.5 3\n2 3.75 4\n".to_vec(), ReadOptions::default());
    let mut npy =
        b"\x93NUMPY\x01\x00\x46\x00{'descr': '>f4', 'fortran_order': True, 'shape': (2, 6, 2), }         \n".to_vec();
    npy.extend((0u8..24).flat_map(|value| f32::from(value).to_be_bytes()));
    let columns = ReadOptions { dt: Some(0.1), samples_are: Some(SamplesAre::Rows), ..ReadOptions::default() };
    add("a.npy", npy, columns);
    let kept =
        |name: &str| std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/samples").join(name)).unwrap();
    if cfg!(feature = "mat") {
        add("cell.mat", kept("cell.mat"), ReadOptions::default());
    }
    if cfg!(feature = "parquet") {
        add("lists.parquet", kept("lists.parquet"), ReadOptions::default());
    }
    if cfg!(feature = "hdf5") {
        add("robomimic.hdf5", kept("robomimic.hdf5"), ReadOptions::default());
    }
    samples
}

/// Changes some bytes: bits, bytes, lengths, pieces.
fn damaged(content: &[u8], random: &mut StdRng) -> Vec<u8> {
    let mut bytes = content.to_vec();
    for _ in 0..random.random_range(1..6) {
        let at = random.random_range(0..bytes.len().max(1));
        let Some(here) = bytes.get_mut(at) else { continue };
        match random.random_range(0..9) {
            0 => *here ^= 1 << random.random_range(0..8),
            1 => *here = random.random(),
            2 => *here = [0, 1, 0x7f, 0x80, 0xff, b'9', b'-', b',', b'"', b'\n'][random.random_range(0..10)],
            3 => bytes.truncate(at),
            4 => {
                let end = (at + random.random_range(1..64)).min(bytes.len());
                bytes.drain(at..end);
            }
            5 => {
                let end = (at + random.random_range(1..64)).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                let to = random.random_range(0..=bytes.len());
                bytes.splice(to..to, piece);
            }
            6 => {
                let value = [0u64, 1, 0x7fff_ffff, 0xffff_ffff, u64::MAX, 1 << 40, 0xffff_fff0]
                    [random.random_range(0..7)]
                .to_le_bytes();
                let length = [4, 8][random.random_range(0..2)].min(bytes.len() - at);
                bytes[at..at + length].copy_from_slice(&value[..length]);
            }
            7 => {
                let end = (at + random.random_range(1..32)).min(bytes.len());
                bytes[at..end].fill(0);
            }
            _ => {
                let mut piece = [0; 5];
                random.fill_bytes(&mut piece);
                bytes.splice(at..at, piece);
            }
        }
    }
    bytes
}

/// Peak memory of this process in bytes, if the operating system reports it.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}

#[test]
fn damaged_files_are_read_or_refused() {
    let count: u64 = std::env::var("DEMO_IO_FUZZ").ok().map_or(FILES, |count| count.parse().unwrap());
    let from: u64 = std::env::var("DEMO_IO_FUZZ_FROM").ok().map_or(0, |from| from.parse().unwrap());
    let only = std::env::var("DEMO_IO_FUZZ_ONLY").unwrap_or_default();
    let files = Files::new();
    for sample in samples().into_iter().filter(|sample| sample.name.contains(&only)) {
        let whole = files.add(sample.name, &sample.content);
        let read = read_with(&whole, &sample.options).unwrap_or_else(|error| panic!("{}: {error}", sample.name));
        assert!(read.episodes.iter().any(|episode| episode.times.len() > 1));
        let before = peak_memory();
        let bound = ((64 * sample.content.len() as u64) >> 20) + 64;
        let grown = || peak_memory().zip(before).map(|(after, before)| after.saturating_sub(before) >> 20);
        let (mut readable, mut slowest) = (0, (Duration::ZERO, 0));
        for seed in from..from + count {
            let content = damaged(&sample.content, &mut StdRng::seed_from_u64(seed));
            let path: PathBuf = files.add(sample.name, &content);
            // CPU time, because other programs affect wall-clock time.
            let start = ThreadTime::now();
            let outcome = catch_unwind(AssertUnwindSafe(|| read_with(&path, &sample.options)));
            let taken = start.elapsed();
            slowest = slowest.max((taken, seed));
            let grown = grown();
            assert!(
                grown.is_none_or(|grown| grown <= bound),
                "{} takes {grown:?} MB of {bound} with seed {seed}",
                sample.name
            );
            let Ok(outcome) = outcome else { panic!("{} panics with seed {seed}", sample.name) };
            in_pieces(&path, &sample.options, &outcome, seed);
            assert!(taken < Duration::from_secs(5), "{} takes {taken:?} with seed {seed}", sample.name);
            match outcome {
                Ok(found) => {
                    readable += 1;
                    check(&found, sample.name, seed);
                }
                Err(error) => assert_eq!(error.to_string().lines().count(), 3, "{} seed {seed}: {error}", sample.name),
            }
        }
        println!(
            "{}: {count} damaged files, {readable} readable, slowest {:?} with seed {}, memory grew by {:?} MB",
            sample.name,
            slowest.0,
            slowest.1,
            grown()
        );
    }
}

/// Read in the smallest pieces, a file yields the same as read whole.
fn in_pieces(path: &Path, options: &ReadOptions, whole: &Result<Recordings, ReadError>, seed: u64) {
    let pieces = pieces_of(Piece::whole(path, false), 1, options, &mut |_| ());
    let joined = pieces.and_then(|pieces| Ok(read_pieces(&pieces, options, &mut |_| ())?.0));
    let is_same = match (whole, &joined) {
        (Ok(whole), Ok(joined)) => whole == joined,
        (Err(_), Err(_)) => true,
        _ => false,
    };
    assert!(is_same, "{} with seed {seed}: {whole:?}, but {joined:?} in pieces", path.display());
}

/// Invariants that every reader guarantees.
fn check(found: &Recordings, name: &str, seed: u64) {
    let n = found.state.len();
    assert!(n > 0 && found.episodes.iter().any(|episode| episode.times.len() > 1), "{name} seed {seed}");
    for episode in &found.episodes {
        let len = episode.times.len();
        assert!(episode.times.steps().all(|step| step > 0.0), "{name} seed {seed}");
        assert!(episode.times.stamps().iter().all(|time| time.is_finite()), "{name} seed {seed}");
        for numbers in [Some(&episode.positions), episode.velocities.as_ref()].into_iter().flatten() {
            assert_eq!(numbers.shape(), (n, len), "{name} seed {seed}");
            assert!(numbers.iter().all(|number| number.is_finite()), "{name} seed {seed}");
        }
    }
}
