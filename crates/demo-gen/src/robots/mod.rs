//! Demonstrations with robots.

pub(crate) mod hand;
pub(crate) mod hand_in_plane;
pub(crate) mod limits;
pub(crate) mod three_link_arm;
pub(crate) mod upper_body;
