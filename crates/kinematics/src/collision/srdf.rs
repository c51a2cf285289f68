use std::collections::{HashMap, HashSet};

use crate::{
    KinematicsError, LinkId,
    model::unknown_link,
    urdf::{
        self, Element,
        tag::{Tag, children},
    },
};

/// The pairs of links that the text of an SRDF disables, each in both orders.
pub(super) fn disabled_pairs(text: &str, links: &[String]) -> Result<HashSet<(LinkId, LinkId)>, KinematicsError> {
    let by_name: HashMap<&str, LinkId> =
        links.iter().enumerate().map(|(index, name)| (name.as_str(), LinkId(index))).collect();
    let link = |tag: Tag<'_>, attribute| {
        let name = tag.text(attribute)?;
        by_name.get(name.as_str()).copied().ok_or_else(|| unknown_link(&name, links))
    };
    urdf::parsed(text, |robot| {
        let mut pairs = HashSet::new();
        for node in children(robot, "disable_collisions") {
            let tag = Tag { node, owner: &Element::Robot };
            let (first, second) = (link(tag, "disable_collisions.link1")?, link(tag, "disable_collisions.link2")?);
            pairs.extend([(first, second), (second, first)]);
        }
        Ok(pairs)
    })
}
