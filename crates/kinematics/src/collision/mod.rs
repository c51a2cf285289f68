//! Self-collision: which links overlap ([`SelfCollision`]), from bodies of one link each (`body`), capsules (`round`)
//! by closed form (`segment`), everything else by a library (`parry`); pairs left out by an SRDF (`srdf`); and which
//! are near each other, and which way apart is (`nearby`).

mod body;
mod mesh;
mod nearby;
mod parry;
mod round;
mod segment;
mod srdf;

use std::sync::Arc;

use body::Body;
pub use mesh::MeshShape;
use nalgebra::DVector;
pub use nearby::Nearby;
use parry::PlacedShape;

use crate::{CollisionShape, Geometry, KinematicsError, LinkId, LinkPoses, RobotModel, Workspace, model::find_link};

/// The collision shapes of one robot, and the pairs of links that must not touch.
///
/// Left out from the start: links that cannot move against each other (joined by fixed joints), and links joined by
/// one moving joint. Links without shapes do not count as something in between: a hand and a forearm with a wrist of
/// three axes between them are a pair, until [`SelfCollision::disable`] or an SRDF says otherwise.
#[derive(Debug, Clone)]
pub struct SelfCollision {
    links: Arc<[String]>,
    bodies: Vec<Body>,
    /// Places in `bodies`, the first smaller than the second.
    pairs: Vec<(usize, usize)>,
}

/// The narrowest place between two links that must not touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// The distance in metres; 0 where the links touch or overlap.
    pub distance: f64,
    /// The two links.
    pub links: (LinkId, LinkId),
}

impl SelfCollision {
    /// Takes the robot's collision shapes. `meshes` is asked once for each mesh, by the file name in the URDF; what it
    /// does not know is an error, what should not count is [`MeshShape::LeftOut`].
    ///
    /// # Errors
    /// [`KinematicsError::Urdf`] for a faulty `<collision>`, [`KinematicsError::MissingMeshes`] with all that are
    /// missing, or [`KinematicsError::BadMesh`].
    pub fn new(robot: &RobotModel, mut meshes: impl FnMut(&str) -> Option<MeshShape>) -> Result<Self, KinematicsError> {
        let shapes = robot.collision_shapes()?;
        let mut missing = Vec::new();
        let mut resolve = |shape: &CollisionShape| resolved(robot, shape, &mut meshes, &mut missing);
        let mut bodies = Vec::new();
        for link in robot.links() {
            let of_link: Vec<&CollisionShape> = shapes.iter().filter(|shape| shape.link == link).collect();
            bodies.extend(Body::new(link, &of_link, &mut resolve)?);
        }
        if !missing.is_empty() {
            return Err(KinematicsError::MissingMeshes { meshes: missing });
        }
        let pairs = free_pairs(robot, &bodies);
        Ok(SelfCollision { links: Arc::clone(&robot.links), bodies, pairs })
    }

    /// Lets two links overlap.
    ///
    /// # Errors
    /// [`KinematicsError::UnknownLink`].
    pub fn disable(&mut self, first: &str, second: &str) -> Result<(), KinematicsError> {
        let (first, second) = (find_link(first, &self.links)?, find_link(second, &self.links)?);
        let link = |body: usize| self.bodies[body].link;
        self.pairs.retain(|&(a, b)| (link(a), link(b)) != (first, second) && (link(a), link(b)) != (second, first));
        Ok(())
    }

    /// Lets all pairs overlap that the text of an SRDF names in `disable_collisions`; everything else in it is passed
    /// over.
    ///
    /// # Errors
    /// [`KinematicsError::NotXml`], [`KinematicsError::Urdf`] or [`KinematicsError::UnknownLink`]; no pair is let
    /// overlap then.
    pub fn disable_srdf(&mut self, text: &str) -> Result<(), KinematicsError> {
        let disabled = srdf::disabled_pairs(text, &self.links)?;
        self.pairs.retain(|&(a, b)| !disabled.contains(&(self.bodies[a].link, self.bodies[b].link)));
        Ok(())
    }

    /// The pairs of links that must not touch.
    pub fn pairs(&self) -> impl Iterator<Item = (LinkId, LinkId)> {
        self.pairs.iter().map(|&(a, b)| (self.bodies[a].link, self.bodies[b].link))
    }

    /// Whether any pair touches. Allocates nothing. `poses` are of the robot that this was made for.
    pub fn collides(&self, poses: &LinkPoses<'_>) -> bool {
        self.pairs.iter().any(|&(a, b)| self.bodies[a].touches(&self.bodies[b], poses))
    }

    /// All pairs that touch.
    pub fn colliding_pairs(&self, poses: &LinkPoses<'_>) -> Vec<(LinkId, LinkId)> {
        let touching = self.pairs.iter().filter(|(a, b)| self.bodies[*a].touches(&self.bodies[*b], poses));
        touching.map(|&(a, b)| (self.bodies[a].link, self.bodies[b].link)).collect()
    }

    /// The narrowest place; `None` where no pair is left.
    pub fn clearance(&self, poses: &LinkPoses<'_>) -> Option<Clearance> {
        let mut narrowest: Option<Clearance> = None;
        for &(a, b) in &self.pairs {
            let (a, b) = (&self.bodies[a], &self.bodies[b]);
            let best = narrowest.map_or(f64::INFINITY, |narrowest| narrowest.distance);
            if a.distance_bound(b, poses) < best {
                let distance = a.distance(b, poses);
                if distance < best {
                    narrowest = Some(Clearance { distance, links: (a.link, b.link) });
                }
            }
        }
        narrowest
    }

    /// All pairs that touch while every coordinate is 0: as a rule links that overlap by construction and belong on
    /// the list of an SRDF.
    pub fn colliding_at_zero(&self, robot: &RobotModel) -> Vec<(LinkId, LinkId)> {
        let mut workspace = Workspace::new();
        let zero = DVector::zeros(robot.n_joints());
        let poses = robot.forward_kinematics(zero.as_view(), &mut workspace).expect("zeros are a configuration");
        self.colliding_pairs(&poses)
    }
}

/// The shape of a mesh; one that is not there is noted.
fn resolved(
    robot: &RobotModel,
    shape: &CollisionShape,
    meshes: &mut impl FnMut(&str) -> Option<MeshShape>,
    missing: &mut Vec<(String, String)>,
) -> Result<Option<PlacedShape>, KinematicsError> {
    let Geometry::Mesh { filename, scale } = &shape.geometry else { return Ok(None) };
    let link = robot.link_name(shape.link).to_owned();
    let Some(mesh) = meshes(filename) else {
        missing.push((link, filename.clone()));
        return Ok(None);
    };
    let bad = |reason| KinematicsError::BadMesh { link, filename: filename.clone(), reason };
    PlacedShape::mesh(mesh, scale, &shape.origin).map_err(bad)
}

/// All pairs of bodies that can move against each other and are not joined by one joint.
fn free_pairs(robot: &RobotModel, bodies: &[Body]) -> Vec<(usize, usize)> {
    // Every link's group: the uppermost link that it is fixed to.
    let mut groups: Vec<usize> = (0..robot.nodes.len()).collect();
    for (index, node) in robot.nodes.iter().enumerate().skip(1) {
        if node.coupling.is_none() {
            groups[index] = groups[node.parent];
        }
    }
    let group = |body: usize| groups[bodies[body].link.0];
    let carrier = |group: usize| groups[robot.nodes[group].parent];
    let all = (0..bodies.len()).flat_map(|a| (a + 1..bodies.len()).map(move |b| (a, b)));
    all.filter(|&(a, b)| group(a) != group(b) && carrier(group(b)) != group(a) && carrier(group(a)) != group(b))
        .collect()
}
