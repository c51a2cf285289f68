//! The trust report next to a model: its files, and which model they are of.

use std::path::{Path, PathBuf};

use policy_align::{Model, ModelError, checksum_of};
use serde_json::Value;

use crate::cli::failure::{Failure, displayed};
use crate::cli::session::Session;

/// Text of a page before the checksum of its model.
pub(crate) const NAMED: &str = "Checksum of the model: ";
/// Digits of it in a page.
pub(crate) const DIGITS: usize = 16;
/// The member of the numbers that holds it.
pub(crate) const MEMBER: &str = "model_checksum";

/// Bytes of a report, at most.
const LARGEST: u64 = 64 << 20;

/// The page and the numbers that `fit` writes for a model.
pub(crate) fn trust_files(model: &Path) -> [PathBuf; 2] {
    ["trust.html", "trust.json"].map(|extension| model.with_extension(extension))
}

/// Reads a model that a command names, and warns of a trust report that is not its own.
pub(crate) fn load(session: &Session, path: &Path) -> Result<Model, Failure> {
    let read = demo_io::read_bytes(path, Model::LARGEST).map_err(ModelError::File);
    let read = read.and_then(|bytes| Ok((Model::from_json(&bytes)?, checksum_of(&bytes).unwrap_or_default())));
    let (model, checksum) = read.map_err(|error| Failure::model(path, &error))?;
    warn_of_others(session, path, &checksum);
    Ok(model)
}

/// Warns of a trust report of another model: a fit may have been killed, or have come between another and its report.
pub(crate) fn warn_of_others(session: &Session, model: &Path, checksum: &str) {
    let [page, numbers] = trust_files(model);
    // Reports without it are of older programs.
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
