//! Names: their order, and patterns of them.

pub(crate) mod columns;
pub(crate) mod natural;
pub(crate) mod selection;
