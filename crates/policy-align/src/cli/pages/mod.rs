//! Pages and pictures of recordings and models.

pub(crate) mod check_page;
mod constraints_part;
pub(crate) mod page_parts;
pub(crate) mod picture;
pub(crate) mod trust_page;
