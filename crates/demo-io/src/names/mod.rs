//! Names: their order, and patterns that match them.

pub(crate) mod columns;
pub(crate) mod natural;
pub(crate) mod selection;
