use thiserror::Error;

/// The reason why a picture cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PlotError {
    /// A field has fewer than two grid points along an axis.
    #[error("a field has {places} place(s) along {axis}; give two or more")]
    FieldPlaces {
        /// "x" or "y".
        axis: &'static str,
        /// Number of grid points.
        places: usize,
    },
    /// The number of rows of a field differs from the number of grid points along y.
    #[error("a field has {found} row(s) of values for {expected} places along y; give one for each")]
    FieldRows {
        /// Number of rows.
        found: usize,
        /// Number of grid points.
        expected: usize,
    },
    /// The length of a row of a field differs from the number of grid points along x.
    #[error("row {row} of a field has {found} value(s) for {expected} places along x; give one for each")]
    FieldRow {
        /// Index of the row, from 0.
        row: usize,
        /// Number of values in the row.
        found: usize,
        /// Number of grid points.
        expected: usize,
    },
    /// The plotting crate cannot convert it to pixels.
    #[error("a picture cannot be turned into pixels: {reason}; its SVG can be had all the same")]
    Pixels {
        /// The plotting crate's message.
        reason: String,
    },
}
