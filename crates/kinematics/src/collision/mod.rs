//! Self-collision: finds overlapping links ([`SelfCollision`]). There is one body per link (`body`). Capsules
//! (`round`) have closed-form distances (`segment`); a library handles all other shapes (`parry`). An SRDF excludes
//! pairs (`srdf`). `nearby` finds links near each other, and the direction that separates them.

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
/// Excluded from the start are links that cannot move relative to each other (joined by fixed joints), and links
/// joined by one moving joint. Links without shapes do not change this: a hand and a forearm with a wrist of three
/// axes between them are a pair, unless [`SelfCollision::disable`] or an SRDF excludes it.
#[derive(Debug, Clone)]
pub struct SelfCollision {
    links: Arc<[String]>,
    bodies: Vec<Body>,
    /// Indices into `bodies`, the first smaller than the second.
    pairs: Vec<(usize, usize)>,
}

/// The smallest distance between two links that must not touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearance {
    /// The distance in metres; 0 if the links touch or overlap.
    pub distance: f64,
    /// The two links.
    pub links: (LinkId, LinkId),
}

impl SelfCollision {
    /// Takes the robot's collision shapes. `meshes` is called once for each mesh, with the file name in the URDF. A
    /// mesh for which it returns `None` is an error; a mesh to be excluded is [`MeshShape::LeftOut`].
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

    /// Allows two links to overlap.
    ///
    /// # Errors
    /// [`KinematicsError::UnknownLink`].
    pub fn disable(&mut self, first: &str, second: &str) -> Result<(), KinematicsError> {
        let (first, second) = (find_link(first, &self.links)?, find_link(second, &self.links)?);
        let link = |body: usize| self.bodies[body].link;
        self.pairs.retain(|&(a, b)| (link(a), link(b)) != (first, second) && (link(a), link(b)) != (second, first));
        Ok(())
    }

    /// Allows all pairs to overlap that the text of an SRDF lists in `disable_collisions`; everything else in it is
    /// ignored.
    ///
    /// # Errors
    /// [`KinematicsError::NotXml`], [`KinematicsError::Urdf`] or [`KinematicsError::UnknownLink`]; then no pair is
    /// excluded.
    pub fn disable_srdf(&mut self, text: &str) -> Result<(), KinematicsError> {
        let disabled = srdf::disabled_pairs(text, &self.links)?;
        self.pairs.retain(|&(a, b)| !disabled.contains(&(self.bodies[a].link, self.bodies[b].link)));
        Ok(())
    }

    /// The pairs of links that must not touch.
    pub fn pairs(&self) -> impl Iterator<Item = (LinkId, LinkId)> {
        self.pairs.iter().map(|&(a, b)| (self.bodies[a].link, self.bodies[b].link))
    }

    /// Whether any pair touches. Does not allocate. `poses` must be those of the robot for which this was built.
    pub fn collides(&self, poses: &LinkPoses<'_>) -> bool {
        self.pairs.iter().any(|&(a, b)| self.bodies[a].touches(&self.bodies[b], poses))
    }

    /// All pairs that touch.
    pub fn colliding_pairs(&self, poses: &LinkPoses<'_>) -> Vec<(LinkId, LinkId)> {
        let touching = self.pairs.iter().filter(|(a, b)| self.bodies[*a].touches(&self.bodies[*b], poses));
        touching.map(|&(a, b)| (self.bodies[a].link, self.bodies[b].link)).collect()
    }

    /// The smallest clearance; `None` if no pair is left.
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

    /// All pairs that touch when every coordinate is 0: usually links that overlap by design and belong in an SRDF's
    /// list.
    pub fn colliding_at_zero(&self, robot: &RobotModel) -> Vec<(LinkId, LinkId)> {
        let mut workspace = Workspace::new();
        let zero = DVector::zeros(robot.n_joints());
        let poses = robot.forward_kinematics(zero.as_view(), &mut workspace).expect("zeros are a configuration");
        self.colliding_pairs(&poses)
    }
}

/// The shape of a mesh; a missing mesh is recorded.
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
    // The group of every link: the topmost link to which it is fixed.
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
