//! Digests of a share of the files, as a file that other machines hand over.

use demo_io::ReadOptions;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::large::{Division, FurtherFile, PartError, digest_file};
use crate::{Digest, Digester};

const FORMAT: &str = "policy-align part";
const VERSION: u32 = 1;

/// Digests of the I-th of N shares of all further files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    format: String,
    version: u32,
    /// I and N.
    shard: (usize, usize),
    digests: Vec<OfFile>,
}

/// The digest of one of the further files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct OfFile {
    /// Its place among them.
    at: usize,
    digest: Digest,
}

impl Part {
    /// Digests of a share of the further files, dealt out in turn: the I-th of N, counted from 1. Several files are read at a time, one on
    /// each thread; each digest is the same whatever else is read. `progress` takes the number of bytes read since the last call.
    ///
    /// # Errors
    /// [`PartError`] of the first file that cannot be used.
    pub fn of(
        division: &Division,
        digester: &Digester,
        shard: (usize, usize),
        reading: (&ReadOptions, bool),
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Part, PartError> {
        let (this, of) = shard;
        let is_own = |(at, _): &(usize, &FurtherFile)| at % of == this - 1;
        let own: Vec<(usize, &FurtherFile)> = division.further.iter().enumerate().filter(is_own).collect();
        let digest = |(at, file): &(usize, &FurtherFile)| {
            Ok(OfFile { at: *at, digest: digest_file(file, digester, reading, &mut |bytes| progress(bytes))? })
        };
        let found: Vec<Result<OfFile, PartError>> = own.par_iter().map(digest).collect();
        let digests = found.into_iter().collect::<Result<_, _>>()?;
        Ok(Part { format: FORMAT.to_owned(), version: VERSION, shard, digests })
    }

    /// As a file.
    ///
    /// # Errors
    /// [`PartError::Parts`] for numbers that JSON has no word for.
    pub fn to_json(&self) -> Result<Vec<u8>, PartError> {
        serde_json::to_vec(self).map_err(|error| PartError::Parts { reason: error.to_string() })
    }

    /// From a file.
    ///
    /// # Errors
    /// [`PartError::Parts`] for what is no part, or one of another version.
    pub fn of_json(text: &[u8]) -> Result<Part, PartError> {
        let no_part = |reason: String| PartError::Parts { reason: format!("this is no part of a fit: {reason}") };
        let part: Part = serde_json::from_slice(text).map_err(|error| no_part(error.to_string()))?;
        match (part.format.as_str(), part.version) {
            (FORMAT, VERSION) => Ok(part),
            (FORMAT, version) => Err(no_part(format!("its version is {version}, this program knows {VERSION}"))),
            (format, _) => Err(no_part(format!("its format is '{format}'"))),
        }
    }

    /// The digests of all further files, in their order, from parts in any order.
    ///
    /// # Errors
    /// [`PartError::Parts`] where a file is in no part or in several, or parts were made for other recordings or options.
    pub fn merged(parts: Vec<Part>, division: &Division, digester: &Digester) -> Result<Vec<Digest>, PartError> {
        let wrong = |reason: String| Err(PartError::Parts { reason });
        let mut merged: Vec<Option<Digest>> = vec![None; division.further.len()];
        for Part { shard: (this, of), digests, .. } in parts {
            for OfFile { at, digest } in digests {
                if digest.made_for != digester.made_for() {
                    return wrong(format!("part {this}/{of} was made with other files, options or by another version"));
                }
                match merged.get_mut(at) {
                    Some(place @ None) => *place = Some(digest),
                    _ => {
                        return wrong(format!(
                            "part {this}/{of} has a file that another part has, or that is not given"
                        ));
                    }
                }
            }
        }
        match merged.iter().position(Option::is_none) {
            Some(missing) => {
                let file = division.further[missing].path.display();
                wrong(format!("no part has {file}, the {}. file that is not read at once", missing + 1))
            }
            None => Ok(merged.into_iter().flatten().collect()),
        }
    }
}
