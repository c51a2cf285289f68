//! Files of arrays: descriptions, which are read first, and the roles of the arrays.

pub(crate) mod array;
pub(crate) mod demo;
pub(crate) mod fields;
pub(crate) mod flat;
pub(crate) mod grouped;
#[cfg(feature = "hdf5")]
pub(crate) mod hdf5;
pub(crate) mod layout;
#[cfg(feature = "mat")]
pub(crate) mod mat;
pub(crate) mod npy;
pub(crate) mod npz;
mod reader;
mod within;
