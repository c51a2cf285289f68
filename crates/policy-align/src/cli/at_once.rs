//! Files and pieces of files that `fit` does not hold in memory together. Their digests are computed here, in parts on other machines, or
//! read from such parts.

use std::collections::HashSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use demo_io::Piece;
use policy_align::{Digest, Digester, Division, FileSummary, FitOptions, FurtherPiece, Part, PartError, Unfinished};
use serde_json::json;
use text::quoted;

use crate::cli::failure::{Exit, Failure, displayed};
use crate::cli::given::again;
use crate::cli::interrupt::last_words;
use crate::cli::lines::{Lines, counted, size};
use crate::cli::options::flags::{FitFlags, ReadFlags};
use crate::cli::recorded::{base_name, summaries};
use crate::cli::session::{Output, Session, complain, write};

/// Largest size of a part in bytes.
const PART: u64 = 1 << 31;

/// Decides which files, and which pieces of large ones, are read at once.
pub(crate) fn division(
    session: &Session,
    files: &[PathBuf],
    (reading, flags): (&ReadFlags, &FitFlags),
    options: &FitOptions,
) -> Result<Division, Failure> {
    let size = |text: &str| {
        let remedy = format!("--at-once 256MB, 2GB or {}", Division::ALL);
        Division::bytes(text)
            .ok_or_else(|| Failure::usage(format!("'{text}' is not a size of files"), "--at-once", remedy))
    };
    let most = flags.at_once.as_deref().map(size).transpose()?;
    let whole = if flags.hold_out.is_empty() { options.needs_whole_recordings() } else { Some("--hold-out") };
    let most = most.unwrap_or(if whole.is_some() { u64::MAX } else { Division::AT_ONCE });
    if let Some(flag) = whole
        && !Division::fits(files, most)?
    {
        let what = format!("{flag} needs all files at once");
        return Err(Failure::usage(what, "--at-once", format!("no {flag}, or --at-once {}", Division::ALL)));
    }
    let bar = session.bar(0, "looking for movements  {bytes}, {elapsed} elapsed");
    let division = Division::of(files, &reading.options()?, most, &mut |read| bar.inc(read));
    bar.finish_and_clear();
    Ok(division?)
}

/// Parses I/N, the I-th of N shares.
pub(crate) fn shard(text: &str) -> Result<(usize, usize), Failure> {
    let numbers = text.split_once('/').and_then(|(this, of)| Some((this.parse().ok()?, of.parse().ok()?)));
    let shard = numbers.filter(|&(this, of): &(usize, usize)| (1..=of).contains(&this));
    shard.ok_or_else(|| Failure::usage(format!("'{text}' is not a share I/N with I up to N"), "--shard", "--shard 1/4"))
}

/// Digests of all further pieces; those computed here are kept in `unfinished`.
pub(crate) fn digests(
    session: &Session,
    (division, digester): (&Division, &Digester),
    unfinished: Option<&Unfinished>,
    parts: &[PathBuf],
) -> Result<Vec<Digest>, Failure> {
    let found = if parts.is_empty() {
        vec![part(session, (&division.further, digester), unfinished)?]
    } else {
        parts.iter().map(|path| read(path)).collect::<Result<_, _>>()?
    };
    Part::merged(found, &division.further, digester).map_err(|error| {
        let named = |of: &[usize]| of.iter().map(|&part| displayed(&parts[part])).collect::<Vec<_>>().join(", ");
        let (place, remedy) = match &error {
            PartError::Unfit { parts, .. } if parts.len() > 1 => (named(parts), "--merge with one of them"),
            PartError::Unfit { parts, .. } => {
                (named(parts), "this part again, by --shard, with the same files and flags")
            }
            _ => (counted(parts.len(), "part"), "the parts of all shares, made with the same files and flags"),
        };
        Failure::new(Exit::Refused, error.to_string(), place, remedy)
    })
}

/// Opens the file that keeps digests until `output` is written.
pub(crate) fn unfinished(output: &Path, pieces: &[FurtherPiece], digester: &Digester) -> Result<Unfinished, Failure> {
    let path = Unfinished::beside(output);
    Unfinished::open(&path, pieces, digester).map_err(|error| match error.kind() {
        ErrorKind::WouldBlock | ErrorKind::AlreadyExists => {
            let remedy = "-o with another name, or that file elsewhere, if no other fit is running";
            Failure::new(Exit::File, format!("digests cannot be kept: {error}"), displayed(&path), remedy)
        }
        _ => Failure::writing(&path, error),
    })
}

fn read(path: &Path) -> Result<Part, Failure> {
    let bytes = demo_io::read_bytes(path, PART).map_err(|error| Failure::reading(path, error))?;
    Part::of_json(&bytes)
        .map_err(|error| Failure::new(Exit::File, error.to_string(), displayed(path), "the part again, by --shard"))
}

fn part(
    session: &Session,
    (pieces, digester): (&[FurtherPiece], &Digester),
    unfinished: Option<&Unfinished>,
) -> Result<Part, Failure> {
    let found = unfinished.map_or(0, Unfinished::remaining);
    if found > 0 && !session.quiet {
        let of = counted(pieces.len(), &format!("further {}", word(pieces)));
        complain(&format!("goes on: {found} of {of} were read by an earlier run"));
    }
    let bytes = pieces.iter().map(|piece| piece.bytes).sum();
    let template = format!("further {}s  {{bar:30}} {{bytes}} of {{total_bytes}}, {{eta}} left", word(pieces));
    let bar = session.bar(bytes, &template);
    let kept =
        unfinished.map(|_| format!("stopped: every {} that was read is kept; the same command goes on", word(pieces)));
    last_words(kept.filter(|_| !session.quiet));
    let part = Part::of(pieces, digester, unfinished, &|read| bar.inc(read));
    last_words(None);
    bar.finish_and_clear();
    part.map_err(|error| match error {
        PartError::Read(error) => Failure::from(error),
        error => {
            let all = Division::ALL;
            let remedy = format!(
                "--at-once {all} or a larger size, --state or --ignore if its channels differ, or no such file"
            );
            Failure::of_text(Exit::Refused, &error.to_string(), "files that are not read at once", &remedy)
        }
    })
}

/// The noun for these pieces: "piece" if any is a part of a file, otherwise "file".
fn word(pieces: &[FurtherPiece]) -> &'static str {
    if pieces.iter().all(|further| further.piece.span.is_none()) { "file" } else { "piece" }
}

/// Writes a share of the digests, to `output` if given.
pub(crate) fn write_part(
    session: &Session,
    (division, digester): (&Division, &Digester),
    shard: (usize, usize),
    output: Option<&Path>,
) -> Result<Output, Failure> {
    if division.further.is_empty() {
        let what = "all files are read at once: there is nothing to share";
        return Err(Failure::usage(what, "--shard", "--at-once with a size below that of all files, or no --shard"));
    }
    let ((this, of), own) = (shard, part_file(shard));
    let output = output.unwrap_or(&own);
    let pieces = division.share(shard);
    let unfinished = unfinished(output, &pieces, digester)?;
    let text = part(session, (&pieces, digester), Some(&unfinished))?.to_json();
    let text =
        text.map_err(|error| Failure::new(Exit::Refused, error.to_string(), displayed(output), "other files"))?;
    write(output, &text)?;
    drop(unfinished);
    Unfinished::remove(&Unfinished::beside(output));
    if session.json {
        let document = json!({ "written": [displayed(output)], "digests": pieces.len(), "of": division.further.len() });
        return Ok(Output::json(&document, Exit::Done));
    }
    let mut lines = Lines::default();
    lines.add(
        "part",
        &format!("{this} of {of}: {} of {}", counted(pieces.len(), word(&division.further)), division.further.len()),
    );
    lines.add("written", &format!("{} ({})", displayed(output), size(text.len())));
    let added = if this < of {
        format!("--shard {}/{of}", this + 1)
    } else {
        let parts = (1..=of).map(|this| if this == of { quoted(output) } else { quoted(&part_file((this, of))) });
        format!("--merge {}", parts.collect::<Vec<_>>().join(" "))
    };
    let next = again("fit", &["--shard", "-o", "--output"], &added);
    Ok(Output::done(lines.next(&format!("policy-align fit {next}"))))
}

/// The default file name of a part.
fn part_file((this, of): (usize, usize)) -> PathBuf {
    PathBuf::from(format!("part-{this}-of-{of}.json"))
}

/// The files named by the user, those read at once first.
pub(crate) fn files_of(
    named: &[PathBuf],
    division: &Division,
    of_digests: Vec<FileSummary>,
) -> Result<Vec<FileSummary>, Failure> {
    let named_ones: HashSet<&PathBuf> = named.iter().collect();
    let is_listed = |piece: &&Piece| piece.is_first() && named_ones.contains(&piece.path);
    let at_once: Vec<PathBuf> = division.at_once.iter().filter(is_listed).map(|piece| piece.path.clone()).collect();
    let names: HashSet<String> = named.iter().map(|path| base_name(path)).collect();
    let further = of_digests.into_iter().filter(|file| names.contains(&file.name));
    Ok(summaries(&at_once)?.into_iter().chain(further).collect())
}
