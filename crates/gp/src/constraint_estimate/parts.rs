//! The parts found in a movement.

use rayon::prelude::*;

use super::spaces::rarity;
use super::stretch_kind::{Movement, StretchKind};
use crate::stretches::partition::{Part, SPARE};

/// Parts of a movement, or of a section between two known switches: the searched rows, and the parts found, whose begin and end
/// are indices into these rows.
pub(super) struct Parts {
    pub(super) rows: Vec<usize>,
    pub(super) movement: Movement,
    pub(super) found: Vec<Part<StretchKind>>,
}

/// Cost (S38) of a constraint in each space, from the parts that have one.
pub(super) fn rarity_of(parts: &[Parts], spaces: usize) -> Vec<f64> {
    let constrained = |part: &&Part<StretchKind>| part.kind != StretchKind::Free;
    let costs = |of: &Parts| -> Vec<Vec<f64>> {
        of.found.iter().filter(constrained).map(|part| of.movement.costs_in_spaces(part)).collect()
    };
    rarity(&parts.par_iter().flat_map_iter(costs).collect::<Vec<_>>(), spaces)
}

impl Parts {
    /// The parts found, and the gaps between them that are long enough to report; each with a flag that tells whether it was
    /// found.
    pub(super) fn with_gaps(&self) -> Vec<(Part<StretchKind>, bool)> {
        let ends = self.found.iter().map(|part| part.end);
        let begins = self.found.iter().map(|part| part.begin).chain([self.rows.len()]);
        let gaps = std::iter::once(0).chain(ends).zip(begins).filter(|(end, begin)| end + SPARE <= *begin);
        let gaps = gaps.map(|(begin, end)| (Part { begin, end, kind: StretchKind::Free }, false));
        let mut all: Vec<_> = self.found.iter().map(|&part| (part, true)).chain(gaps).collect();
        all.sort_by_key(|(part, _)| part.begin);
        all
    }
}
