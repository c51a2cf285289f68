//! Links and joints as a tree, ordered so that parents come first.

use std::collections::HashMap;

use crate::{
    KinematicsError,
    names::near_names,
    urdf::{Element, UrdfJoint, UrdfProblem, UrdfRobot},
};

/// A link of the tree; `parent` is an index in the order, `joint` an index into the file's joints. The root has
/// neither.
pub(crate) struct Branch {
    pub(crate) link: usize,
    pub(crate) parent: usize,
    pub(crate) joint: Option<usize>,
}

/// All links, depth first from the root, children in document order.
pub(crate) fn ordered(urdf: &UrdfRobot) -> Result<Vec<Branch>, KinematicsError> {
    let links = index_of(urdf.links.iter().map(String::as_str), Element::Link)?;
    index_of(urdf.joints.iter().map(|joint| joint.name.as_str()), Element::Joint)?;
    let ends: Vec<(usize, usize)> =
        urdf.joints.iter().map(|joint| ends(joint, urdf, &links)).collect::<Result<_, _>>()?;
    let carriers = carriers(urdf, &ends)?;
    let roots: Vec<usize> = (0..urdf.links.len()).filter(|&link| carriers[link].is_none()).collect();
    if roots.len() > 1 {
        let roots = roots.into_iter().map(|link| urdf.links[link].clone()).collect();
        return Err(KinematicsError::urdf(Element::Robot, UrdfProblem::SeveralRoots { roots }));
    }
    let order = roots.first().map_or_else(Vec::new, |&root| depth_first(root, &ends, urdf.links.len()));
    if order.len() < urdf.links.len() { Err(cycle(urdf, &ends, &carriers, &order)) } else { Ok(order) }
}

/// Indices by name; names must be unique.
fn index_of<'n>(
    names: impl Iterator<Item = &'n str>,
    element: fn(String) -> Element,
) -> Result<HashMap<&'n str, usize>, KinematicsError> {
    let mut indices = HashMap::new();
    for (index, name) in names.enumerate() {
        if indices.insert(name, index).is_some() {
            return Err(KinematicsError::urdf(element(name.to_owned()), UrdfProblem::DuplicateName));
        }
    }
    Ok(indices)
}

/// Parent and child link of a joint.
fn ends(joint: &UrdfJoint, urdf: &UrdfRobot, links: &HashMap<&str, usize>) -> Result<(usize, usize), KinematicsError> {
    let find = |role, link: &String| {
        links.get(link.as_str()).copied().ok_or_else(|| {
            let near = near_names(link, urdf.links.iter().map(String::as_str));
            let problem = UrdfProblem::UnknownLink { role, link: link.clone(), near };
            KinematicsError::urdf(Element::Joint(joint.name.clone()), problem)
        })
    };
    Ok((find("parent", &joint.parent)?, find("child", &joint.child)?))
}

/// The joint that carries each link, if any.
fn carriers(urdf: &UrdfRobot, ends: &[(usize, usize)]) -> Result<Vec<Option<usize>>, KinematicsError> {
    let mut carriers: Vec<Option<usize>> = vec![None; urdf.links.len()];
    for (joint, &(_, child)) in ends.iter().enumerate() {
        if let Some(first) = carriers[child].replace(joint) {
            let problem = UrdfProblem::TwoParents {
                first: urdf.joints[first].name.clone(),
                second: urdf.joints[joint].name.clone(),
            };
            return Err(KinematicsError::urdf(Element::Link(urdf.links[child].clone()), problem));
        }
    }
    Ok(carriers)
}

fn depth_first(root: usize, ends: &[(usize, usize)], n_links: usize) -> Vec<Branch> {
    let mut children = vec![Vec::new(); n_links];
    for (joint, &(parent, child)) in ends.iter().enumerate() {
        children[parent].push((joint, child));
    }
    let mut order: Vec<Branch> = Vec::with_capacity(n_links);
    let mut waiting = vec![Branch { link: root, parent: 0, joint: None }];
    while let Some(branch) = waiting.pop() {
        let parent = order.len();
        let next = children[branch.link].iter().rev();
        waiting.extend(next.map(|&(joint, link)| Branch { link, parent, joint: Some(joint) }));
        order.push(branch);
    }
    order
}

/// The error for one cycle among the links that are not reachable from a root.
fn cycle(urdf: &UrdfRobot, ends: &[(usize, usize)], carriers: &[Option<usize>], reached: &[Branch]) -> KinematicsError {
    let mut seen = vec![false; urdf.links.len()];
    for branch in reached {
        seen[branch.link] = true;
    }
    let start = seen.iter().position(|&seen| !seen).expect("some link is not reached");
    let joint_above = |link: usize| carriers[link].expect("a link that the root does not reach has a parent joint");
    let mut link = start;
    while !std::mem::replace(&mut seen[link], true) {
        link = ends[joint_above(link)].0;
    }
    let mut joints = Vec::new();
    let entry = link;
    loop {
        let joint = joint_above(link);
        joints.push(urdf.joints[joint].name.clone());
        link = ends[joint].0;
        if link == entry {
            break;
        }
    }
    joints.reverse();
    KinematicsError::urdf(Element::Robot, UrdfProblem::Cycle { joints })
}
