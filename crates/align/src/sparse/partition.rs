use std::cmp::Reverse;

use nalgebra::DMatrix;

use super::clusters::Clusters;
use super::conjugate_gradients::centre;
use super::group::Group;
use super::hash::uniform;
use super::preconditioner::Preconditioner;
use super::shared_samples::SharedSamples;
use super::weak_modes::{Modes, weak_modes};
use crate::offsets::bipartition::{Partition, bipartition};
use crate::offsets::two_means::two_means;
use crate::{AlignError, Split, SplitCause};

/// Links of at least this number of thresholds keep trajectories together: in an eigenvector below the threshold, their
/// entries differ by at most 1/√STRONG of its length.
const STRONG: f64 = 1e4;
/// Up to this number of clusters are examined at once; more only in pieces that are connected without the largest
/// cluster.
const FEW: usize = 128;
/// Groups of up to this number of trajectories have a matrix.
const SMALL: usize = 24;
/// Number of eigenvectors to compute, besides the constant one: two that start at the clusters with the weakest links,
/// and an arbitrary one.
const CANDIDATES: usize = 2;

/// The groups of the recursive bi-partition, without the matrix H.
///
/// Also returns the preconditioner of the first group, unless the group is small.
///
/// First divides by clusters that are connected by strong links. Then examines the largest group by its own lowest
/// eigenvectors, and splits it as long as two are below the threshold.
pub(crate) fn partition(
    samples: &SharedSamples,
    threshold: f64,
) -> Result<(Partition, Option<Preconditioner>), AlignError> {
    let clusters = Clusters::new(samples, STRONG * threshold);
    let all: Vec<usize> = (0..clusters.members.len()).collect();
    let parts = clusters.parts(&all, None);
    let mut splits = Vec::new();
    if parts.len() > 1 {
        let group = (0..samples.n_trajectories).collect();
        let parts = parts.iter().map(|part| clusters.trajectories(part)).collect();
        splits.push(Split { group, parts, cause: SplitCause::NoLink });
    }
    let mut groups = Vec::new();
    let mut decompositions = 0;
    for part in parts {
        let found = groups_of_part(&clusters, &part, threshold, &mut decompositions)?;
        if found.len() > 1 {
            let cause = SplitCause::WeakEigenvalues(found.len());
            splits.push(Split { group: clusters.trajectories(&part), parts: found.clone(), cause });
        }
        groups.extend(found);
    }
    let (lambda_2, preconditioner) = loop {
        groups.sort_by_key(|group: &Vec<usize>| (Reverse(group.len()), group[0]));
        let Examined { lambda_2, parts, preconditioner } =
            examine(samples, &clusters, &groups[0], threshold, &mut decompositions)?;
        if parts.len() < 2 {
            break (lambda_2, preconditioner);
        }
        let group = groups.swap_remove(0);
        splits.push(Split { group, parts: parts.clone(), cause: SplitCause::WeakEigenvalues(parts.len()) });
        groups.extend(parts);
    };
    Ok((Partition { groups, splits, lambda_2, decompositions }, preconditioner))
}

/// The groups of clusters that are connected by links.
///
/// Pieces attached to the largest cluster without links to each other are examined one after the other, each together
/// with the largest cluster.
fn groups_of_part(
    clusters: &Clusters,
    part: &[usize],
    threshold: f64,
    decompositions: &mut usize,
) -> Result<Vec<Vec<usize>>, AlignError> {
    let Some(largest) = clusters.largest(part).filter(|_| part.len() > 1) else {
        return Ok(vec![clusters.trajectories(part)]);
    };
    let rest = || part.iter().copied().filter(|&cluster| cluster != largest);
    let pieces = if part.len() <= FEW { vec![rest().collect()] } else { clusters.parts(part, Some(largest)) };
    let mut groups = Vec::new();
    let mut kept = vec![largest];
    for mut piece in pieces {
        piece.push(largest);
        piece.sort_unstable();
        let found = bipartition(&quotient(clusters, &piece), &masses(clusters, &piece), threshold)?;
        *decompositions += found.decompositions;
        for group in found.groups {
            let group: Vec<usize> = group.into_iter().map(|at| piece[at]).collect();
            if group.contains(&largest) {
                kept.extend(group.into_iter().filter(|&cluster| cluster != largest));
            } else {
                groups.push(clusters.trajectories(&group));
            }
        }
    }
    groups.push(clusters.trajectories(&kept));
    groups.sort_by_key(|group| group[0]);
    Ok(groups)
}

fn masses(clusters: &Clusters, among: &[usize]) -> Vec<f64> {
    among.iter().map(|&cluster| clusters.members[cluster].len() as f64).collect()
}

/// The Laplacian of some clusters from the links among them, divided by the square roots of their masses.
fn quotient(clusters: &Clusters, among: &[usize]) -> DMatrix<f64> {
    let masses = masses(clusters, among);
    let mut matrix = DMatrix::zeros(among.len(), among.len());
    for (at, &cluster) in among.iter().enumerate() {
        let links = clusters.links[cluster]
            .iter()
            .filter_map(|&(other, weight)| among.binary_search(&other).ok().map(|there| (there, weight)));
        for (there, weight) in links {
            matrix[(at, at)] += weight / masses[at];
            matrix[(at, there)] = -weight / (masses[at] * masses[there]).sqrt();
        }
    }
    matrix
}

/// Result of examining the eigenvectors of a group.
struct Examined {
    lambda_2: Option<f64>,
    /// Several if more than one eigenvalue is below the threshold.
    parts: Vec<Vec<usize>>,
    preconditioner: Option<Preconditioner>,
}

fn examine(
    samples: &SharedSamples,
    clusters: &Clusters,
    members: &[usize],
    threshold: f64,
    decompositions: &mut usize,
) -> Result<Examined, AlignError> {
    if members.len() == 1 {
        return Ok(Examined { lambda_2: None, parts: Vec::new(), preconditioner: None });
    }
    let group = Group::new(samples, members);
    if members.len() <= SMALL {
        let found = bipartition(&group.matrix(), &vec![1.0; members.len()], threshold)?;
        *decompositions += found.decompositions;
        let named = |group: Vec<usize>| group.into_iter().map(|at| members[at]).collect();
        let parts = found.groups.into_iter().map(named).collect();
        return Ok(Examined { lambda_2: found.lambda_2, parts, preconditioner: None });
    }
    let preconditioner = Preconditioner::new(&group)?;
    let Modes { values, vectors } = weak_modes(&group, &preconditioner, starts(&group, clusters, &preconditioner))?;
    let weak = values.iter().take_while(|&&value| value < threshold).count();
    let lambda_2 = values.get(1).copied();
    if weak < 2 {
        return Ok(Examined { lambda_2, parts: Vec::new(), preconditioner: Some(preconditioner) });
    }
    let rows = DMatrix::from_fn(members.len(), weak, |at, column| vectors[column][members[at]]);
    let in_second = two_means(&rows, &vec![1.0; members.len()]);
    let side = |second| members.iter().zip(&in_second).filter(move |&(_, &at)| at == second).map(|(&k, _)| k).collect();
    let parts = [side(false), side(true)].into_iter().filter(|side: &Vec<_>| !side.is_empty()).collect();
    Ok(Examined { lambda_2, parts, preconditioner: Some(preconditioner) })
}

/// Starting vectors for the lowest eigenvectors: the clusters with the weakest links, and an arbitrary vector without
/// preference, after the preconditioner has amplified its low modes.
fn starts(group: &Group<'_>, clusters: &Clusters, preconditioner: &Preconditioner) -> Vec<Vec<f64>> {
    let within = |&cluster: &usize| clusters.members[cluster].iter().all(|&k| group.contains[k]);
    let mut weakest: Vec<usize> = (0..clusters.members.len()).filter(within).collect();
    let strength = |cluster: usize| clusters.degree(cluster) / clusters.members[cluster].len() as f64;
    weakest.sort_by(|&a, &b| strength(a).total_cmp(&strength(b)));
    let candidates = weakest.into_iter().take(CANDIDATES).map(|cluster| {
        let mut start = vec![0.0; group.contains.len()];
        clusters.members[cluster].iter().for_each(|&k| start[k] = 1.0);
        start
    });
    let mut any: Vec<f64> = group
        .contains
        .iter()
        .enumerate()
        .map(|(k, &member)| if member { uniform(k as u64) - 0.5 } else { 0.0 })
        .collect();
    centre(group, &mut any);
    preconditioner.apply(&mut any, &mut Vec::new());
    candidates.chain([any]).collect()
}
