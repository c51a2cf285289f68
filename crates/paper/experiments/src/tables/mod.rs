//! The experiments, one file for each table or figure.

pub(crate) mod asimo22;
pub(crate) mod beyond;
pub(crate) mod constraints;
pub(crate) mod figure6;
pub(crate) mod figure9;
pub(crate) mod readings;
pub(crate) mod table1;
pub(crate) mod table2;
pub(crate) mod three_link;
