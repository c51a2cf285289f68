//! Pages and pictures of recordings and models.

pub(crate) mod check_page;
pub(crate) mod constraint_marks;
mod constraints_part;
mod error_map;
mod left_out_part;
mod movements;
mod numbers_table;
pub(crate) mod page_parts;
mod pairs;
pub(crate) mod picture;
pub(crate) mod trust_page;
