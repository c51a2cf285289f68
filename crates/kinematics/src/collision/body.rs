use nalgebra::{Point3, Vector3};

use super::{
    parry::{self, LinkPose, PlacedShape},
    round::{as_capsule, whole_capsules},
    segment::Capsule,
};
use crate::{CollisionShape, KinematicsError, LinkId, LinkPoses};

/// A link with all its collision shapes.
#[derive(Debug, Clone)]
pub(super) struct Body {
    pub(super) link: LinkId,
    pub(super) solids: Vec<Solid>,
    /// A bounding sphere in the link's frame.
    centre: Point3<f64>,
    radius: f64,
}

#[derive(Debug, Clone)]
pub(super) enum Solid {
    /// Capsules and spheres, for which distances have a closed form; also kept as a library shape for
    /// distances to other shapes.
    Round(Capsule, PlacedShape),
    Other(PlacedShape),
}

impl Body {
    /// The body of one link's shapes; `mesh` converts a mesh. `None` if no shape is left.
    pub(super) fn new(
        link: LinkId,
        shapes: &[&CollisionShape],
        mut mesh: impl FnMut(&CollisionShape) -> Result<Option<PlacedShape>, KinematicsError>,
    ) -> Result<Option<Self>, KinematicsError> {
        let mut solids = Vec::new();
        for shape in whole_capsules(shapes) {
            match (as_capsule(&shape), PlacedShape::primitive(&shape.geometry, &shape.origin)) {
                (Some(capsule), Some(placed)) => solids.push(Solid::Round(capsule, placed)),
                (_, Some(placed)) => solids.push(Solid::Other(placed)),
                (_, None) => solids.extend(mesh(&shape)?.map(Solid::Other)),
            }
        }
        Ok(Self::around(link, solids))
    }

    fn around(link: LinkId, solids: Vec<Solid>) -> Option<Self> {
        let spheres: Vec<_> = solids.iter().map(|solid| solid.shape().bounding_sphere()).collect();
        let sum: Vector3<f64> = spheres.iter().map(|(centre, _)| centre.coords).sum();
        let centre = Point3::from(sum / spheres.len().max(1) as f64);
        let radius = spheres.iter().map(|(at, radius)| (at - centre).norm() + radius).reduce(f64::max)?;
        Some(Body { link, solids, centre, radius })
    }

    /// A lower bound of the distance between the two bodies; may be negative.
    pub(super) fn distance_bound(&self, other: &Self, poses: &LinkPoses<'_>) -> f64 {
        let centre = |body: &Self| poses.transform_point(body.link, &body.centre);
        (centre(self) - centre(other)).norm() - self.radius - other.radius
    }

    pub(super) fn touches(&self, other: &Self, poses: &LinkPoses<'_>) -> bool {
        self.distance_bound(other, poses) <= 0.0 && {
            let (here, there) = (Placed::new(self, poses), Placed::new(other, poses));
            self.solids.iter().any(|a| other.solids.iter().any(|b| here.touches(a, &there, b)))
        }
    }

    pub(super) fn distance(&self, other: &Self, poses: &LinkPoses<'_>) -> f64 {
        let (here, there) = (Placed::new(self, poses), Placed::new(other, poses));
        let pairs = self.solids.iter().flat_map(|a| other.solids.iter().map(move |b| (a, b)));
        pairs.map(|(a, b)| here.distance(a, &there, b)).fold(f64::INFINITY, f64::min)
    }
}

impl Solid {
    pub(super) fn shape(&self) -> &PlacedShape {
        match self {
            Solid::Round(_, shape) | Solid::Other(shape) => shape,
        }
    }
}

/// The pose of a body's link in one configuration.
pub(super) struct Placed<'a> {
    poses: &'a LinkPoses<'a>,
    link: LinkId,
    pub(super) pose: LinkPose,
}

impl<'a> Placed<'a> {
    pub(super) fn new(body: &Body, poses: &'a LinkPoses<'a>) -> Self {
        Placed { poses, link: body.link, pose: LinkPose::new(&poses.pose(body.link)) }
    }

    fn capsule(&self, capsule: &Capsule) -> Capsule {
        Capsule { ends: capsule.ends.map(|end| self.poses.transform_point(self.link, &end)), ..*capsule }
    }

    fn touches(&self, solid: &Solid, there: &Self, other: &Solid) -> bool {
        match (solid, other) {
            (Solid::Round(a, _), Solid::Round(b, _)) => self.capsule(a).distance(&there.capsule(b)) <= 0.0,
            _ => parry::touch((solid.shape(), &self.pose), (other.shape(), &there.pose)),
        }
    }

    fn distance(&self, solid: &Solid, there: &Self, other: &Solid) -> f64 {
        match (solid, other) {
            (Solid::Round(a, _), Solid::Round(b, _)) => self.capsule(a).distance(&there.capsule(b)).max(0.0),
            _ => parry::distance((solid.shape(), &self.pose), (other.shape(), &there.pose)),
        }
    }
}
