use nalgebra::{DVector, Matrix3xX, Point3, UnitVector3};

use super::{
    SelfCollision,
    body::{Body, Placed},
    parry::{self, Contact},
};
use crate::{LinkId, LinkPoses};

/// Two links that must not touch and are near each other: where, how far apart, and the direction that separates them.
///
/// Shapes other than meshes are solid; their distances are exact to 5e-5 m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearby {
    /// The two links.
    pub links: (LinkId, LinkId),
    /// Their distance in metres; if they overlap, minus the shortest displacement that separates them.
    pub distance: f64,
    /// Their points nearest to each other (or deepest inside), in the root link's frame, metres.
    pub points: (Point3<f64>, Point3<f64>),
    /// The direction in which the second link moves away from the first, in root axes.
    pub normal: UnitVector3<f64>,
}

impl Nearby {
    /// Gradient of the distance with respect to the coordinates, (n), in metres per unit of each joint: nᵀ(J₂ − J₁) with
    /// the Jacobians of the two points. `poses` are those for which the pair was found.
    pub fn gradient(&self, poses: &LinkPoses<'_>) -> DVector<f64> {
        let n = poses.robot().n_joints();
        let [mut first, mut second] = [Matrix3xX::zeros(n), Matrix3xX::zeros(n)];
        poses.fill_at::<3>(self.links.0, &self.points.0, first.as_mut_slice());
        poses.fill_at::<3>(self.links.1, &self.points.1, second.as_mut_slice());
        (second - first).tr_mul(&*self.normal)
    }
}

impl SelfCollision {
    /// All pairs of links nearer to each other than `within` (metres), including overlapping ones; each pair at its
    /// smallest distance.
    ///
    /// Provides a gradient for controllers that keep links apart: unlike [`SelfCollision::clearance`] it continues below
    /// 0 and includes the separating direction. Pairs for which the collision library finds no separating direction are
    /// omitted.
    pub fn nearby(&self, poses: &LinkPoses<'_>, within: f64) -> Vec<Nearby> {
        let pairs = self.pairs.iter().map(|&(a, b)| (&self.bodies[a], &self.bodies[b]));
        pairs.filter_map(|(a, b)| a.nearby(b, poses, within)).collect()
    }
}

impl Body {
    fn nearby(&self, other: &Self, poses: &LinkPoses<'_>, within: f64) -> Option<Nearby> {
        if self.distance_bound(other, poses) >= within {
            return None;
        }
        let (here, there) = (Placed::new(self, poses), Placed::new(other, poses));
        let pairs = self.solids.iter().flat_map(|a| other.solids.iter().map(move |b| (a, b)));
        let contacts =
            pairs.filter_map(|(a, b)| parry::contact((a.shape(), &here.pose), (b.shape(), &there.pose), within));
        let Contact { distance, points, normal } = contacts.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        (distance < within).then_some(Nearby { links: (self.link, other.link), distance, points, normal })
    }
}
