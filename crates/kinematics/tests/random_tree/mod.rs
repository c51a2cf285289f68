//! Random robots: trees with every kind of joint, oblique axes, any origins, and mimic chains, in any document order.

use std::fmt::Write;

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use proptest::prelude::*;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
}

/// Limb i carries link i + 1; link 0 is the root.
#[derive(Debug, Clone)]
pub(crate) struct Limb {
    pub(crate) parent: usize,
    kind: Kind,
    axis: [f64; 3],
    xyz: [f64; 3],
    rpy: [f64; 3],
    /// The followed limb, multiplier and offset.
    mimic: Option<(usize, f64, f64)>,
}

#[derive(Debug, Clone)]
pub(crate) struct RandomTree {
    pub(crate) limbs: Vec<Limb>,
    /// Limbs in document order.
    order: Vec<usize>,
}

fn vector(range: f64) -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        1 => Just([0.0; 3]),
        3 => [-range..range, -range..range, -range..range],
    ]
}

fn axis() -> impl Strategy<Value = [f64; 3]> {
    let along = (0..3_usize, prop_oneof![Just(1.0), Just(-1.0), Just(2.5)]);
    prop_oneof![
        along.prop_map(|(i, length)| std::array::from_fn(|j| if i == j { length } else { 0.0 })),
        [-1.0..1.0, -1.0..1.0, 0.1..1.0_f64],
    ]
}

fn limb(index: usize) -> impl Strategy<Value = Limb> {
    let kind = prop_oneof![Just(Kind::Fixed), Just(Kind::Revolute), Just(Kind::Continuous), Just(Kind::Prismatic)];
    let mimic = proptest::option::weighted(0.3, (0..index.max(1), -2.0..2.0, -1.0..1.0));
    (0..=index, kind, axis(), vector(1.0), vector(3.2), mimic).prop_map(move |(parent, kind, axis, xyz, rpy, mimic)| {
        Limb { parent, kind, axis, xyz, rpy, mimic: mimic.filter(|_| index > 0) }
    })
}

/// Trees of 1 to 12 limbs.
pub(crate) fn tree() -> impl Strategy<Value = RandomTree> {
    let limbs = (1..=12_usize).prop_flat_map(|n| (0..n).map(limb).collect::<Vec<_>>());
    limbs
        .prop_map(|mut limbs| {
            for i in 0..limbs.len() {
                let follows_fixed = limbs[i].mimic.is_some_and(|(target, ..)| limbs[target].kind == Kind::Fixed);
                if follows_fixed {
                    limbs[i].mimic = None;
                }
            }
            limbs
        })
        .prop_flat_map(|limbs| {
            let order = Just((0..limbs.len()).collect::<Vec<_>>()).prop_shuffle();
            (Just(limbs), order)
        })
        .prop_map(|(limbs, order)| RandomTree { limbs, order })
}

impl RandomTree {
    pub(crate) fn urdf(&self) -> String {
        let mut text = String::from("<robot name=\"random\">");
        for &i in &self.order {
            let Limb { parent, kind, axis, xyz, rpy, mimic } = &self.limbs[i];
            let kind = format!("{kind:?}").to_lowercase();
            let numbers = |v: &[f64; 3]| format!("{:?} {:?} {:?}", v[0], v[1], v[2]);
            write!(
                text,
                r#"<joint name="j{i}" type="{kind}"><axis xyz="{}"/><limit lower="-1.5" upper="2" effort="1" velocity="1"/>
                   <origin xyz="{}" rpy="{}"/><child link="l{}"/><parent link="l{parent}"/>"#,
                numbers(axis),
                numbers(xyz),
                numbers(rpy),
                i + 1,
            )
            .expect("a string takes any text");
            if let Some((target, multiplier, offset)) = mimic {
                write!(text, r#"<mimic joint="j{target}" multiplier="{multiplier:?}" offset="{offset:?}"/>"#)
                    .expect("a string takes any text");
            }
            // Links with different masses and centres off their frames.
            let mass = 0.5 + i as f64;
            write!(
                text,
                r#"</joint><link name="l{}"><inertial><origin xyz="0.1 -0.2 0.05" rpy="{i} 0.4 -0.3"/><mass value="{mass:?}"/>
                   <inertia ixx="0.03" ixy="0.01" ixz="-0.002" iyy="0.02" iyz="0.004" izz="0.04"/></inertial></link>"#,
                i + 1
            )
            .expect("a string takes any text");
        }
        text + "<link name=\"l0\"/></robot>"
    }

    /// Limbs that have a coordinate, in the order of the coordinates.
    pub(crate) fn active(&self) -> Vec<usize> {
        let is_active = |&i: &usize| self.limbs[i].kind != Kind::Fixed && self.limbs[i].mimic.is_none();
        self.order.iter().copied().filter(is_active).collect()
    }

    /// The value of a limb's joint.
    fn value(&self, limb: usize, q: &[f64]) -> f64 {
        match self.limbs[limb].mimic {
            Some((target, multiplier, offset)) => multiplier * self.value(target, q) + offset,
            None => q[self.coordinate_of(limb).expect("the limb moves")],
        }
    }

    /// The coordinate that ultimately moves a limb.
    pub(crate) fn coordinate_of(&self, limb: usize) -> Option<usize> {
        match self.limbs[limb].mimic {
            Some((target, ..)) if self.limbs[limb].kind != Kind::Fixed => self.coordinate_of(target),
            _ => self.active().iter().position(|&i| i == limb),
        }
    }

    /// The literal formula: the parent's pose, then the origin, then the motion.
    pub(crate) fn pose(&self, link: usize, q: &[f64]) -> Isometry3<f64> {
        let Some(limb) = link.checked_sub(1) else { return Isometry3::identity() };
        let Limb { parent, kind, axis, xyz, rpy: [roll, pitch, yaw], .. } = self.limbs[limb];
        let origin =
            Isometry3::from_parts(Translation3::from(xyz), UnitQuaternion::from_euler_angles(roll, pitch, yaw));
        let axis = Unit::new_normalize(Vector3::from(axis));
        let motion = match kind {
            Kind::Fixed => Isometry3::identity(),
            Kind::Prismatic => Translation3::from(axis.into_inner() * self.value(limb, q)).into(),
            Kind::Revolute | Kind::Continuous => Isometry3::from_parts(
                Translation3::identity(),
                UnitQuaternion::from_axis_angle(&axis, self.value(limb, q)),
            ),
        };
        self.pose(parent, q) * origin * motion
    }
}
