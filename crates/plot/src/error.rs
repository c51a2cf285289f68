use thiserror::Error;

/// Why a picture cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PlotError {
    /// A field has fewer than two places along an axis.
    #[error("a field has {places} place(s) along {axis}; give two or more")]
    FieldPlaces {
        /// "x" or "y".
        axis: &'static str,
        /// How many there are.
        places: usize,
    },
    /// A field has not one row of values for each place along y.
    #[error("a field has {found} row(s) of values for {expected} places along y; give one for each")]
    FieldRows {
        /// How many there are.
        found: usize,
        /// How many places there are.
        expected: usize,
    },
    /// A row of a field has not one value for each place along x.
    #[error("row {row} of a field has {found} value(s) for {expected} places along x; give one for each")]
    FieldRow {
        /// Which row, counted from 0.
        row: usize,
        /// How many values it has.
        found: usize,
        /// How many places there are.
        expected: usize,
    },
    /// The plotting crate cannot turn it into pixels.
    #[error("a picture cannot be turned into pixels: {reason}; its SVG can be had all the same")]
    Pixels {
        /// What the plotting crate says.
        reason: String,
    },
}
