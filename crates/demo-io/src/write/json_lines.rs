use std::borrow::Cow;
use std::io::Write;

use nalgebra::DMatrix;
use serde::Serialize;

use super::Failure;
use crate::label_entry::LabelEntry;
use motion::{Episode, Recordings, Times};

/// Writes one line per episode, each with names, units and labels.
pub(super) fn write(mut file: impl Write, recordings: &Recordings) -> Result<(), Failure> {
    let names: Vec<&str> = recordings.state.iter().map(|channel| &channel.name[..]).collect();
    let units: Vec<Option<&str>> = recordings.state.iter().map(|channel| channel.unit.as_deref()).collect();
    for episode in &recordings.episodes {
        let step = even_step(&episode.times);
        let line = Line {
            episode: &episode.name,
            dt: step,
            times: step.is_none().then(|| episode.times.stamps()),
            names: &names,
            unit: units.iter().any(Option::is_some).then_some(&units),
            constraint: episode.constraint.as_ref().map(|labels| LabelEntry::of(labels, episode.times.len())),
            state: samples(&episode.positions),
            velocity: episode.velocities.as_ref().map(samples),
        };
        serde_json::to_writer(&mut file, &line).map_err(std::io::Error::from)?;
        file.write_all(b"\n")?;
    }
    Ok(())
}

#[derive(Serialize)]
struct Line<'a> {
    episode: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    dt: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    times: Option<Cow<'a, [f64]>>,
    names: &'a [&'a str],
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'a Vec<Option<&'a str>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    constraint: Option<LabelEntry>,
    state: Vec<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    velocity: Option<Vec<&'a [f64]>>,
}

fn samples(numbers: &DMatrix<f64>) -> Vec<&[f64]> {
    numbers.as_slice().chunks_exact(numbers.nrows().max(1)).collect()
}

/// The time step of which all stamps are multiples, to the last bit.
fn even_step(times: &Times) -> Option<f64> {
    let times = times.stamps();
    let step = times.get(1).copied().filter(|&step| step > 0.0)?;
    times.iter().enumerate().all(|(sample, &time)| time == sample as f64 * step).then_some(step)
}

/// The time step of which the stamps of all episodes are multiples.
pub(super) fn common_step(episodes: &[Episode]) -> Option<f64> {
    let step = even_step(&episodes.first()?.times)?;
    episodes.iter().all(|episode| even_step(&episode.times) == Some(step)).then_some(step)
}
