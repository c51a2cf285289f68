use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::Digest;
use crate::large::FurtherPiece;

/// The digest of a further file or piece.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PieceDigest {
    /// Its index among the further pieces.
    pub(super) at: usize,
    pub(super) name: String,
    pub(super) bytes: u64,
    /// The range of bytes of the file; `None` if whole.
    span: Option<Range<u64>>,
    pub(super) digest: Digest,
}

impl PieceDigest {
    pub(super) fn new(of: &FurtherPiece, digest: Digest) -> Self {
        PieceDigest { at: of.at, name: of.piece.name(), bytes: of.bytes, span: span(of), digest }
    }

    /// Whether the digest belongs to this piece.
    pub(super) fn is_of(&self, further: &FurtherPiece) -> bool {
        (&self.name, self.bytes, &self.span) == (&further.piece.name(), further.bytes, &span(further))
    }
}

fn span(of: &FurtherPiece) -> Option<Range<u64>> {
    of.piece.span.as_ref().map(|span| span.bytes.clone())
}
