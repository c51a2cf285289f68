use nalgebra::{IsometryMatrix3, Matrix3};
use roxmltree::Node;

use super::{
    Element, UrdfProblem, UrdfWarning, number, origin,
    tag::{Tag, children},
    version::Version,
};
use crate::KinematicsError;

/// The `<inertial>` of a link; `link` counts in document order.
#[derive(Debug, Clone)]
pub(crate) struct UrdfInertial {
    pub(crate) link: usize,
    /// Centre of mass, and the axes of the tensor, in the link's frame.
    pub(crate) origin: IsometryMatrix3<f64>,
    pub(crate) mass: f64,
    pub(crate) tensor: Matrix3<f64>,
}

impl UrdfInertial {
    /// Checked numbers, with (ixx, ixy, ixz, iyy, iyz, izz) last; `None` for a link without mass.
    pub(super) fn of(
        link: usize,
        origin: IsometryMatrix3<f64>,
        mass: f64,
        moments: [f64; 6],
    ) -> Result<Option<UrdfInertial>, UrdfProblem> {
        let mass = number::bounded("mass.value", mass)?;
        if mass < 0.0 {
            return Err(UrdfProblem::NegativeMass { mass });
        }
        let [xx, xy, xz, yy, yz, zz] = number::each("inertia", moments, number::bounded)?;
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        Ok((mass > 0.0 || tensor.amax() > 0.0).then_some(UrdfInertial { link, origin, mass, tensor }))
    }
}

/// The inertial of a link, if it has one.
pub(super) fn read(
    node: Node<'_, '_>,
    link: usize,
    name: &str,
    version: Version,
    warnings: &mut Vec<UrdfWarning>,
) -> Result<Option<UrdfInertial>, KinematicsError> {
    let owner = Element::Link(name.to_owned());
    let Some(node) = children(node, "inertial").next() else { return Ok(None) };
    let inertial = Tag { node, owner: &owner };
    let origin = origin::read(inertial, version, warnings)?;
    let mass = inertial.child("mass").map(|mass| mass.number("mass.value")).transpose()?.flatten();
    let mut moments = [0.0; 6];
    if let Some(inertia) = inertial.child("inertia") {
        let names = ["inertia.ixx", "inertia.ixy", "inertia.ixz", "inertia.iyy", "inertia.iyz", "inertia.izz"];
        for (moment, name) in moments.iter_mut().zip(names) {
            *moment = inertia.number(name)?.unwrap_or(0.0);
        }
    }
    UrdfInertial::of(link, origin, mass.unwrap_or(0.0), moments).map_err(|problem| inertial.error(problem))
}
