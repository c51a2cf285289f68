//! Mimic joints: resolves chains of followed joints down to the active joint.

use std::collections::HashMap;

use crate::{
    KinematicsError,
    names::near_names,
    nodes::Coupling,
    urdf::{Element, Mimic, UrdfJoint, UrdfMotion, UrdfProblem, bounded},
};

/// For each joint of the file, how its value depends on the configuration; `None` for fixed joints. Columns count the
/// active joints (those that move and follow no other) in document order.
pub(crate) fn couplings(joints: &[UrdfJoint]) -> Result<Vec<Option<Coupling>>, KinematicsError> {
    let by_name: HashMap<&str, usize> = joints.iter().enumerate().map(|(i, joint)| (joint.name.as_str(), i)).collect();
    let mut couplings = vec![None; joints.len()];
    for (column, joint) in (0..joints.len()).filter(|&joint| is_active(&joints[joint])).enumerate() {
        couplings[joint] = Some(Coupling { column, multiplier: 1.0, offset: 0.0 });
    }
    for (start, joint) in joints.iter().enumerate() {
        if matches!(joint.motion, UrdfMotion::Moving { .. }) {
            resolve(start, joints, &by_name, &mut couplings)?;
        }
    }
    Ok(couplings)
}

pub(crate) fn is_active(joint: &UrdfJoint) -> bool {
    matches!(joint.motion, UrdfMotion::Moving { mimic: None, .. })
}

/// Finds the couplings of a joint and of all joints that it follows: q = m₁(m₂(… `q_active` …) + o₂) + o₁. Results are
/// cached, so that the time is linear in the length of a chain.
fn resolve(
    start: usize,
    joints: &[UrdfJoint],
    by_name: &HashMap<&str, usize>,
    couplings: &mut [Option<Coupling>],
) -> Result<(), KinematicsError> {
    let mut followers = Vec::new();
    let mut at = start;
    while couplings[at].is_none() {
        if followers.len() == joints.len() {
            return Err(ring(at, joints, by_name));
        }
        followers.push(at);
        at = target(&joints[at], joints, by_name)?;
    }
    let mut coupling = couplings[at].expect("the loop ends at a coupling");
    for follower in followers.into_iter().rev() {
        let Mimic { multiplier, offset, .. } = mimic(&joints[follower]);
        let total = |attribute, value| bounded(attribute, value).map_err(|problem| joints[follower].error(problem));
        coupling = Coupling {
            column: coupling.column,
            multiplier: total("mimic.multiplier", multiplier * coupling.multiplier)?,
            offset: total("mimic.offset", multiplier * coupling.offset + offset)?,
        };
        couplings[follower] = Some(coupling);
    }
    Ok(())
}

/// The followed joint of a joint that has no coupling yet.
fn mimic(joint: &UrdfJoint) -> &Mimic {
    match &joint.motion {
        UrdfMotion::Moving { mimic: Some(mimic), .. } => mimic,
        _ => unreachable!("a joint that moves and follows nobody has a coupling"),
    }
}

/// The error for a cycle of mimic joints that contains a joint, starting with its first joint in the file.
fn ring(member: usize, joints: &[UrdfJoint], by_name: &HashMap<&str, usize>) -> KinematicsError {
    let follows = |at: usize| by_name[mimic(&joints[at]).target.as_str()];
    let members = std::iter::successors(Some(follows(member)), |&at| (at != member).then(|| follows(at)));
    let first = members.min().expect("a ring has a member");
    let rest = std::iter::successors(Some(follows(first)), |&at| (at != first).then(|| follows(at)));
    let path: Vec<String> = std::iter::once(first).chain(rest).map(|joint| joints[joint].name.clone()).collect();
    KinematicsError::urdf(Element::Joint(path[0].clone()), UrdfProblem::MimicCycle { path })
}

fn target(joint: &UrdfJoint, joints: &[UrdfJoint], by_name: &HashMap<&str, usize>) -> Result<usize, KinematicsError> {
    let target = mimic(joint).target.clone();
    let problem = match by_name.get(target.as_str()) {
        Some(&index) if matches!(joints[index].motion, UrdfMotion::Fixed) => UrdfProblem::MimicOfFixed { target },
        Some(&index) => return Ok(index),
        None => {
            let near = near_names(&target, joints.iter().map(|joint| joint.name.as_str()));
            UrdfProblem::MimicTarget { target, near }
        }
    };
    Err(joint.error(problem))
}
