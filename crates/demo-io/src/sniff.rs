//! Detects the format of a file by its first bytes, then by its extension.

use std::io::Read as _;
use std::path::Path;

use crate::input::Input;
use crate::regular_file::open;
use crate::{Fault, Format, ReadError};

/// Kind of contents, by the first bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Content {
    Known(Format),
    /// Possibly any of the line-based formats.
    Text,
    Nothing,
    Other,
}

const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// First bytes of the binary formats.
const MAGIC: [(&[u8], Format); 7] = [
    (crate::arrays::npy::MAGIC, Format::Npy),
    (b"PK\x03\x04", Format::Npz),
    (b"PK\x05\x06", Format::Npz),
    (HDF5, Format::Hdf5),
    (b"\x89MCAP0\r\n", Format::Mcap),
    (b"PAR1", Format::Parquet),
    (b"MATLAB 5.0", Format::Mat),
];

/// The format in which to read `input`. Content takes precedence over the extension, `--as` over both.
///
/// # Errors
///
/// Known formats that are not supported, and files that do not match `--as` or their extension.
pub(crate) fn format(input: &Input<'_>) -> Result<Format, ReadError> {
    let extension = input.path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    refuse_unread(input, &extension)?;
    let content = content(&input.head, &extension);
    let promised = input.options.format.or_else(|| by_extension(&extension));
    match (content, promised) {
        (Content::Known(found), Some(asked)) if input.options.format.is_some() && !same_family(found, asked) => {
            Err(not_this(input, asked, looks_like(content)))
        }
        (Content::Known(_) | Content::Nothing, Some(asked)) if input.options.format.is_some() => Ok(asked),
        (Content::Known(found), _) => Ok(found),
        (Content::Nothing, _) => {
            Err(ReadError::Empty(Fault::new("the file is empty", &input.name, "a file that is not empty")))
        }
        (_, Some(asked)) if is_text(asked) => Ok(asked),
        (_, Some(asked)) => Err(not_this(input, asked, looks_like(content))),
        (Content::Text, None) if !has_rows(&input.head) => {
            let remedy = "a recording: CSV, NPZ, JSON lines, LeRobot, HDF5, MCAP or MAT";
            let what = "not a recording: no line is a row of numbers";
            Err(ReadError::NotThisFormat(Fault::new(what, &input.name, remedy)))
        }
        (Content::Text | Content::Other, None) => Ok(Format::Csv),
    }
}

fn is_text(format: Format) -> bool {
    matches!(format, Format::Csv | Format::Tsv | Format::Jsonl)
}

fn same_family(found: Format, asked: Format) -> bool {
    found == asked || (is_text(found) && is_text(asked))
}

fn by_extension(extension: &str) -> Option<Format> {
    Some(match extension {
        "csv" | "txt" | "dat" => Format::Csv,
        "tsv" | "tab" => Format::Tsv,
        "npy" => Format::Npy,
        "npz" => Format::Npz,
        "jsonl" | "ndjson" | "json" => Format::Jsonl,
        "parquet" => Format::Parquet,
        "hdf5" | "h5" => Format::Hdf5,
        "mcap" => Format::Mcap,
        "mat" => Format::Mat,
        _ => return None,
    })
}

fn content(head: &[u8], extension: &str) -> Content {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let first = text.iter().find(|byte| !byte.is_ascii_whitespace());
    if let Some((_, format)) = MAGIC.iter().find(|(magic, _)| head.starts_with(magic)) {
        return Content::Known(*format);
    }
    if extension == "mat" && is_mat(head) {
        return Content::Known(Format::Mat);
    }
    match first {
        None => Content::Nothing,
        Some(b'{') => Content::Known(Format::Jsonl),
        Some(b'[') if extension.starts_with("json") || is_json_list(text) => Content::Known(Format::Jsonl),
        Some(_) if head.iter().take(4096).any(|&byte| byte == 0) => Content::Other,
        Some(_) => Content::Text,
    }
}

/// Whether a text begins like a list of lists or of objects.
fn is_json_list(text: &[u8]) -> bool {
    let mut letters = text.iter().filter(|byte| !byte.is_ascii_whitespace());
    letters.next() == Some(&b'[') && matches!(letters.next(), Some(b'[' | b'{')) && text.contains(&b',')
}

/// Whether a line of a text consists mostly of numbers, like a row of a table. A text that merely contains numbers is
/// something else.
fn has_rows(head: &[u8]) -> bool {
    let is_row = |line: &str| {
        let fields = line.split([',', ';', '\t', '|', ' ']).filter(|field| !field.is_empty());
        let (fields, numbers) = fields.fold((0, 0), |(fields, numbers), field| {
            (fields + 1, numbers + usize::from(field.trim_matches('"').parse::<f64>().is_ok()))
        });
        2 * numbers > fields && !line.contains(['=', '[', '{', '<'])
    };
    String::from_utf8_lossy(head).lines().any(is_row)
}

/// The header of a MAT-file of version 5 with a description other than MATLAB's: the byte order is at byte 126.
fn is_mat(head: &[u8]) -> bool {
    head.get(126..128).is_some_and(|order| order == b"IM" || order == b"MI")
}

fn looks_like(content: Content) -> &'static str {
    match content {
        Content::Known(format) => name(format),
        Content::Text => "text",
        Content::Nothing => "an empty file",
        Content::Other => "something else",
    }
}

pub(crate) fn name(format: Format) -> &'static str {
    match format {
        Format::Csv => "CSV",
        Format::Tsv => "TSV",
        Format::Npy => "NPY",
        Format::Npz => "NPZ",
        Format::Jsonl => "JSON lines",
        Format::LeRobot => "LeRobot",
        Format::Parquet => "Parquet",
        Format::Hdf5 => "HDF5",
        Format::Mcap => "MCAP",
        Format::Mat => "MAT",
    }
}

fn not_this(input: &Input<'_>, asked: Format, found: &str) -> ReadError {
    let article = if matches!(asked, Format::Npy | Format::Npz | Format::Hdf5 | Format::Mcap) { "an" } else { "a" };
    let what = format!("not {article} {} file; it looks like {found}", name(asked));
    let remedy = "--as with the format it has (csv, jsonl, npz, …), or another file";
    ReadError::NotThisFormat(Fault::new(what, &input.name, remedy))
}

/// First bytes of unsupported formats, their names, and the command that helps.
const NOT_READ: [(&[u8], &str, &str); 4] = [
    (
        b"SQLite format 3\0",
        "a bag of ROS 2 in sqlite3 storage, which is not read",
        "ros2 bag convert -i BAG -o out.yaml with 'storage_id: mcap' in out.yaml, or rosbags-convert --src BAG --dst OUT --dst-storage mcap",
    ),
    (
        b"#ROSBAG V",
        "a bag of ROS 1, which is not read",
        "rosbags-convert --src FILE.bag --dst OUT --dst-storage mcap (pip install rosbags)",
    ),
    (b"\x1f\x8b", "a file compressed by gzip, which is not read", "gunzip FILE"),
    (b"\x28\xb5\x2f\xfd", "a file compressed by zstd, which is not read", "unzstd FILE"),
];

/// Refuses known formats that are not supported.
fn refuse_unread(input: &Input<'_>, extension: &str) -> Result<(), ReadError> {
    let head = &input.head[..];
    let begins = |(magic, ..): &&(&[u8], &'static str, &'static str)| head.starts_with(magic);
    let (what, remedy) = if let Some(&(_, what, remedy)) = NOT_READ.iter().find(begins) {
        (what, remedy)
    } else if is_mat73(head) {
        ("a MAT-file of version 7.3, which is not read", "in MATLAB: save('out.mat', …, '-v7')")
    } else if matches!(extension, "pkl" | "pickle" | "pt" | "pth") || matches!(head, [0x80, 2..=5, ..]) {
        let remedy = "in Python, with a file you trust: np.savez(path, **{f'demo_{i}': d for i, d in enumerate(demos)}, dt=0.01)";
        let what = "a pickle: reading it would run what is inside";
        return Err(ReadError::Pickled(Fault::new(what, &input.name, remedy)));
    } else if matches!(extension, "xlsx" | "xls" | "ods") {
        ("a spreadsheet, which is not read", "save the sheet as CSV UTF-8")
    } else {
        return Ok(());
    };
    Err(ReadError::Unsupported(Fault::new(what, &input.name, remedy)))
}

/// Whether a file is HDF5 behind MATLAB's header of 512 bytes.
fn is_mat73(head: &[u8]) -> bool {
    head.starts_with(b"MATLAB 7.3") || (head.starts_with(b"MATLAB") && head.get(512..520) == Some(HDF5))
}

/// The kind of a folder: one data set, or a folder of recordings.
pub(crate) enum Folder {
    /// `meta/info.json` and `data/`.
    LeRobot,
    Files,
}

/// # Errors
///
/// Folders in unsupported formats.
pub(crate) fn folder(path: &Path, name: &str) -> Result<Folder, ReadError> {
    let has = |inside: &str| path.join(inside).exists();
    if has("meta/info.json") {
        return Ok(Folder::LeRobot);
    }
    if has(".zgroup") || has("zarr.json") || has(".zattrs") || name.to_lowercase().ends_with(".zarr") {
        let what = "a Zarr store, which is not read";
        let remedy = "in Python: z = zarr.open(PATH, 'r'); np.savez('out.npz', state=z['data/state'][:], episode_ends=z['meta/episode_ends'][:], dt=0.1)";
        return Err(ReadError::Unsupported(Fault::new(what, name, remedy)));
    }
    Ok(Folder::Files)
}

/// The first bytes of a model that was learnt from recordings.
const MODEL: &[u8] = br#"{"format":"policy-align model""#;

/// Whether a file is a model or its trust report, which `fit` may have written beside the recordings.
fn is_learnt(path: &Path) -> bool {
    if path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(".trust.json")) {
        return true;
    }
    let mut start = [0; MODEL.len()];
    let read = open(path).and_then(|(mut file, _)| file.read_exact(&mut start));
    read.is_ok() && start == MODEL
}

/// Whether a file in a folder is to be read. Others (notes, videos, images, models) are skipped.
pub(crate) fn is_recording(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    let of_data = by_extension(&extension).is_some() || matches!(&extension[..], "db3" | "bag");
    !hidden && of_data && !(extension == "json" && is_learnt(path))
}
