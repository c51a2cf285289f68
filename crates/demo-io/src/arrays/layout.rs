//! Maps the indices of an array to samples, channels and episodes.

use crate::arrays::array::{ArraySpec, shape_text, transposed};
use crate::arrays::fields::too_many_channels;
use crate::input::Input;
use crate::{Fault, ReadError, SamplesAre};

/// The state of K episodes of N samples of n channels as one array, sample after sample.
#[derive(Debug, Default)]
pub(crate) struct Stack {
    pub(crate) episodes: usize,
    pub(crate) samples: usize,
    pub(crate) channels: usize,
    pub(crate) numbers: Vec<f64>,
}

/// K, N, n of an array's shape in its memory order.
pub(crate) fn dimensions(
    array: &ArraySpec,
    input: &Input<'_>,
    place: &str,
) -> Result<(usize, usize, usize), ReadError> {
    let (episodes, first, second) = match array.shape[..] {
        [samples] => return Ok((1, samples, 1)),
        [first, second] => (1, first, second),
        [episodes, first, second] => (episodes, first, second),
        _ => {
            let what = format!("'{}' has {} indices ({})", array.name, array.shape.len(), shape_text(&array.shape));
            let remedy = "--state with an array (samples, channels) or (episodes, samples, channels)";
            return Err(ReadError::NoRoles(Fault::new(what, place, remedy)));
        }
    };
    match input.samples_are() {
        None if second > first && first > 0 => {
            let mut shape = array.shape.clone();
            let (exchanged, right) = (input.other_layout(), if input.columns_first { "columns" } else { "rows" });
            if input.columns_first {
                shape.reverse();
            }
            let what = format!(
                "'{}' has shape ({}): {first} samples of {second} channels, as if rows and columns were exchanged",
                array.name,
                shape_text(&shape)
            );
            let remedy = format!("--samples-are {exchanged}, or --samples-are {right} if it is right as it is");
            Err(ReadError::LooksTransposed(Fault::new(what, place, remedy)))
        }
        Some(SamplesAre::Columns) => Ok((episodes, second, first)),
        Some(SamplesAre::Rows) | None => Ok((episodes, first, second)),
    }
}

/// Reorders numbers so that they follow one another sample by sample.
pub(crate) fn stack(array: &ArraySpec, numbers: Vec<f64>, input: &Input<'_>, place: &str) -> Result<Stack, ReadError> {
    let (episodes, samples, channels) = dimensions(array, input, place)?;
    too_many_channels(channels, input.other_layout(), place)?;
    if channels == 0 {
        let what = format!("'{}' has shape ({}): no channel", array.name, shape_text(&array.shape));
        return Err(ReadError::Empty(Fault::new(what, place, "--state with another array")));
    }
    let columns = input.samples_are() == Some(SamplesAre::Columns) && array.shape.len() > 1;
    let numbers = if columns && !numbers.is_empty() {
        // (channels, samples), episode by episode; reading them as if in Fortran order transposes them.
        numbers.chunks_exact(channels * samples).flat_map(|one| transposed(one, &[samples, channels])).collect()
    } else {
        numbers
    };
    Ok(Stack { episodes, samples, channels, numbers })
}

impl Stack {
    pub(crate) fn shape(&self) -> (usize, usize, usize) {
        (self.episodes, self.samples, self.channels)
    }

    /// Appends the channels of another array to each sample.
    pub(crate) fn join(self, other: &Stack, place: &str) -> Result<Self, ReadError> {
        if (self.episodes, self.samples) != (other.episodes, other.samples) {
            return Err(lengths("arrays to join", self.episodes * self.samples, other.episodes * other.samples, place));
        }
        let (n, m) = (self.channels, other.channels);
        let rows = self.numbers.chunks_exact(n.max(1)).zip(other.numbers.chunks_exact(m.max(1)));
        let numbers = rows.flat_map(|(left, right)| left.iter().chain(right)).copied().collect();
        Ok(Stack { channels: n + m, numbers, ..self })
    }
}

/// Error: arrays that belong together differ in length.
pub(crate) fn lengths(what: &str, expected: usize, found: usize, place: &str) -> ReadError {
    let what = format!("{what}: {found} samples where {expected} are expected");
    let remedy = "arrays of equal length; --samples-are if rows and columns are exchanged";
    ReadError::Lengths(Fault::new(what, place, remedy))
}
