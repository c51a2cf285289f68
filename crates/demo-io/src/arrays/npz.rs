//! Named NumPy arrays: a zip archive of .npy files.

use std::io::Read;

use flate2::read::DeflateDecoder;
use rawzip::{CompressionMethod, ErrorKind, FileReader, RECOMMENDED_BUFFER_SIZE, ZipArchive, ZipArchiveEntryWayfinder};

use crate::arrays::array::ArraySpec;
use crate::arrays::flat;
use crate::arrays::npy::Header;
use crate::input::{Input, damaged};
use crate::raw::RawRecordings;
use crate::{Fault, ReadError};

/// Maximum number of arrays in an archive.
const MOST_ENTRIES: usize = 100_000;

struct Entry {
    name: String,
    wayfinder: ZipArchiveEntryWayfinder,
    deflated: bool,
}

pub(crate) fn read(input: &Input<'_>, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let file = &input.name;
    let mut buffer = vec![0; RECOMMENDED_BUFFER_SIZE];
    let archive = ZipArchive::from_file(input.open()?, &mut buffer).map_err(|error| zip(&error, file))?;
    let mut entries: Vec<Entry> = Vec::new();
    let mut directory = archive.entries(&mut buffer);
    while let Some(record) = directory.next_entry().map_err(|error| zip(&error, file))? {
        let path = String::from_utf8_lossy(record.file_path().as_ref()).into_owned();
        let Some(name) = path.strip_suffix(".npy") else { continue };
        let deflated = match record.compression_method() {
            method if method == CompressionMethod::STORE => false,
            method if method == CompressionMethod::DEFLATE => true,
            method => {
                let what = format!("'{name}' is compressed by {method:?}");
                let remedy = "numpy.savez or numpy.savez_compressed to write it";
                return Err(ReadError::Unsupported(Fault::new(what, file, remedy)));
            }
        };
        if entries.len() == MOST_ENTRIES {
            let remedy = "fewer a file";
            return Err(ReadError::TooLarge(Fault::new(format!("more than {MOST_ENTRIES} arrays"), file, remedy)));
        }
        entries.push(Entry { name: name.to_owned(), wayfinder: record.wayfinder(), deflated });
    }
    if entries.is_empty() {
        let what = "an archive without NumPy arrays";
        return Err(ReadError::NotThisFormat(Fault::new(what, file, "numpy.savez to write it")));
    }
    let described = |entry: &Entry| -> Result<ArraySpec, ReadError> {
        let header = opened(&archive, entry, input, |reader| Header::read(reader, &place(file, entry)))?;
        Ok(header.described(entry.name.clone()))
    };
    let described = entries.iter().map(described).collect::<Result<Vec<_>, _>>()?;
    flat::recordings(input, &described, &mut |index| {
        let entry = &entries[index];
        progress(entry.wayfinder.compressed_size_hint());
        opened(&archive, entry, input, |mut reader| {
            let place = place(file, entry);
            let header = Header::read(&mut reader, &place)?;
            let left = entry.wayfinder.uncompressed_size_hint().saturating_sub(header.len);
            let data = header.data(&mut reader, left, &place, input)?;
            // The checksum is compared at the end.
            match std::io::copy(&mut reader.take(1 << 20), &mut std::io::sink()) {
                Ok(_) => Ok(data),
                Err(error) => Err(damaged(&error, &place)),
            }
        })
    })
}

fn place(file: &str, entry: &Entry) -> String {
    format!("{file}, array '{}'", entry.name)
}

/// Passes the entry's decompressed and checked bytes to `use_it`.
fn opened<T>(
    archive: &ZipArchive<FileReader>,
    entry: &Entry,
    input: &Input<'_>,
    use_it: impl FnOnce(&mut dyn Read) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    let file = &input.name;
    let (packed, unpacked) = (entry.wayfinder.compressed_size_hint(), entry.wayfinder.uncompressed_size_hint());
    if packed > input.len {
        return Err(cut(file));
    }
    if unpacked > packed.saturating_mul(64).saturating_add(1 << 20) && !input.options.trust {
        let what = format!("'{}' grows from {packed} to {unpacked} bytes", entry.name);
        return Err(ReadError::grows(what, file));
    }
    let opened = archive.get_entry(entry.wayfinder).map_err(|error| zip(&error, file))?;
    if entry.deflated {
        use_it(&mut opened.verifying_reader(DeflateDecoder::new(opened.reader())))
    } else {
        use_it(&mut opened.verifying_reader(opened.reader()))
    }
}

fn cut(file: &str) -> ReadError {
    let what = "the archive is cut off: its directory, which stands at the end, is missing or points behind it";
    ReadError::truncated(what, file)
}

fn zip(error: &rawzip::Error, file: &str) -> ReadError {
    match error.kind() {
        ErrorKind::MissingEndOfCentralDirectory | ErrorKind::Eof | ErrorKind::InvalidEndOfCentralDirectory => cut(file),
        _ => ReadError::corrupt(format!("the archive is damaged: {error}"), file),
    }
}
