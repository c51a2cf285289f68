//! Digests of some files, stored in a file for transfer between machines.

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
    /// Digests of these pieces, read in parallel, one on each thread. Each digest is independent of the other pieces. `progress` takes the
    /// number of bytes read since the last call. Pieces whose digests an earlier run kept in `unfinished` are not read again.
    ///
    /// # Errors
    /// [`PartError`] of the first unusable piece; reading then stops.
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

    /// Takes all digests of an earlier run; also returns the pieces without a digest.
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

    /// Keeps all digests in `unfinished`.
    pub fn keep_in(&self, unfinished: &Unfinished) {
        self.digests.iter().for_each(|digest| unfinished.keep(digest));
    }

    /// The part as JSON.
    ///
    /// # Errors
    /// [`PartError::Parts`] if memory does not suffice.
    pub fn to_json(&self) -> Result<Vec<u8>, PartError> {
        serde_json::to_vec(self).map_err(|error| PartError::Parts { reason: error.to_string() })
    }

    /// Reads a part from JSON.
    ///
    /// # Errors
    /// [`PartError::Parts`] if the text is not a part, or is one of another version.
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
    /// [`PartError::Parts`] if a piece is in no part; [`PartError::Unfit`] if it is in several, has changed, or a part was made for other
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
