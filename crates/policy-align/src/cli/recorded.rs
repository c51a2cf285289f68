//! Recordings from the files that a command names.

use std::path::{Path, PathBuf};

use demo_io::Piece;
use motion::{Finding, Recordings};
use policy_align::{
    ConstraintStretch, ContextUse, FileSummary, Model, Prepared, StateChannel, TaskLinks, estimate_constraints, prepare,
};

use crate::cli::failure::{Exit, Failure, displayed};
use crate::cli::given::value_word;
use crate::cli::lines::counted;
use crate::cli::options::config::Config;
use crate::cli::options::flags::{PrepareFlags, ReadFlags};
use crate::cli::session::Session;

/// Largest number of warnings printed: a repetitive recorder would fill the screen.
const PRINTED: usize = 6;

/// Reads the files, with a progress bar if it takes long, and prints a warning for each finding.
pub(crate) fn read(session: &Session, files: &[PathBuf], flags: &ReadFlags) -> Result<Recordings, Failure> {
    Ok(read_with_context(session, files, flags)?.0)
}

/// As [`read`], and returns how contexts are used.
pub(crate) fn read_with_context(
    session: &Session,
    files: &[PathBuf],
    flags: &ReadFlags,
) -> Result<(Recordings, ContextUse), Failure> {
    let pieces: Vec<Piece> = files.iter().map(|file| Piece::whole(file, files.len() > 1)).collect();
    read_pieces(session, &pieces, flags)
}

/// As [`read_with_context`], for files of which some are read in part.
pub(crate) fn read_pieces(
    session: &Session,
    pieces: &[Piece],
    flags: &ReadFlags,
) -> Result<(Recordings, ContextUse), Failure> {
    let bar =
        session.bar(pieces.iter().map(Piece::bytes).sum(), "reading  {bar:30} {bytes} of {total_bytes}, {eta} left");
    let recordings = demo_io::read_pieces(pieces, &flags.options()?, &mut |read| bar.inc(read));
    bar.finish_and_clear();
    let (mut recordings, context) = recordings?;
    warn(session, &recordings.findings);
    if flags.trim_still {
        prepare::trim_still(&mut recordings);
    }
    Ok((recordings, flags.context_use(context)))
}

/// Reads and prepares recordings in the channels and units of a model. Also returns the flags for reading.
pub(crate) fn prepared_for(
    session: &Session,
    model: &Model,
    files: &[PathBuf],
    (reading, preparing): (&ReadFlags, &PrepareFlags),
) -> Result<(ReadFlags, Prepared), Failure> {
    if !preparing.scale.is_empty() {
        let what = "--scale has no effect here: recordings are scaled as the model's";
        return Err(Failure::usage(what, "--scale", "no --scale; `policy-align fit --scale` learns with others"));
    }
    let config = Config::of(session)?;
    let mut own = config.under("read", reading)?.with_channels_of(model);
    own.elsewhere.clone_from(&reading.elsewhere);
    let reading = own;
    let options = model.prepare_options(&config.under("prepare", preparing)?.options(&reading)?);
    let recordings = read(session, files, &reading)?;
    let prepared = prepare(recordings, &options).map_err(|error| Failure::prepare(&error, named(files)))?;
    let found = StateChannel::names(&prepared.state);
    let expected = model.channels();
    if found != expected {
        let what = format!("the channels are {}, the model's {}", found.join(", "), expected.join(", "));
        let remedy = format!("--state {}", value_word(&expected.join(",")));
        return Err(Failure::usage(what, named(files), remedy));
    }
    if let Some(doubt) = other_units(model, &prepared) {
        session.warn(&format!("{}: {doubt}", named(files)));
    }
    Ok((reading, prepared))
}

/// A channel whose range exceeds the model's by this factor has another unit.
const OTHER_UNIT: f64 = 10.0;

/// Describes the channels that seem to have other units than the model's.
fn other_units(model: &Model, prepared: &Prepared) -> Option<String> {
    let width = |channel: &StateChannel| channel.high - channel.low;
    let pairs = prepared.state.iter().zip(&model.state);
    let odd: Vec<&str> = pairs
        .filter(|(here, learnt)| width(learnt) > 0.0 && width(here) > OTHER_UNIT * width(learnt))
        .map(|(_, learnt)| learnt.name.as_str())
        .collect();
    (!odd.is_empty()).then(|| {
        let what = format!("{}: over {OTHER_UNIT} times the range that the model learnt from", odd.join(", "));
        format!("{what}; other units? --degrees {} if these are degrees", value_word(&odd.join(",")))
    })
}

/// The constraints on prepared recordings of `files`.
pub(crate) fn acted(
    model: &Model,
    prepared: &Prepared,
    links: Option<&TaskLinks>,
    files: &[PathBuf],
) -> Result<Vec<ConstraintStretch>, Failure> {
    estimate_constraints(model, prepared, links).map_err(|error| {
        Failure::of_text(Exit::Refused, &error.to_string(), named(files), "recordings of this model's state")
    })
}

/// Refuses a name that no episode has; `flag` and `place` say where it was given.
pub(crate) fn known_episode<S: AsRef<str>>(
    name: &str,
    known: &[S],
    (flag, place): (&str, &str),
) -> Result<(), Failure> {
    if known.iter().any(|known| known.as_ref() == name) {
        return Ok(());
    }
    let some: Vec<&str> = known.iter().take(5).map(AsRef::as_ref).collect();
    let remedy = format!("one of {}, …", some.join(", "));
    Err(Failure::usage(format!("there is no episode '{name}'"), format!("{flag}, {place}"), remedy))
}

fn warn(session: &Session, findings: &[Finding]) {
    for finding in findings.iter().take(PRINTED) {
        session.warn(&format!("{}: {}", finding.what, finding.next));
    }
    if findings.len() > PRINTED {
        session.warn(&format!("and {} more: check --json lists all", findings.len() - PRINTED));
    }
}

/// Findings that reading has not yet printed.
pub(crate) fn unreported(findings: &[Finding], reported: &[Finding]) -> Vec<Finding> {
    findings.iter().filter(|finding| !reported.contains(finding)).cloned().collect()
}

/// Names and checksums of the files, for the model.
pub(crate) fn summaries(files: &[PathBuf]) -> Result<Vec<FileSummary>, Failure> {
    let summary = |path: &PathBuf| FileSummary::of(path).map_err(|error| Failure::reading(path, error));
    // The files in a folder are read, but not listed one by one.
    files.iter().filter(|path| path.is_file()).map(summary).collect()
}

/// The name without folders: a model does not reveal where it was made.
pub(crate) fn base_name(path: &Path) -> String {
    path.file_name().map_or_else(|| displayed(path), |name| name.to_string_lossy().into_owned())
}

/// A short description of the files.
pub(crate) fn named(files: &[PathBuf]) -> String {
    match files {
        [file] => base_name(file),
        files => counted(files.len(), "file"),
    }
}
