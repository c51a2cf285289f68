//! Mimic joints: chains of "follows" resolved down to the joint that a configuration really holds.

use std::collections::HashMap;

use crate::{
    KinematicsError,
    names::near_names,
    urdf::{Element, Freedom, Mimic, UrdfJoint, UrdfProblem},
    workspace::Motor,
};

/// For each joint of the file how it gets its value, `None` for fixed joints. Columns count the active joints (those
/// that move and follow nobody) in document order.
pub(crate) fn motors(joints: &[UrdfJoint]) -> Result<Vec<Option<Motor>>, KinematicsError> {
    let by_name: HashMap<&str, usize> = joints.iter().enumerate().map(|(i, joint)| (joint.name.as_str(), i)).collect();
    let mut column = 0;
    let columns: Vec<Option<usize>> = joints
        .iter()
        .map(|joint| {
            is_active(joint).then(|| {
                column += 1;
                column - 1
            })
        })
        .collect();
    joints
        .iter()
        .enumerate()
        .map(|(start, joint)| match &joint.freedom {
            Freedom::Fixed => Ok(None),
            Freedom::Moving { .. } => resolve(start, joints, &by_name, &columns).map(Some),
        })
        .collect()
}

pub(crate) fn is_active(joint: &UrdfJoint) -> bool {
    matches!(joint.freedom, Freedom::Moving { mimic: None, .. })
}

/// Follows the chain from one joint: q = m₁(m₂(… q_active …) + o₂) + o₁.
fn resolve(
    start: usize,
    joints: &[UrdfJoint],
    by_name: &HashMap<&str, usize>,
    columns: &[Option<usize>],
) -> Result<Motor, KinematicsError> {
    let (mut at, mut multiplier, mut offset) = (start, 1.0, 0.0);
    let mut steps = 0;
    while let Freedom::Moving { mimic: Some(mimic), .. } = &joints[at].freedom {
        offset += multiplier * mimic.offset;
        multiplier *= mimic.multiplier;
        at = target(&joints[at], mimic, joints, by_name)?;
        steps += 1;
        if steps > joints.len() {
            return Err(ring(at, joints, by_name));
        }
    }
    let column = columns[at].expect("a mimic chain ends at an active joint");
    Ok(Motor { column, multiplier, offset })
}

/// Names the ring that a joint is part of, from its first joint in the file.
fn ring(member: usize, joints: &[UrdfJoint], by_name: &HashMap<&str, usize>) -> KinematicsError {
    let follows = |at: usize| match &joints[at].freedom {
        Freedom::Moving { mimic: Some(mimic), .. } => by_name[mimic.target.as_str()],
        _ => unreachable!("every joint of a ring follows another"),
    };
    let members = std::iter::successors(Some(follows(member)), |&at| (at != member).then(|| follows(at)));
    let first = members.min().expect("a ring has a member");
    let rest = std::iter::successors(Some(follows(first)), |&at| (at != first).then(|| follows(at)));
    let path: Vec<String> = std::iter::once(first).chain(rest).map(|joint| joints[joint].name.clone()).collect();
    KinematicsError::urdf(Element::Joint(path[0].clone()), UrdfProblem::MimicCycle { path })
}

fn target(
    joint: &UrdfJoint,
    mimic: &Mimic,
    joints: &[UrdfJoint],
    by_name: &HashMap<&str, usize>,
) -> Result<usize, KinematicsError> {
    let target = mimic.target.clone();
    let problem = match by_name.get(target.as_str()) {
        Some(&index) if matches!(joints[index].freedom, Freedom::Fixed) => UrdfProblem::MimicOfFixed { target },
        Some(&index) => return Ok(index),
        None => {
            let near = near_names(&target, joints.iter().map(|joint| joint.name.as_str()));
            UrdfProblem::MimicTarget { target, near }
        }
    };
    Err(KinematicsError::urdf(Element::Joint(joint.name.clone()), problem))
}
