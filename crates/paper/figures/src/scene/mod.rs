//! Robots and what is around them, to be drawn in space.

pub(crate) mod items;
pub(crate) mod legs;
pub(crate) mod shapes;
pub(crate) mod stage;
