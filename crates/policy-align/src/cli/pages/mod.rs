//! Pages and pictures of recordings and models.

pub(crate) mod check_page;
pub(crate) mod constraint_marks;
mod constraints_part;
pub(crate) mod page_parts;
pub(crate) mod picture;
pub(crate) mod trust_page;
