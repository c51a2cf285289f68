//! Digests of some files, as a file that other machines hand over.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::Digest;
use crate::large::piece_digest::PieceDigest;
use crate::large::{Digester, FurtherPiece, PartError, Unfinished};

const FORMAT: &str = "policy-align part";
const VERSION: u32 = 1;

/// Digests of some of the further files and pieces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    format: String,
    version: u32,
    digests: Vec<PieceDigest>,
}

impl From<Vec<PieceDigest>> for Part {
    fn from(digests: Vec<PieceDigest>) -> Part {
        Part { format: FORMAT.to_owned(), version: VERSION, digests }
    }
}

impl Part {
    /// Digests of these pieces, of which several are read at a time, one on each thread; each digest is the same whatever else is read.
    /// `progress` takes the number of bytes read since the last call. With `unfinished`, pieces that an earlier run has read are not read again.
    ///
    /// # Errors
    /// [`PartError`] of a piece that cannot be used; others are then not read.
    pub fn of(
        pieces: &[FurtherPiece],
        digester: &Digester,
        unfinished: Option<&Unfinished>,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Part, PartError> {
        let digest = |piece: &FurtherPiece| {
            if let Some(found) = unfinished.and_then(|unfinished| unfinished.take(piece)) {
                progress(piece.bytes);
                return Ok(found);
            }
            let digest = PieceDigest::new(piece, digester.digest_piece(piece, &mut |bytes| progress(bytes))?);
            if let Some(unfinished) = unfinished {
                unfinished.keep(&digest);
            }
            Ok(digest)
        };
        Ok(Part::from(pieces.par_iter().map(digest).collect::<Result<Vec<_>, PartError>>()?))
    }

    /// Takes all digests of an earlier run, and says which of these pieces they are not of.
    pub fn kept(unfinished: &Unfinished, pieces: &[FurtherPiece]) -> (Part, Vec<FurtherPiece>) {
        let (mut found, mut others) = (Vec::new(), Vec::new());
        for piece in pieces {
            match unfinished.take(piece) {
                Some(digest) => found.push(digest),
                None => others.push(piece.clone()),
            }
        }
        (Part::from(found), others)
    }

    /// Keeps all its digests.
    pub fn keep_in(&self, unfinished: &Unfinished) {
        self.digests.iter().for_each(|digest| unfinished.keep(digest));
    }

    /// As a file.
    ///
    /// # Errors
    /// [`PartError::Parts`] where there is no memory for it.
    pub fn to_json(&self) -> Result<Vec<u8>, PartError> {
        serde_json::to_vec(self).map_err(|error| PartError::Parts { reason: error.to_string() })
    }

    /// From a file.
    ///
    /// # Errors
    /// [`PartError::Parts`] for what is not a part, or is one of another version.
    pub fn of_json(text: &[u8]) -> Result<Part, PartError> {
        let no_part = |reason: String| PartError::Parts { reason: format!("this is not a part of a fit: {reason}") };
        let part: Part = serde_json::from_slice(text).map_err(|error| no_part(error.to_string()))?;
        match (part.format.as_str(), part.version) {
            (FORMAT, VERSION) => Ok(part),
            (FORMAT, version) => Err(no_part(format!("its version is {version}, this program knows {VERSION}"))),
            (format, _) => Err(no_part(format!("its format is '{format}'"))),
        }
    }

    /// The digests of all further pieces, in their order, from parts in any order.
    ///
    /// # Errors
    /// [`PartError::Parts`] where a piece is in no part; [`PartError::Unfit`] where it is in several, has changed, or a part was made for other
    /// recordings or options.
    pub fn merged(parts: Vec<Part>, pieces: &[FurtherPiece], digester: &Digester) -> Result<Vec<Digest>, PartError> {
        let mut merged: Vec<Option<(usize, Digest)>> = vec![None; pieces.len()];
        let digests =
            parts.into_iter().enumerate().flat_map(|(part, of)| of.digests.into_iter().map(move |of| (part, of)));
        for (part, found) in digests {
            let unfit = |parts: Vec<usize>, reason: String| Err(PartError::Unfit { parts, reason });
            let (at, of) = (found.at, &found.name);
            if found.digest.made_for != digester.made_for() {
                let reason = format!("the digest of {of} was made with other files, options or by another version");
                return unfit(vec![part], reason);
            }
            match pieces.get(at) {
                Some(piece) if found.is_of(piece) => {}
                _ => {
                    let reason = format!("the digest of {of} is of another file, or of this one before it changed");
                    return unfit(vec![part], reason);
                }
            }
            match &merged[at] {
                Some((first, _)) => return unfit(vec![*first, part], format!("{of} is in two parts")),
                None => merged[at] = Some((part, found.digest)),
            }
        }
        match merged.iter().position(Option::is_none) {
            Some(missing) => Err(PartError::Parts { reason: format!("no part has {}", pieces[missing].piece.name()) }),
            None => Ok(merged.into_iter().flatten().map(|(_, digest)| digest).collect()),
        }
    }
}
