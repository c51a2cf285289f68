//! Robots and their surroundings as 3-D scenes.

pub(crate) mod items;
pub(crate) mod legs;
pub(crate) mod shapes;
pub(crate) mod stage;
