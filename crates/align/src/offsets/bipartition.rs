use std::cmp::Reverse;

use linalg::{symmetric_eigen, symmetric_eigenvalues};
use nalgebra::DMatrix;

use super::two_means::two_means;
use crate::{AlignError, Split, SplitCause};

/// Groups of trajectories whose relative offsets the data do not determine (Sec. 3.3, App. B).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Partition {
    /// Each ascending; the largest first, groups of equal size by lowest trajectory.
    pub(crate) groups: Vec<Vec<usize>>,
    /// The splits that led to them; a group always comes before its parts.
    pub(crate) splits: Vec<Split>,
    /// λ₂ of the first group, which measures how strongly its weakest part is connected; `None` for a single
    /// trajectory.
    pub(crate) lambda_2: Option<f64>,
    /// Number of eigenvalue problems solved.
    pub(crate) decompositions: usize,
}

/// Recursive bi-partition: while the sub-matrix of H for a group has more than one eigenvalue below `threshold`, its
/// trajectories are divided into two clusters by their entries in those eigenvectors.
///
/// Parts without any link between them are separated beforehand, by exact zeros of H.
///
/// A node may stand for several trajectories that move together: `masses` contains their number. The entry of
/// `laplacian` for nodes s and t is then that of H, summed over their trajectories, divided by √(mass of s · mass of
/// t).
pub(crate) fn bipartition(laplacian: &DMatrix<f64>, masses: &[f64], threshold: f64) -> Result<Partition, AlignError> {
    let mut splits = Vec::new();
    let mut open = linked_parts(laplacian, (0..laplacian.ncols()).collect(), &mut splits);
    let mut closed = Vec::new();
    let mut decompositions = 0;
    while let Some(group) = open.pop() {
        if group.len() == 1 {
            closed.push((group, None));
            continue;
        }
        let matrix = laplacian.select_rows(&group).select_columns(&group);
        let (lambda_2, weak_vectors) = weak_part(&matrix, threshold, &mut decompositions)?;
        let Some(parts) = cut(&group, weak_vectors.clone(), masses) else {
            closed.push((group, Some(lambda_2)));
            continue;
        };
        let cause = SplitCause::WeakEigenvalues(weak_vectors.ncols());
        splits.push(Split { group, parts: parts.clone(), cause });
        open.extend(parts.into_iter().flat_map(|part| linked_parts(laplacian, part, &mut splits)));
    }
    closed.sort_by_key(|(group, _)| (Reverse(group.len()), group[0]));
    let lambda_2 = closed[0].1;
    let groups = closed.into_iter().map(|(group, _)| group).collect();
    Ok(Partition { groups, splits, lambda_2, decompositions })
}

/// The second eigenvalue of a group's matrix, and all eigenvectors below the threshold, or none if there is at most
/// one.
///
/// Most groups are connected, and eigenvalues alone cost half as much. Vectors are computed at once if there is
/// evidence of a weakly connected trajectory: its unit vector has the Rayleigh quotient H_kk.
fn weak_part(
    matrix: &DMatrix<f64>,
    threshold: f64,
    decompositions: &mut usize,
) -> Result<(f64, DMatrix<f64>), AlignError> {
    let weak = |values: &[f64]| values.iter().take_while(|&&value| value < threshold).count();
    if matrix.diagonal().min() >= threshold {
        *decompositions += 1;
        let values = symmetric_eigenvalues(matrix).ok_or(AlignError::NoConvergence)?;
        if weak(&values) <= 1 {
            return Ok((values[1], DMatrix::zeros(matrix.ncols(), 0)));
        }
    }
    *decompositions += 1;
    let (values, vectors) = symmetric_eigen(matrix).ok_or(AlignError::NoConvergence)?;
    Ok((values[1], vectors.columns(0, weak(&values)).into_owned()))
}

/// The parts of a group that are connected by any links; records a split if there are several.
fn linked_parts(laplacian: &DMatrix<f64>, group: Vec<usize>, splits: &mut Vec<Split>) -> Vec<Vec<usize>> {
    let parts = components(laplacian, group.clone());
    if parts.len() > 1 {
        splits.push(Split { group, parts: parts.clone(), cause: SplitCause::NoLink });
    }
    parts
}

/// The connected components of a group, each ascending, by a flood fill from each lowest unvisited member.
fn components(laplacian: &DMatrix<f64>, group: Vec<usize>) -> Vec<Vec<usize>> {
    let mut dry = group;
    let mut parts = Vec::new();
    while !dry.is_empty() {
        let mut part = vec![dry.remove(0)];
        let mut at = 0;
        while at < part.len() {
            let links = laplacian.column(part[at]);
            let reached;
            (reached, dry) = dry.into_iter().partition(|&k| links[k] != 0.0);
            part.extend::<Vec<usize>>(reached);
            at += 1;
        }
        part.sort_unstable();
        parts.push(part);
    }
    parts
}

/// The two sides of a group by the rows of its weak eigenvectors; `None` if it is connected.
///
/// If all eigenvalues are weak, so are those of every part (they interlace), so all members become separate at once.
fn cut(group: &[usize], mut weak_vectors: DMatrix<f64>, masses: &[f64]) -> Option<Vec<Vec<usize>>> {
    if weak_vectors.ncols() <= 1 {
        return None;
    }
    if weak_vectors.ncols() == group.len() {
        return Some(group.iter().map(|&k| vec![k]).collect());
    }
    // Entries of each of a node's trajectories in an eigenvector.
    let masses: Vec<f64> = group.iter().map(|&k| masses[k]).collect();
    weak_vectors.row_iter_mut().zip(&masses).for_each(|(mut row, mass)| row /= mass.sqrt());
    let in_second = two_means(&weak_vectors, &masses);
    let side = |second| group.iter().zip(&in_second).filter(move |&(_, &at)| at == second).map(|(&k, _)| k).collect();
    let sides: Vec<Vec<usize>> = vec![side(false), side(true)];
    sides.iter().all(|side| !side.is_empty()).then_some(sides)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    fn level(laplacian: &DMatrix<f64>) -> Result<Partition, AlignError> {
        bipartition(laplacian, &vec![1.0; laplacian.ncols()], 1e-8)
    }

    /// The Laplacian of the graph with these links (k, j, weight).
    fn graph(count: usize, links: &[(usize, usize, f64)]) -> DMatrix<f64> {
        let mut laplacian = DMatrix::zeros(count, count);
        for &(k, j, weight) in links {
            laplacian[(k, k)] += weight;
            laplacian[(j, j)] += weight;
            laplacian[(k, j)] -= weight;
            laplacian[(j, k)] -= weight;
        }
        laplacian
    }

    #[test]
    fn connected_graphs_stay_whole() {
        let path = graph(4, &[(0, 1, 1.0), (1, 2, 1.0), (2, 3, 1.0)]);
        let partition = level(&path).unwrap();
        assert_eq!(partition.groups, [[0, 1, 2, 3]]);
        assert!((partition.lambda_2.unwrap() - (2.0 - 2.0_f64.sqrt())).abs() < 1e-14);
    }

    #[test]
    fn disconnected_parts_are_separated_largest_first() {
        let parts = graph(8, &[(1, 4, 2.0), (4, 6, 0.5), (0, 3, 1.0), (2, 7, 1.0)]);
        let partition = level(&parts).unwrap();
        assert_eq!(partition.groups, [vec![1, 4, 6], vec![0, 3], vec![2, 7], vec![5]]);
    }

    #[test]
    fn splits_record_their_cause_and_parts() {
        // Two groups of three: one connected by a link that is too weak, and one without a weak link.
        let links = [(0, 1, 1.0), (1, 4, 1e-12), (2, 3, 1.0), (3, 5, 1.0)];
        let partition = level(&graph(6, &links)).unwrap();
        assert_eq!(partition.groups, [vec![2, 3, 5], vec![0, 1], vec![4]]);
        let [apart, cut] = &partition.splits[..] else { panic!("{:?}", partition.splits) };
        assert_eq!((&apart.group, apart.cause), (&vec![0, 1, 2, 3, 4, 5], SplitCause::NoLink));
        assert_eq!(apart.parts, [[0, 1, 4], [2, 3, 5]]);
        assert_eq!((&cut.group, cut.cause), (&vec![0, 1, 4], SplitCause::WeakEigenvalues(2)));
        let mut parts = cut.parts.clone();
        parts.sort();
        assert_eq!(parts, [vec![0, 1], vec![4]]);
    }

    #[test]
    fn links_below_the_threshold_are_cut() {
        // Two pairs joined by w have λ₂ ≈ w.
        let pairs = |weight| graph(4, &[(0, 2, 1.0), (1, 3, 1.0), (2, 3, weight)]);
        assert_eq!(level(&pairs(0.9e-8)).unwrap().groups, [[0, 2], [1, 3]]);
        assert_eq!(level(&pairs(1.1e-8)).unwrap().groups, [[0, 1, 2, 3]]);
    }

    #[test]
    fn a_single_trajectory_is_a_group() {
        let partition = level(&DMatrix::zeros(1, 1)).unwrap();
        let alone = Partition { groups: vec![vec![0]], splits: vec![], lambda_2: None, decompositions: 0 };
        assert_eq!(partition, alone);
    }

    #[test]
    fn trajectories_without_links_are_all_alone() {
        let partition = level(&DMatrix::zeros(4, 4)).unwrap();
        assert_eq!(partition.groups, [[0], [1], [2], [3]]);
    }

    #[test]
    fn many_singletons_take_at_most_one_decomposition() {
        // Separated one at a time, each with a decomposition, they would take minutes.
        let alone: Vec<Vec<usize>> = (0..300).map(|k| vec![k]).collect();
        let links: Vec<_> = (1..300).map(|k| (k - 1, k, 1e-12)).collect();
        for (links, decompositions) in [(&[][..], 0), (&links, 1)] {
            let partition = level(&graph(300, links)).unwrap();
            assert_eq!((partition.groups, partition.lambda_2), (alone.clone(), None));
            assert_eq!((partition.splits.len(), partition.decompositions), (1, decompositions));
        }
    }

    /// Graphs with links of any strength, many of them too weak.
    fn weak_graphs() -> impl Strategy<Value = DMatrix<f64>> {
        (1usize..14, vec((0usize..14, 0usize..14, -20.0..0.0_f64), 0..30)).prop_map(|(count, links)| {
            let links = links.into_iter().map(|(k, j, exponent)| (k % count, j % count, 10.0_f64.powf(exponent)));
            graph(count, &links.filter(|(k, j, _)| k != j).collect::<Vec<_>>())
        })
    }

    /// Whether a split follows from its cause.
    fn follows_from_its_cause(split: &Split, laplacian: &DMatrix<f64>) -> bool {
        let SplitCause::WeakEigenvalues(weak) = split.cause else {
            return components(laplacian, split.group.clone()) == split.parts;
        };
        let matrix = laplacian.select_rows(&split.group).select_columns(&split.group);
        let (values, vectors) = symmetric_eigen(&matrix).unwrap();
        let found = values.iter().filter(|&&value| value < 1e-8).count();
        found == weak
            && cut(&split.group, vectors.columns(0, weak).into_owned(), &vec![1.0; laplacian.ncols()]).as_ref()
                == Some(&split.parts)
    }

    proptest! {
        #[test]
        fn the_leaves_of_all_splits_are_the_groups(laplacian in weak_graphs()) {
            let Partition { groups, splits, .. } = level(&laplacian).unwrap();
            let mut leaves = vec![(0..laplacian.ncols()).collect::<Vec<_>>()];
            for split in &splits {
                // A group is split once, after the split that created it.
                let at = leaves.iter().position(|leaf| *leaf == split.group);
                leaves.remove(at.unwrap());
                leaves.extend(split.parts.clone());
                let mut members = split.parts.concat();
                members.sort_unstable();
                prop_assert_eq!(&members, &split.group);
                prop_assert!(follows_from_its_cause(split, &laplacian), "{:?}", split);
            }
            leaves.sort_by_key(|group| (Reverse(group.len()), group[0]));
            prop_assert_eq!(leaves, groups);
        }

        #[test]
        fn links_hold_every_group_together(laplacian in weak_graphs()) {
            let groups = level(&laplacian).unwrap().groups;
            let mut members = groups.concat();
            members.sort_unstable();
            prop_assert_eq!(members, (0..laplacian.ncols()).collect::<Vec<_>>());
            for group in groups {
                prop_assert_eq!(components(&laplacian, group.clone()), [group]);
            }
        }

        #[test]
        fn blocks_are_found_under_any_numbering(
            blocks in vec(1usize..6, 1..6), weights in vec(0.01..1.0, 400),
            order in Just((0..25).collect::<Vec<usize>>()).prop_shuffle(),
        ) {
            let count: usize = blocks.iter().sum();
            let order: Vec<usize> = order.into_iter().filter(|&k| k < count).collect();
            let mut weights = weights.into_iter();
            let (mut links, mut expected, mut first) = (vec![], vec![], 0);
            for size in blocks {
                let members: Vec<usize> = order[first..first + size].to_vec();
                for (at, &k) in members.iter().enumerate() {
                    links.extend(members[..at].iter().map(|&j| (k, j, weights.next().unwrap())));
                }
                expected.push({ let mut sorted = members; sorted.sort_unstable(); sorted });
                first += size;
            }
            expected.sort_by_key(|group| (Reverse(group.len()), group[0]));
            prop_assert_eq!(level(&graph(count, &links)).unwrap().groups, expected);
        }
    }
}
