//! files/expected.json: recordings in many formats, with the expected contents and messages.

use std::path::Path;

use anyhow::{Context as _, bail, ensure};
use demo_io::{ReadError, ReadOptions, read};
use motion::{Episode, Recordings};
use nalgebra::DMatrix;
use prepare::{PrepareOptions, Prepared, prepare};
use serde::Deserialize;
use sha2::{Digest as _, Sha256};

use super::read_json;

#[derive(Debug, Deserialize)]
struct Expected {
    cases: Vec<Case>,
}

/// A file, the flags for reading it, and the expected results.
#[derive(Debug, Deserialize)]
struct Case {
    path: String,
    #[serde(flatten)]
    first: Attempt,
    alt: Option<Attempt>,
}

#[derive(Debug, Deserialize)]
struct Attempt {
    #[serde(default)]
    args: String,
    kind: Kind,
    #[serde(default)]
    expect: Expect,
    code: Option<String>,
    #[serde(default)]
    says: Vec<String>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Ok,
    Warn,
    Refuse,
}

/// Expected properties of the recordings.
#[derive(Debug, Default, Deserialize)]
struct Expect {
    episodes: Option<usize>,
    samples: Option<Vec<usize>>,
    states: Option<usize>,
    dt: Option<f64>,
    names: Option<Vec<String>>,
    units: Option<Vec<String>>,
    episode_names: Option<Vec<String>>,
    constraints: Option<Vec<String>>,
    positions_sha256: Option<String>,
    velocities_sha256: Option<String>,
}

/// Number of readings compared, and their faults.
#[derive(Debug, Default)]
pub(super) struct Readings {
    pub(super) compared: usize,
    pub(super) faults: Vec<String>,
}

/// Reads every file of the list; returns none if there is no list.
pub(super) fn check(list: &Path) -> anyhow::Result<Readings> {
    let mut readings = Readings::default();
    if !list.is_file() {
        return Ok(readings);
    }
    let folder = list.parent().unwrap_or(Path::new("."));
    for case in read_json::<Expected>(list)?.cases {
        let file = case.path.split('#').next().unwrap_or_default();
        for attempt in std::iter::once(&case.first).chain(&case.alt) {
            readings.compared += 1;
            if let Err(fault) = attempt.check(&folder.join(file)) {
                readings.faults.push(format!("{} {}: {fault:#}", case.path, attempt.args));
            }
        }
    }
    Ok(readings)
}

impl Attempt {
    fn check(&self, file: &Path) -> anyhow::Result<()> {
        let outcome = read(file, &options(&self.args)?, &mut |_| ());
        match (self.kind, outcome) {
            (Kind::Refuse, Ok(_)) => bail!("read, but should be refused"),
            (Kind::Refuse, Err(error)) => self.refused(&error),
            (Kind::Ok, Ok(recordings)) => self.expect.check(&recordings),
            (Kind::Warn, Ok(recordings)) => self.warned(recordings),
            (Kind::Ok | Kind::Warn, Err(error)) => bail!("{}: {error}", error.code()),
        }
    }

    fn refused(&self, error: &ReadError) -> anyhow::Result<()> {
        ensure!(Some(error.code()) == self.code.as_deref(), "{} instead of {:?}: {error}", error.code(), self.code);
        let text = error.to_string();
        ensure!(text.lines().count() == 3, "not three lines: {text}");
        says(&self.says, &text)
    }

    /// Compares the findings of reading and preparing; the expectations apply to the episodes that were not left out.
    fn warned(&self, mut recordings: Recordings) -> anyhow::Result<()> {
        if self.args.contains("--trim-still") {
            prepare::trim_still(&mut recordings);
        }
        let Prepared { findings, left_out, .. } = prepare(&recordings, &PrepareOptions::default())?;
        let is_left_out = |episode: &Episode| left_out.iter().any(|left| left.episode == episode.name);
        recordings.episodes.retain(|episode| !is_left_out(episode));
        self.expect.check(&recordings)?;
        let left_out: Vec<_> = left_out.iter().map(|left| format!("episode {} {}", left.episode, left.why)).collect();
        let found = findings.iter().map(|finding| format!("{}: {}", finding.what, finding.next));
        says(&self.says, &found.chain(left_out).collect::<Vec<_>>().join("\n"))
    }
}

fn says(words: &[String], text: &str) -> anyhow::Result<()> {
    for word in words {
        ensure!(text.contains(word), "'{word}' is not said: {text}");
    }
    Ok(())
}

impl Expect {
    fn check(&self, recordings: &Recordings) -> anyhow::Result<()> {
        let Recordings { state, episodes, .. } = recordings;
        let of_each = |value: fn(&Episode) -> String| episodes.iter().map(value).collect::<Vec<_>>();
        same("episodes", self.episodes.as_ref(), &episodes.len())?;
        same("samples", self.samples.as_ref(), &episodes.iter().map(|episode| episode.times.len()).collect())?;
        same("states", self.states.as_ref(), &state.len())?;
        same("names", self.names.as_ref(), &state.iter().map(|channel| channel.name.clone()).collect())?;
        same(
            "units",
            self.units.as_ref(),
            &state.iter().map(|channel| channel.unit.clone().unwrap_or_default()).collect(),
        )?;
        same("episode names", self.episode_names.as_ref(), &of_each(|episode| episode.name.clone()))?;
        let constraint =
            |episode: &Episode| episode.constraint.as_ref().and_then(|of| of.only()).unwrap_or_default().to_owned();
        same("constraints", self.constraints.as_ref(), &of_each(constraint))?;
        if let Some(expected) = self.dt {
            let found = recordings.time_step();
            ensure!((found / expected - 1.0).abs() < 1e-9, "dt is {found} instead of {expected}");
        }
        same("positions", self.positions_sha256.as_ref(), &hash(episodes.iter().map(|episode| &episode.positions)))?;
        let velocities = episodes.iter().filter_map(|episode| episode.velocities.as_ref());
        same("velocities", self.velocities_sha256.as_ref(), &hash(velocities))
    }
}

fn same<T: PartialEq + std::fmt::Debug>(what: &str, expected: Option<&T>, found: &T) -> anyhow::Result<()> {
    match expected {
        Some(expected) if expected != found => bail!("{what} are {found:?} instead of {expected:?}"),
        _ => Ok(()),
    }
}

/// SHA-256 of all numbers, sample by sample, as little-endian f64.
fn hash<'a>(matrices: impl Iterator<Item = &'a DMatrix<f64>>) -> String {
    let mut hasher = Sha256::new();
    for number in matrices.flat_map(DMatrix::as_slice) {
        hasher.update(number.to_le_bytes());
    }
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().concat()
}

/// Parses the flags of a case.
fn options(args: &str) -> anyhow::Result<ReadOptions> {
    let mut options = ReadOptions::default();
    let mut words = args.split_whitespace();
    while let Some(flag) = words.next() {
        let mut value = || words.next().with_context(|| format!("{flag} needs a value"));
        match flag {
            "--state" => options.state.push(value()?.to_owned()),
            "--velocity" => options.velocity.push(value()?.to_owned()),
            "--ignore" => options.ignore.push(value()?.to_owned()),
            "--degrees" => options.degrees.push(value()?.to_owned()),
            "--units" => options.units.push(value()?.to_owned()),
            "--time" => options.time = Some(value()?.to_owned()),
            "--episode" => options.episode = Some(value()?.to_owned()),
            "--constraint-column" => options.constraint_column = Some(value()?.to_owned()),
            "--filter" => options.filter = Some(value()?.to_owned()),
            "--topic" => options.topic = Some(value()?.to_owned()),
            "--dt" => options.dt = Some(value()?.parse()?),
            "--split-gap" => options.split_gap = Some(value()?.parse()?),
            "--decimal" => options.decimal = value()?.chars().next(),
            "--separator" => options.separator = value()?.chars().next(),
            "--as" => options.format = Some(named(value()?)?),
            "--nan" => options.nan = named(value()?)?,
            "--samples-are" => options.samples_are = Some(named(value()?)?),
            "--unwrap" => options.unwrap.push("*".to_owned()),
            "--sort" => options.sort = true,
            "--trim-still" => {}
            "--trust" => options.trust = true,
            _ => bail!("the flag {flag} is not known"),
        }
    }
    Ok(options)
}

/// A value from its name in settings files.
fn named<T: serde::de::DeserializeOwned>(name: &str) -> anyhow::Result<T> {
    Ok(serde_json::from_value(serde_json::Value::String(name.to_owned()))?)
}
