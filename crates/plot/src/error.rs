use thiserror::Error;

/// Why a picture cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PlotError {
    /// The plotting crate cannot turn it into pixels.
    #[error("a picture cannot be turned into pixels: {reason}; its SVG can be had all the same")]
    Pixels {
        /// What the plotting crate says.
        reason: String,
    },
}
