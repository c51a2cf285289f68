use std::cmp::Reverse;

use nalgebra::DMatrix;

use crate::AlignError;
use crate::eigen::symmetric_eigen;
use crate::two_means::two_means;

/// The trajectories in groups whose offsets to each other the data do not determine (Sec. 3.3, App. B).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Partition {
    /// Each ascending; the largest first, equally large ones by lowest trajectory.
    pub(crate) groups: Vec<Vec<usize>>,
    /// λ₂ of the first group: how firmly its weakest part hangs on; none for a single trajectory.
    pub(crate) lambda_2: Option<f64>,
}

/// Recursive bi-partition: as long as the sub-matrix of H of a group has more than one eigenvalue below `threshold`,
/// its trajectories fall in two clusters by their entries in those eigenvectors.
pub(crate) fn bipartition(laplacian: &DMatrix<f64>, threshold: f64) -> Result<Partition, AlignError> {
    let mut open: Vec<Vec<usize>> = vec![(0..laplacian.ncols()).collect()];
    let mut closed = Vec::new();
    while let Some(group) = open.pop() {
        if group.len() == 1 {
            closed.push((group, None));
            continue;
        }
        let (values, vectors) = symmetric_eigen(&laplacian.select_rows(&group).select_columns(&group))?;
        let weak = values.iter().take_while(|&&value| value < threshold).count();
        let in_second = if weak > 1 { two_means(&vectors.columns(0, weak).into_owned()) } else { vec![] };
        let side = |second: bool| group.iter().zip(&in_second).filter(move |(_, s)| **s == second).map(|(&k, _)| k);
        let (first, second): (Vec<_>, Vec<_>) = (side(false).collect(), side(true).collect());
        if first.is_empty() || second.is_empty() {
            closed.push((group, Some(values[1])));
        } else {
            open.extend([first, second]);
        }
    }
    closed.sort_by_key(|(group, _)| (Reverse(group.len()), group[0]));
    let lambda_2 = closed[0].1;
    Ok(Partition { groups: closed.into_iter().map(|(group, _)| group).collect(), lambda_2 })
}
