use std::fmt::Write as _;
use std::io::{self, Write};

use nalgebra::DMatrix;
use rawzip::{CompressionMethod, ZipArchiveWriter, ZipDataWriter};

use super::json_lines::common_step;
use super::{Failure, has_velocities};
use motion::{Episode, Recordings};

/// Writes `state` and `velocity` (M, n), with the episodes in sequence up to `episode_ends`, `time` (M,) or `dt`, and
/// the texts `names`, `units`, `episode_names`, `constraint`. The last has one name per sample if it changes within an
/// episode.
pub(super) fn write(file: impl Write, recordings: &Recordings) -> Result<(), Failure> {
    let episodes = &recordings.episodes;
    let n = recordings.state.len();
    let total: usize = episodes.iter().map(|episode| episode.times.len()).sum();
    let mut archive = ZipArchiveWriter::new(file);
    let mut array =
        |name: &str, descr: &str, shape: &[usize], fill: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>| {
            add(&mut archive, name, &header(descr, shape), fill).map_err(io::Error::other)
        };
    let matrices = |file: &mut dyn Write, of: &dyn Fn(&Episode) -> Option<&DMatrix<f64>>| {
        episodes.iter().filter_map(of).try_for_each(|numbers| floats(file, numbers.as_slice()))
    };
    array("state", "<f8", &[total, n], &mut |file| matrices(file, &|episode| Some(&episode.positions)))?;
    if has_velocities(recordings)? {
        array("velocity", "<f8", &[total, n], &mut |file| matrices(file, &|episode| episode.velocities.as_ref()))?;
    }
    match common_step(episodes) {
        Some(step) => array("dt", "<f8", &[], &mut |file| floats(file, &[step]))?,
        None => array("time", "<f8", &[total], &mut |file| {
            episodes.iter().try_for_each(|episode| floats(file, &episode.times.stamps()))
        })?,
    }
    array("episode_ends", "<i8", &[episodes.len()], &mut |file| {
        let mut end = 0;
        episodes.iter().try_for_each(|episode| {
            end += episode.times.len() as u64;
            file.write_all(&end.to_le_bytes())
        })
    })?;
    let texts: [(&str, Vec<&str>); 4] = [
        ("names", recordings.state.iter().map(|channel| &channel.name[..]).collect()),
        ("units", recordings.state.iter().map(|channel| channel.unit.as_deref().unwrap_or_default()).collect()),
        ("episode_names", episodes.iter().map(|episode| &episode.name[..]).collect()),
        ("constraint", constraints(episodes)),
    ];
    for (name, texts) in texts {
        let longest = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0);
        if longest > 0 {
            array(name, &format!("<U{longest}"), &[texts.len()], &mut |file| wide_texts(file, &texts, longest))?;
        }
    }
    archive.finish().map_err(io::Error::other)?;
    Ok(())
}

/// One name per episode, or one per sample if any changes within an episode.
fn constraints(episodes: &[Episode]) -> Vec<&str> {
    let switches = |episode: &Episode| episode.constraint.as_ref().is_some_and(|labels| labels.switches() > 0);
    let each_sample = episodes.iter().any(switches);
    let mut names = Vec::new();
    for episode in episodes {
        let samples = if each_sample { episode.times.len() } else { 1 };
        names.extend((0..samples).map(|sample| episode.constraint.as_ref().map_or("", |labels| labels.at(sample))));
    }
    names
}

/// Adds an entry to the archive, uncompressed, because numbers of sensors hardly compress.
fn add(
    archive: &mut ZipArchiveWriter<impl Write>,
    name: &str,
    header: &[u8],
    fill: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
) -> Result<(), rawzip::Error> {
    let file = format!("{name}.npy");
    let (mut entry, config) = archive.new_file(&file).compression_method(CompressionMethod::STORE).start()?;
    let mut writer: ZipDataWriter<_> = config.wrap(&mut entry);
    writer.write_all(header)?;
    fill(&mut writer)?;
    let (_, descriptor) = writer.finish()?;
    entry.finish(descriptor)?;
    Ok(())
}

/// Magic, version 1.0, and the dictionary, padded to a multiple of 64 bytes.
fn header(descr: &str, shape: &[usize]) -> Vec<u8> {
    let mut lengths = String::new();
    for length in shape {
        // Writing to a String cannot fail.
        let _ = write!(lengths, "{length}, ");
    }
    let mut text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}", lengths.trim_end());
    let padding = 63 - (10 + text.len()) % 64;
    text.extend(std::iter::repeat_n(' ', padding));
    text.push('\n');
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend_from_slice(&(text.len() as u16).to_le_bytes());
    header.extend_from_slice(text.as_bytes());
    header
}

fn floats(file: &mut dyn Write, numbers: &[f64]) -> io::Result<()> {
    numbers.iter().try_for_each(|number| file.write_all(&number.to_le_bytes()))
}

fn wide_texts(file: &mut dyn Write, texts: &[&str], longest: usize) -> io::Result<()> {
    texts.iter().try_for_each(|text| {
        let codes = text.chars().map(u32::from).chain(std::iter::repeat(0)).take(longest);
        codes.into_iter().try_for_each(|code| file.write_all(&code.to_le_bytes()))
    })
}
