//! The trust report next to a model: its files, and the model to which they belong.

use std::path::{Path, PathBuf};

use policy_align::{Model, ModelError, checksum_of};
use serde_json::Value;

use crate::cli::failure::{Failure, displayed};
use crate::cli::session::Session;

/// Text that precedes the model's checksum in a page.
pub(crate) const NAMED: &str = "Checksum of the model: ";
/// Digits of the checksum in a page.
pub(crate) const DIGITS: usize = 16;
/// The JSON member that holds the checksum.
pub(crate) const MEMBER: &str = "model_checksum";

/// Largest size of a report, in bytes.
const LARGEST: u64 = 64 << 20;

/// The HTML page and the JSON numbers that `fit` writes next to a model.
pub(crate) fn trust_files(model: &Path) -> [PathBuf; 2] {
    ["trust.html", "trust.json"].map(|extension| model.with_extension(extension))
}

/// Reads a model that a command names, and warns if the trust report next to it belongs to another model.
pub(crate) fn load(session: &Session, path: &Path) -> Result<Model, Failure> {
    let read = demo_io::read_bytes(path, Model::LARGEST).map_err(ModelError::File);
    let read = read.and_then(|bytes| Ok((Model::from_json(&bytes)?, checksum_of(&bytes).unwrap_or_default())));
    let (model, checksum) = read.map_err(|error| Failure::model(path, &error))?;
    warn_of_others(session, path, &checksum);
    Ok(model)
}

/// Warns if a trust report belongs to another model: a fit may have been killed, or another fit may have replaced one
/// of the files in between.
pub(crate) fn warn_of_others(session: &Session, model: &Path, checksum: &str) {
    let [page, numbers] = trust_files(model);
    // Reports without a checksum were written by older versions.
    let of_page = read(&page).and_then(|text| Some(text.rsplit_once(NAMED)?.1.get(..DIGITS)?.to_owned()));
    let of_numbers = read(&numbers).and_then(|text| serde_json::from_str(&text).ok());
    let of_numbers = of_numbers.and_then(|text: Value| Some(text.get(MEMBER)?.as_str()?.to_owned()));
    for (path, named) in [(page, of_page), (numbers, of_numbers)] {
        if named.is_some_and(|named| !checksum.starts_with(&named)) {
            let remedy = "delete it, or fit again";
            session.warn(&format!("{} reports on another model than {}; {remedy}", displayed(&path), displayed(model)));
        }
    }
}

fn read(path: &Path) -> Option<String> {
    String::from_utf8(demo_io::read_bytes(path, LARGEST).ok()?).ok()
}
