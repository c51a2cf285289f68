use nalgebra::{IsometryMatrix3, Vector3};
use roxmltree::Node;

use super::{
    Element, UrdfProblem, UrdfWarning, number, origin,
    tag::{Tag, children},
    version::Version,
};
use crate::KinematicsError;

/// A shape in its own frame, metres.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Geometry {
    /// A box about the origin.
    Box {
        /// Full lengths along x, y, z.
        size: Vector3<f64>,
    },
    /// A sphere about the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A cylinder about the origin, along z.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its full length.
        length: f64,
    },
    /// A cylinder about the origin, along z, with a half sphere at each end.
    Capsule {
        /// Its radius.
        radius: f64,
        /// Length of the cylinder alone.
        length: f64,
    },
    /// A mesh in a file.
    Mesh {
        /// The file, as the URDF names it.
        filename: String,
        /// Factors along x, y, z.
        scale: Vector3<f64>,
    },
}

/// One `<collision>` of a link; `link` counts in document order.
#[derive(Debug, Clone)]
pub(crate) struct UrdfCollision {
    pub(crate) link: usize,
    pub(crate) origin: IsometryMatrix3<f64>,
    pub(crate) geometry: Geometry,
}

/// All collision shapes of a link.
pub(super) fn read(
    node: Node<'_, '_>,
    link: usize,
    name: &str,
    version: Version,
    warnings: &mut Vec<UrdfWarning>,
) -> Result<Vec<UrdfCollision>, KinematicsError> {
    let owner = Element::Link(name.to_owned());
    children(node, "collision")
        .map(|node| {
            let collision = Tag { node, owner: &owner };
            let origin = origin::read(collision, version, warnings)?;
            let tag = "geometry";
            let geometry = collision.child(tag).ok_or_else(|| collision.error(UrdfProblem::MissingTag { tag }))?;
            Ok(UrdfCollision { link, origin, geometry: shape(geometry)? })
        })
        .collect()
}

fn shape(geometry: Tag<'_>) -> Result<Geometry, KinematicsError> {
    if let Some(shape) = geometry.child("box") {
        return Ok(Geometry::Box { size: Vector3::from(shape.sizes("box.size")?) });
    }
    if let Some(shape) = geometry.child("sphere") {
        return Ok(Geometry::Sphere { radius: shape.size("sphere.radius")? });
    }
    if let Some(shape) = geometry.child("cylinder") {
        return Ok(Geometry::Cylinder {
            radius: shape.size("cylinder.radius")?,
            length: shape.size("cylinder.length")?,
        });
    }
    if let Some(shape) = geometry.child("capsule") {
        return Ok(Geometry::Capsule { radius: shape.size("capsule.radius")?, length: shape.size("capsule.length")? });
    }
    if let Some(mesh) = geometry.child("mesh") {
        let scale = mesh.bounded::<3>("mesh.scale")?.unwrap_or([1.0; 3]);
        return Ok(Geometry::Mesh { filename: mesh.text("mesh.filename")?, scale: Vector3::from(scale) });
    }
    Err(geometry.error(UrdfProblem::UnknownShape))
}

impl Tag<'_> {
    fn size(&self, name: &'static str) -> Result<f64, KinematicsError> {
        self.sizes::<1>(name).map(|[size]| size)
    }

    /// Required lengths, which must not be negative.
    fn sizes<const N: usize>(&self, name: &'static str) -> Result<[f64; N], KinematicsError> {
        let missing = || self.error(UrdfProblem::MissingAttribute { attribute: name });
        let sizes = self.numbers::<N>(name)?.ok_or_else(missing)?;
        number::each(name, sizes, number::size).map_err(|problem| self.error(problem))
    }
}
