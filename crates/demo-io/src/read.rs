use std::fs;
use std::path::{Path, PathBuf};

use crate::arrays::{npy, npz};
use crate::clean::clean;
#[cfg(any(feature = "parquet", feature = "hdf5", feature = "mcap", feature = "mat"))]
use crate::guard::guarded;
use crate::input::{Input, name_of, unreadable};
use crate::joined::joined;
use crate::names::natural;
use crate::raw::{self, RawRecordings};
use crate::regular_file::FileState;
use crate::rows::piece::{Piece, Span};
use crate::rows::{delimited, json_lines, roles};
use crate::sniff::{self, Folder};
use crate::{Fault, Format, ReadError, ReadOptions};
use motion::Recordings;

/// Reads a file of any format, or a folder of files with one movement each.
///
/// Calls `progress` from time to time with the number of bytes read since the last call.
///
/// # Errors
///
/// [`ReadError`] states the problem, its place, and the option that helps.
pub fn read(path: &Path, options: &ReadOptions, progress: &mut dyn FnMut(u64)) -> Result<Recordings, ReadError> {
    read_all(&[path.to_owned()], options, progress)
}

/// Reads several files as one set. Their channels must be equal. Their episodes follow each other and are named after their files:
/// `monday/3`.
///
/// # Errors
///
/// As [`read`], and [`ReadError::Lengths`] if the channels of two files differ.
pub fn read_all(
    paths: &[PathBuf],
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<Recordings, ReadError> {
    Ok(read_with_context(paths, options, progress)?.0)
}

/// As [`read_all`]; also returns the names of the channels that [`ReadOptions::context`] selects, which may itself give column numbers.
///
/// # Errors
///
/// As [`read_all`].
pub fn read_with_context(
    paths: &[PathBuf],
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<(Recordings, Vec<String>), ReadError> {
    let pieces: Vec<Piece> = paths.iter().map(|path| Piece::whole(path, paths.len() > 1)).collect();
    read_pieces(&pieces, options, progress)
}

/// As [`read_with_context`], for files of which some may be read in part.
///
/// # Errors
///
/// As [`read_all`], and [`ReadError::Corrupt`] if a file has changed since it was cut.
pub fn read_pieces(
    pieces: &[Piece],
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<(Recordings, Vec<String>), ReadError> {
    set(pieces, &[], options, progress)
}

/// Reads another piece of a set. The `channels` of the pieces read before remain channels even if they never change here.
///
/// # Errors
///
/// As [`read_pieces`].
pub fn read_further(
    piece: &Piece,
    channels: &[String],
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<Recordings, ReadError> {
    Ok(set(std::slice::from_ref(piece), channels, options, progress)?.0)
}

fn set(
    pieces: &[Piece],
    channels: &[String],
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<(Recordings, Vec<String>), ReadError> {
    let joined = joined(pieces, |piece| {
        let recordings = match &piece.span {
            Some(span) => part(&piece.path, span, options, progress),
            None => whole(&piece.path, options, progress),
        }?;
        Ok(if piece.named_by_file { named_by_file(recordings, &piece.path) } else { recordings })
    })?;
    let place = || pieces.first().map(Piece::name).unwrap_or_default();
    let nothing = |what: &str| ReadError::Empty(Fault::new(what, place(), "recordings with movements"));
    let mut recordings = joined.ok_or_else(|| nothing("no file was given"))?;
    if let Some(pattern) = recordings.unknown.patterns.first() {
        return Err(roles::no_column(pattern, &recordings.unknown.names, &format!("--ignore, {}", place())));
    }
    clean(&mut recordings, channels, options)?;
    if recordings.channels.is_empty() {
        return Err(nothing("there is no state of one number or more"));
    }
    if recordings.episodes.iter().all(|raw| raw.len() < 2) {
        return Err(nothing("there is no episode of two samples or more"));
    }
    let context = if options.context.is_empty() { Vec::new() } else { std::mem::take(&mut recordings.context) };
    // A column that never changes has been dropped from the channels.
    let names = recordings.names();
    if let Some(constant) = context.iter().find(|name| !names.contains(name)) {
        return Err(roles::no_column(constant, &names, "--context, among the channels that were read"));
    }
    Ok((recordings.checked(), context))
}

/// Reads with the library of an optional feature, which may panic on damaged files.
macro_rules! with_feature {
    ($feature:literal, $name:expr, $read:expr) => {{
        #[cfg(feature = $feature)]
        let outcome = guarded($name, || $read);
        #[cfg(not(feature = $feature))]
        let outcome = Err(not_built($name, $feature));
        outcome
    }};
}

/// Reads a file or a folder.
fn whole(path: &Path, options: &ReadOptions, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let name = name_of(path);
    if path.is_dir() {
        return match sniff::folder(path, &name)? {
            Folder::LeRobot => {
                let recordings = with_feature!("parquet", &name, crate::rows::lerobot::read(path, options, progress));
                recordings.map(|recordings| with_idle(recordings, Format::LeRobot, options))
            }
            Folder::Files => folder(path, &name, options, progress),
        };
    }
    let mut input = Input::new(path, options)?;
    let format = sniff::format(&input)?;
    input.columns_first = format == Format::Mat;
    let recordings = match format {
        Format::Csv | Format::Tsv => delimited::read(&input, None, progress),
        Format::Jsonl => json_lines::read(&input, None, progress),
        Format::Npy => npy::read(&input, progress),
        Format::Npz => npz::read(&input, progress),
        Format::LeRobot | Format::Parquet => {
            with_feature!(
                "parquet",
                &name,
                crate::rows::parquet::read(&input, &crate::rows::parquet::Described::default(), progress)
            )
        }
        Format::Hdf5 => with_feature!("hdf5", &name, crate::arrays::hdf5::read(&input, progress)),
        Format::Mcap => with_feature!("mcap", &name, crate::rows::mcap::read(&input, progress)),
        Format::Mat => with_feature!("mat", &name, crate::arrays::mat::read(&input, progress)),
    };
    recordings.map(|recordings| with_idle(recordings, format, options))
}

/// Adds a finding for every option that has no effect in this format.
fn with_idle(mut recordings: RawRecordings, format: Format, options: &ReadOptions) -> RawRecordings {
    let remark = |(flag, of): (&str, &str)| {
        let what = format!("{flag} has no effect on {}", sniff::name(format));
        raw::remark(what, format!("no {flag}: it is for {of}"))
    };
    recordings.findings.extend(options.idle(format).map(remark));
    recordings
}

/// Reads the records of a part of a text.
fn part(
    path: &Path,
    span: &Span,
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<RawRecordings, ReadError> {
    let input = Input::new(path, options)?;
    let recordings = sniff::format(&input).and_then(|format| {
        let recordings = match format {
            Format::Jsonl => json_lines::read(&input, Some(span), progress),
            _ => delimited::read(&input, Some(span), progress),
        };
        recordings.map(|recordings| with_idle(recordings, format, options))
    });
    // If the file has changed, its contents are of no use.
    span.require_unchanged(path)?;
    recordings
}

/// Cuts a file into pieces of whole movements, each of at most `most` bytes unless a movement has more. Possible for some CSV, TSV and
/// blank-separated files, and for JSON lines with one episode per line. Joined, the pieces' recordings equal those of the whole file.
/// Returns one piece if the file is small or cannot be cut: other formats, no column of episodes, or interleaved episodes. Reads the file
/// once, piece by piece.
///
/// # Errors
///
/// The errors of reading the whole file, as far as it has been read.
pub fn pieces_of(
    file: Piece,
    most: u64,
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<Vec<Piece>, ReadError> {
    let Some(state) = FileState::of(&file.path).ok().filter(|state| state.bytes > most) else { return Ok(vec![file]) };
    let input = Input::new(&file.path, options)?;
    let spans = match sniff::format(&input)? {
        Format::Csv | Format::Tsv => delimited::cut(&input, (most, state), progress)?,
        Format::Jsonl => json_lines::cut(&input, (most, state), progress)?,
        _ => Vec::new(),
    };
    if spans.len() < 2 {
        return Ok(vec![file]);
    }
    Ok(spans.into_iter().map(|span| Piece { span: Some(span), ..file.clone() }).collect())
}

#[cfg(not(all(feature = "parquet", feature = "hdf5", feature = "mcap", feature = "mat")))]
fn not_built(name: &str, feature: &str) -> ReadError {
    let what = format!("this needs the feature '{feature}', which was not built in");
    let remedy = format!("cargo build --features {feature}, or convert the file to CSV or NPZ");
    ReadError::Unsupported(Fault::new(what, name, remedy))
}

/// Reads the files of a folder in natural order as one set.
fn folder(
    path: &Path,
    name: &str,
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<RawRecordings, ReadError> {
    let files = listed(path, name)?;
    let joined = joined(&files, |file| Ok(named_by_file(whole(file, options, progress)?, file)))?;
    joined.ok_or_else(|| {
        let what = "there is no file of a known format in the folder";
        ReadError::Empty(Fault::new(what, name, "a folder with .csv, .npz, .jsonl, .mcap … files, a movement each"))
    })
}

fn listed(folder: &Path, name: &str) -> Result<Vec<PathBuf>, ReadError> {
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(|error| unreadable(&error, name))?;
    let mut files: Vec<PathBuf> = entries.iter().map(fs::DirEntry::path).filter(|path| path.is_file()).collect();
    files.retain(|file| sniff::is_recording(file));
    files.sort_by(|a, b| natural::compare(&name_of(a), &name_of(b)));
    Ok(files)
}

/// The files of a folder with one movement each, in the order in which they are read. A file, or a folder that is one data set, is returned
/// as it is.
///
/// # Errors
///
/// [`ReadError`] for a folder that cannot be read.
pub fn files_of(path: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let name = name_of(path);
    if path.is_dir() && matches!(sniff::folder(path, &name)?, Folder::Files) {
        return listed(path, &name);
    }
    Ok(vec![path.to_owned()])
}

/// Prefixes the names of episodes with that of their file, because episodes are numbered within each of several files.
fn named_by_file(mut recordings: RawRecordings, file: &Path) -> RawRecordings {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    for raw in recordings.episodes.iter_mut().filter(|raw| raw.name != stem) {
        raw.name = format!("{stem}/{}", raw.name);
    }
    recordings
}
