//! Drawing tools that all pictures use.

pub(crate) mod canvas;
pub(crate) mod dashes;
pub(crate) mod elements;
pub(crate) mod raster;
pub(crate) mod samples;
pub(crate) mod sheet;
pub(crate) mod smooth;
pub(crate) mod style;
pub(crate) mod style_sheet;
pub(crate) mod theme;
pub(crate) mod turned;
