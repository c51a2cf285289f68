//! Robots as items of a 3-D scene.

use nalgebra::{IsometryMatrix3, Point3, Vector3};
use plot::{Item, Paint};

use crate::scene::legs::{eyes, standing};
use crate::scene::shapes::{Kind, Shape, ends, limbs, pose};

/// Links that are drawn with additional parts.
const HEEL: &str = "heel";
const HEAD: &str = "head";

/// The shapes as items of a scene; the link determines the paint. A cylinder with a sphere at either end becomes a limb.
/// Legs bend according to the motion of the trunk from its pose at rest, and the head gets eyes.
pub(crate) fn items(shapes: &[Shape], trunk: &IsometryMatrix3<f64>, paint: impl Fn(&str) -> Paint) -> Vec<Item> {
    let limbs = limbs(shapes);
    let legs = standing(shapes, &HEEL.to_owned());
    let is_cap = |index: usize| limbs.iter().any(|(_, caps, _)| caps.contains(&index));
    let item = |(index, shape): (usize, &Shape)| {
        let paint = paint(&shape.link);
        let limb = limbs.iter().any(|(cylinder, ..)| *cylinder == index);
        let pose = pose(&shape.translation, &shape.rotation);
        match (shape.kind, &shape.size[..]) {
            _ if legs.iter().any(|leg| leg.parts.contains(&index)) => None,
            (Kind::Sphere, _) if is_cap(index) => None,
            (Kind::Sphere, &[radius]) => Some(Item::Ball { centre: pose * Point3::origin(), radius, paint }),
            (Kind::Cylinder, &[radius, length]) if limb => {
                Some(Item::Capsule { ends: ends(&pose, length), radius, paint })
            }
            (Kind::Cylinder, &[radius, length]) => Some(Item::Cylinder { ends: ends(&pose, length), radius, paint }),
            (Kind::Box, &[x, y, z]) => Some(Item::Block { pose, size: Vector3::new(x, y, z), paint }),
            _ => None,
        }
    };
    let drawn = shapes.iter().enumerate().filter_map(item);
    let legs = legs.iter().flat_map(|leg| leg.items(trunk, paint(HEEL)));
    let heads = shapes.iter().filter(|shape| shape.link == HEAD);
    drawn.chain(legs).chain(heads.flat_map(eyes)).collect()
}

#[cfg(test)]
mod tests {
    use experiments::upper_body;
    use kinematics::Workspace;

    use super::*;
    use crate::scene::shapes::posed;

    #[test]
    fn limbs_are_in_one_piece() {
        let body = upper_body().unwrap();
        let mut workspace = Workspace::new();
        let poses = body.robot().forward_kinematics(body.ready().as_view(), &mut workspace).unwrap();
        let shapes = posed(body.robot(), &poses).unwrap();
        let items = items(&shapes, &IsometryMatrix3::identity(), |_| Paint::opaque("#ffffff"));
        let count = |is: fn(&Item) -> bool| items.iter().filter(|item| is(item)).count();
        // Capsules: two shins and thighs, two upper arms, two forearms. Balls: head and eyes. Cylinder: the neck. Blocks:
        // feet, body in three, hands.
        assert_eq!(count(|item| matches!(item, Item::Capsule { .. })), 8);
        assert_eq!(count(|item| matches!(item, Item::Ball { .. })), 3);
        assert_eq!(count(|item| matches!(item, Item::Cylinder { .. })), 1);
        assert_eq!(count(|item| matches!(item, Item::Block { .. })), 7);
        assert_eq!(items.len(), 19);
    }
}
