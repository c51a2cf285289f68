//! Parts of the robot that are only drawn, not simulated: eyes, and legs from the hips, which move with the trunk, to
//! the feet, which stay in place. The legs in the robot's file are stiff and serve as collision shapes.

use nalgebra::{IsometryMatrix3, Point3, Vector3};
use plot::{Item, Paint};
use serde::Serialize;

use crate::scene::shapes::{Kind, Shape, limbs, pose};

/// Length of thigh and shin, metres; knees bend a little when the robot stands. If a hip is farther from the ankle than
/// both bones reach, the bones are drawn apart by the missing length, and the round knee hides the gap.
pub(crate) const BONE: f64 = 0.265;

/// Eyes protrude from the head.
pub(crate) const EYE: Eye = Eye { radius: 0.022, aside: 0.38, up: 0.12 };

/// Metres; angles are relative to the direction of the face, to either side and up, radians.
#[derive(Serialize)]
pub(crate) struct Eye {
    radius: f64,
    aside: f64,
    up: f64,
}

/// The legs of a robot: the limbs of the link `heel`.
pub(crate) fn standing<Link: PartialEq>(shapes: &[Shape<Link>], heel: &Link) -> Vec<Leg> {
    let leg = |(cylinder, caps, ends): (usize, [usize; 2], [Point3<f64>; 2])| {
        let [ankle, hip] = if ends[0].z < ends[1].z { ends } else { [ends[1], ends[0]] };
        (shapes[cylinder].link == *heel).then(|| Leg {
            ankle,
            hip,
            radius: shapes[cylinder].size[0],
            parts: [cylinder, caps[0], caps[1]],
        })
    };
    limbs(shapes).into_iter().filter_map(leg).collect()
}

/// A leg as in the robot's file, metres in the heel's frame.
pub(crate) struct Leg {
    pub(crate) ankle: Point3<f64>,
    pub(crate) hip: Point3<f64>,
    pub(crate) radius: f64,
    /// Indices of its shapes.
    pub(crate) parts: [usize; 3],
}

impl Leg {
    /// Shin and thigh after this motion of the trunk.
    pub(crate) fn items(&self, trunk: &IsometryMatrix3<f64>, paint: Paint) -> [Item; 2] {
        let hip = trunk * self.hip;
        let knee = knee(&hip, &self.ankle);
        [[self.ankle, knee], [knee, hip]].map(|ends| Item::Capsule { ends, radius: self.radius, paint })
    }
}

/// The knee of a leg with two bones of equal length: in front of the line from hip to ankle, or on it if the bones are
/// too short.
pub(crate) fn knee(hip: &Point3<f64>, ankle: &Point3<f64>) -> Point3<f64> {
    let along = ankle - hip;
    let forward = (Vector3::x() - along * (along.x / along.norm_squared())).normalize();
    nalgebra::center(hip, ankle) + forward * (BONE * BONE - along.norm_squared() / 4.0).max(0.0).sqrt()
}

/// Eyes on a spherical head.
pub(crate) fn eyes(head: &Shape) -> Vec<Item> {
    let Eye { radius, aside, up } = EYE;
    let (Kind::Sphere, &[skull]) = (head.kind, &head.size[..]) else { return vec![] };
    let eye = |aside: f64| {
        let out = Vector3::new(up.cos() * aside.cos(), up.cos() * aside.sin(), up.sin()) * (skull - radius / 3.0);
        let centre = pose(&head.translation, &head.rotation) * Point3::from(out);
        Item::Ball { centre, radius, paint: Paint::opaque("#39434d") }
    };
    [-aside, aside].map(eye).into()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn bones_are_as_long_as_they_are_and_knees_bend_forwards(
            x in -0.2..0.2, y in -0.15..0.15, z in 0.3..0.7, aside in -0.1..0.1,
        ) {
            let (hip, ankle) = (Point3::new(x, y, z), Point3::new(0.05, aside, 0.08));
            let (knee, far) = (knee(&hip, &ankle), (hip - ankle).norm());
            let bones = [(knee - hip).norm(), (knee - ankle).norm()];
            prop_assert!((bones[0] - bones[1]).abs() < 1e-12);
            prop_assert!((bones[0] - BONE.max(far / 2.0)).abs() < 1e-12, "{bones:?}, {far} apart");
            prop_assert!(knee.x >= f64::midpoint(hip.x, ankle.x));
        }
    }
}
