use std::path::{Path, PathBuf};

use crate::clean::clean;
use crate::draft::Drafts;
use crate::input::{Input, name_of};
use crate::notice::notice;
use crate::{Fault, ReadError, ReadOptions, Recordings, delimited};

/// Reads a file, or a folder of files with a movement each, whatever its format.
///
/// `progress` is told how many more bytes were read, now and then.
///
/// # Errors
///
/// [`ReadError`] says what is wrong, where, and which option helps.
pub fn read(path: &Path, options: &ReadOptions, progress: &mut dyn FnMut(u64)) -> Result<Recordings, ReadError> {
    read_all(&[path.to_owned()], options, progress)
}

/// Reads several files as one set: their channels must be equal, their episodes follow each other.
///
/// # Errors
///
/// As [`read`], and [`ReadError::Lengths`] if the channels of two files differ.
pub fn read_all(
    paths: &[PathBuf],
    options: &ReadOptions,
    progress: &mut dyn FnMut(u64),
) -> Result<Recordings, ReadError> {
    let mut joined: Option<Drafts> = None;
    for path in paths {
        let drafts = drafts(path, options, progress)?;
        match &mut joined {
            Some(joined) => join(joined, drafts, &name_of(path))?,
            None => joined = Some(drafts),
        }
    }
    let place = || paths.first().map(|path| name_of(path)).unwrap_or_default();
    let nothing = |what: &str| ReadError::Empty(Fault::new(what, place(), "another file: this one holds no movement"));
    let mut drafts = joined.ok_or_else(|| nothing("no file was given"))?;
    clean(&mut drafts, options)?;
    notice(&mut drafts, options);
    if drafts.episodes.is_empty() {
        return Err(nothing("there is no episode of two samples or more"));
    }
    Ok(Recordings::from_drafts(drafts))
}

fn drafts(path: &Path, options: &ReadOptions, progress: &mut dyn FnMut(u64)) -> Result<Drafts, ReadError> {
    let input = Input::new(path, options)?;
    delimited::read(&input, progress)
}

/// Appends the episodes of another file.
fn join(joined: &mut Drafts, more: Drafts, file: &str) -> Result<(), ReadError> {
    let names = |drafts: &Drafts| drafts.channels.iter().map(|channel| channel.name.clone()).collect::<Vec<_>>();
    if joined.channels != more.channels {
        let what = format!("channels differ: {} here, {} before", names(&more).join(", "), names(joined).join(", "));
        return Err(ReadError::Lengths(Fault::new(
            what,
            file,
            "--state with channels that all files have, or files of one kind",
        )));
    }
    joined.episodes.extend(more.episodes);
    joined.notes.extend(more.notes);
    Ok(())
}
