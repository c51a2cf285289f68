use crate::{
    KinematicsError,
    urdf::{
        self, Element,
        tag::{Tag, children},
    },
};

/// The pairs of links that the text of an SRDF disables.
pub(super) fn disabled_pairs(text: &str) -> Result<Vec<(String, String)>, KinematicsError> {
    urdf::parsed(text, |robot| {
        let pair = |node| {
            let tag = Tag { node, owner: &Element::Robot };
            Ok((tag.text("disable_collisions.link1")?, tag.text("disable_collisions.link2")?))
        };
        children(robot, "disable_collisions").map(pair).collect()
    })
}
