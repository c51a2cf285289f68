use roxmltree::Node;

use super::{
    Element, UrdfProblem,
    number::{self, bounded},
};
use crate::KinematicsError;

/// A tag inside a link or joint, with its owner.
#[derive(Clone, Copy)]
pub(crate) struct Tag<'a> {
    pub(crate) node: Node<'a, 'a>,
    pub(crate) owner: &'a Element,
}

impl Tag<'_> {
    pub(crate) fn error(&self, problem: UrdfProblem) -> KinematicsError {
        KinematicsError::urdf(self.owner.clone(), problem)
    }

    /// The N numbers of an attribute, or `None` if the attribute is missing. `name` is `tag.attribute`.
    pub(crate) fn numbers<const N: usize>(&self, name: &'static str) -> Result<Option<[f64; N]>, KinematicsError> {
        let Some(text) = self.node.attribute(attribute_of(name)) else { return Ok(None) };
        let numbers: Vec<f64> = text
            .split_whitespace()
            .map(|word| finite(name, word).map_err(|problem| self.error(problem)))
            .collect::<Result<_, _>>()?;
        let found = numbers.len();
        let numbers = <[f64; N]>::try_from(numbers)
            .map_err(|_| self.error(UrdfProblem::NumberCount { attribute: name, found, expected: N }))?;
        Ok(Some(numbers))
    }

    /// [`Tag::numbers`] for lengths, angles or factors, which must be bounded.
    pub(crate) fn bounded<const N: usize>(&self, name: &'static str) -> Result<Option<[f64; N]>, KinematicsError> {
        let numbers = self.numbers::<N>(name)?;
        let checked = numbers.map(|numbers| number::each(name, numbers, bounded)).transpose();
        checked.map_err(|problem| self.error(problem))
    }

    /// The single number of an attribute, or `None` if the attribute is missing. `name` is `tag.attribute`.
    pub(crate) fn number(&self, name: &'static str) -> Result<Option<f64>, KinematicsError> {
        Ok(self.numbers::<1>(name)?.map(|[number]| number))
    }

    /// A required attribute. `name` is `tag.attribute`.
    pub(crate) fn text(&self, name: &'static str) -> Result<String, KinematicsError> {
        let text = self.node.attribute(attribute_of(name));
        text.map(str::to_owned).ok_or_else(|| self.error(UrdfProblem::MissingAttribute { attribute: name }))
    }

    /// The first child tag of this name.
    pub(crate) fn child(&self, tag: &'static str) -> Option<Self> {
        children(self.node, tag).next().map(|node| Tag { node, owner: self.owner })
    }
}

/// The child elements of this name; elements of a foreign namespace do not count.
pub(crate) fn children<'a>(node: Node<'a, 'a>, tag: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    let space = node.tag_name().namespace();
    node.children().filter(move |child| child.tag_name().name() == tag && child.tag_name().namespace() == space)
}

fn attribute_of(name: &'static str) -> &'static str {
    name.rsplit('.').next().unwrap_or(name)
}

fn finite(attribute: &'static str, word: &str) -> Result<f64, UrdfProblem> {
    let number: f64 = word.parse().map_err(|_| UrdfProblem::Number { attribute, text: word.to_owned() })?;
    if number.is_finite() { Ok(number) } else { Err(UrdfProblem::NotFinite { attribute, text: word.to_owned() }) }
}

/// The name of a link or joint.
pub(super) fn name_of(
    node: Node<'_, '_>,
    unnamed: impl FnOnce() -> Element,
    attribute: &'static str,
) -> Result<String, KinematicsError> {
    match node.attribute("name") {
        Some(name) if !name.is_empty() => Ok(name.to_owned()),
        _ => Err(KinematicsError::urdf(unnamed(), UrdfProblem::MissingAttribute { attribute })),
    }
}
