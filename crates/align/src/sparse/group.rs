use nalgebra::DMatrix;
use rayon::prelude::*;

use super::shared_samples::{Row, SharedSamples, SparseRows};
use crate::offsets::compensated::CompensatedSum;

/// Sums over rows are computed in this many parts, each in the order of its rows, so that the bits do not depend on the
/// number of threads.
const PARTS: usize = 8;

/// The Laplacian of a group of trajectories, from the rows of the samples they share. Let q be restricted to the group,
/// s be Σ_k q_k, and o be a trajectory of the row that is in the group. Then
/// (Lv)_k = Σ_m q_km (s_m (v_k − v_o) − Σ_j q_jm (v_j − v_o)).
///
/// Differences from v_o preserve the digits of small differences between strongly connected trajectories.
#[derive(Debug)]
pub(crate) struct Group<'a> {
    pub(crate) samples: &'a SharedSamples,
    /// Ascending.
    pub(crate) members: &'a [usize],
    /// For each trajectory, whether it is a member.
    pub(crate) contains: Vec<bool>,
    /// For each trajectory, its weight to others outside: the diagonal of the sub-matrix of H minus that of L.
    pub(crate) outside: Vec<f64>,
}

/// Memory for the parts of a sum over rows.
#[derive(Debug, Default)]
pub(crate) struct Parts(Vec<Vec<f64>>);

impl<'a> Group<'a> {
    pub(crate) fn new(samples: &'a SharedSamples, members: &'a [usize]) -> Self {
        let mut contains = vec![false; samples.n_trajectories];
        for &k in members {
            contains[k] = true;
        }
        let mut group = Group { samples, members, contains, outside: Vec::new() };
        if members.len() == samples.n_trajectories {
            group.outside = vec![0.0; members.len()];
            return group;
        }
        group.outside = group.sum(|row, outside| {
            let others = || row.models.iter().map(|&k| k as usize).zip(row.shares.iter().copied());
            let all = || others().chain([(row.owner, row.own_share)]);
            let lost: f64 = all().filter(|&(k, _)| !group.contains[k]).map(|(_, q)| q).sum();
            if lost > 0.0 {
                all().filter(|&(k, _)| group.contains[k]).for_each(|(k, q)| outside[k] += q * lost);
            }
        });
        group
    }

    /// Sum over all rows; `add` adds a row's contribution to one number per trajectory.
    fn sum(&self, add: impl Fn(Row<'_>, &mut [f64]) + Sync) -> Vec<f64> {
        let mut total = vec![0.0; self.samples.n_trajectories];
        self.sum_into(&mut Parts::default(), &mut total, add);
        total
    }

    /// The same into `total`; `parts` are allocated once.
    fn sum_into(&self, parts: &mut Parts, total: &mut [f64], add: impl Fn(Row<'_>, &mut [f64]) + Sync) {
        let blocks = &self.samples.blocks;
        let chunks = blocks.par_chunks(blocks.len().div_ceil(PARTS));
        parts.0.resize(chunks.len(), Vec::new());
        parts.0.par_iter_mut().zip(chunks).for_each(|(sum, blocks)| {
            sum.clear();
            sum.resize(total.len(), 0.0);
            for row in blocks.iter().flat_map(SparseRows::rows) {
                add(row, sum);
            }
        });
        total.fill(0.0);
        for part in &parts.0 {
            total.iter_mut().zip(part).for_each(|(total, part)| *total += part);
        }
    }

    /// The member that serves as reference for the values of a row: its own trajectory if that is a member, else the
    /// first.
    fn reference(&self, row: Row<'_>) -> Option<(usize, f64)> {
        if self.contains[row.owner] {
            return Some((row.owner, row.own_share));
        }
        let mut models = row.models.iter().zip(row.shares).map(|(&k, &q)| (k as usize, q));
        models.find(|&(k, _)| self.contains[k])
    }

    /// Lv for values of all trajectories, (K); 0 for those outside. O(nnz).
    pub(crate) fn laplacian_times(&self, values: &[f64], parts: &mut Parts, image: &mut [f64]) {
        self.sum_into(parts, image, |row, sum| {
            let Some((reference, own_share)) = self.reference(row) else { return };
            let own = values[reference];
            let (mut share, mut mean) = (own_share, 0.0);
            for (&k, &q) in row.models.iter().zip(row.shares) {
                let q = if self.contains[k as usize] && k as usize != reference { q } else { 0.0 };
                share += q;
                mean += q * (values[k as usize] - own);
            }
            let mut flows = 0.0;
            for (&k, &q) in row.models.iter().zip(row.shares) {
                if self.contains[k as usize] && k as usize != reference {
                    let flow = q * (share * (values[k as usize] - own) - mean);
                    sum[k as usize] += flow;
                    flows += flow;
                }
            }
            sum[reference] -= flows;
        });
    }

    /// Sum of the weights of each trajectory's links, as returned by `links_of`.
    pub(crate) fn degrees(&self, whole: usize) -> Vec<f64> {
        self.sum(|row, sum| {
            self.links_of(row, whole, |k, j, weight| {
                sum[k] += weight;
                sum[j] += weight;
            });
        })
    }

    /// The links of one row: all of them if at most `whole` trajectories share it, otherwise only those to its
    /// reference.
    pub(crate) fn links_of(&self, row: Row<'_>, whole: usize, mut each: impl FnMut(usize, usize, f64)) {
        let Some((reference, own_share)) = self.reference(row) else { return };
        let members = || row.models.iter().zip(row.shares).map(|(&k, &q)| (k as usize, q));
        let members = || members().filter(|&(k, _)| self.contains[k] && k != reference);
        members().for_each(|(k, q)| each(reference, k, own_share * q));
        if row.models.len() < whole {
            for (at, (k, q)) in members().enumerate() {
                members().skip(at + 1).for_each(|(j, other)| each(k, j, q * other));
            }
        }
    }

    /// a (16), (K), among the members after shifting each by its offset: a + Lb, and 0 outside. The flow into one
    /// trajectory equals the flow out of the other, including rounding; sums are compensated.
    pub(crate) fn linear_term(&self, offsets: &[f64]) -> Vec<f64> {
        let blocks = &self.samples.blocks;
        let parts = blocks.par_chunks(blocks.len().div_ceil(PARTS)).map(|blocks| {
            let mut sum = vec![CompensatedSum::default(); offsets.len()];
            for row in blocks.iter().flat_map(SparseRows::rows) {
                self.add_flows(row, offsets, &mut sum);
            }
            sum
        });
        let parts: Vec<Vec<CompensatedSum>> = parts.collect();
        let mut parts = parts.into_iter();
        let mut total = parts.next().unwrap_or_default();
        for part in parts {
            total.iter_mut().zip(part).for_each(|(total, part)| total.add_sum(part));
        }
        total.iter().map(CompensatedSum::value).collect()
    }

    /// The sub-matrix of H for a small group, in the order of its members. O(nnz + entries of its rows squared).
    pub(crate) fn matrix(&self) -> DMatrix<f64> {
        let position = |k: usize| self.members.binary_search(&k).expect("links are between members");
        let mut matrix = DMatrix::zeros(self.members.len(), self.members.len());
        for row in self.samples.rows() {
            self.links_of(row, usize::MAX, |k, j, weight| {
                matrix[(position(k), position(j))] -= weight;
                matrix[(position(j), position(k))] -= weight;
            });
        }
        for (at, &k) in self.members.iter().enumerate() {
            matrix[(at, at)] = self.outside[k] - matrix.column(at).sum();
        }
        matrix
    }

    fn add_flows(&self, row: Row<'_>, offsets: &[f64], sum: &mut [CompensatedSum]) {
        let Some((reference, own_share)) = self.reference(row) else { return };
        let entries = || row.models.iter().zip(row.shares).zip(row.differences);
        let entries = || entries().map(|((&k, &q), &difference)| (k as usize, q, difference));
        let own = if reference == row.owner {
            0.0
        } else {
            entries().find(|&(k, ..)| k == reference).map_or(0.0, |(_, _, difference)| difference)
        };
        let entries = || entries().filter(|&(k, ..)| self.contains[k] && k != reference);
        let value = |k: usize, difference: f64| (difference - own) + (offsets[k] - offsets[reference]);
        let (mut share, mut mean) = (own_share, 0.0);
        for (k, q, difference) in entries() {
            share += q;
            mean += q * value(k, difference);
        }
        for (k, q, difference) in entries() {
            let flow = q * (share * value(k, difference) - mean);
            sum[k].add(flow);
            sum[reference].add(-flow);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::conjugate_gradients::{centre, solve};
    use super::super::preconditioner::Preconditioner;
    use super::super::sparsifier::sparsifier;
    use super::*;
    use crate::AlignmentObjective;
    use crate::offsets::laplacian::{Elimination, of_group};
    use crate::offsets::linear_term::linear_term;
    use crate::offsets::responsibilities::{Responsibilities, squared_radius};
    use crate::search::{SampleTree, SearchSpace};
    use motion::Demonstrations;
    use nalgebra::DVector;
    use proptest::collection::vec;
    use proptest::prelude::*;

    /// At least two movements, so that some may be members and others not, with arbitrary values of the potential.
    fn movements() -> impl Strategy<Value = (Vec<DMatrix<f64>>, Vec<Vec<f64>>)> {
        let movement = (2usize..20).prop_flat_map(|n| {
            (vec(-1.0..1.0, 2 * n).prop_map(move |x| DMatrix::from_vec(2, n, x)), vec(-5.0..5.0, n))
        });
        vec(movement, 2..20).prop_map(|movements| movements.into_iter().unzip())
    }

    proptest! {
        #[test]
        fn sparse_group_matches_dense_h_and_a(
            (positions, potentials) in movements(), member in vec(any::<bool>(), 20), raises in vec(-3.0..3.0, 20),
            exponent in -3.0..0.0_f64,
        ) {
            let count = potentials.len();
            let sigma_squared = 10.0_f64.powf(exponent);
            let squared_radius = squared_radius(sigma_squared, 1e-20);
            let demonstrations = Demonstrations::from_states(positions, 1.0).unwrap();
            let nearest = SearchSpace::new(&demonstrations).nearest(squared_radius, u64::MAX).unwrap();
            let responsibilities = Responsibilities::new(&nearest, &potentials, sigma_squared);
            let h = AlignmentObjective::new(&responsibilities).laplacian;

            let tree = SampleTree::new(&demonstrations);
            let samples = SharedSamples::new(&tree, &potentials, sigma_squared, squared_radius);
            let members: Vec<usize> = (0..count).filter(|&k| k == 0 || member[k]).collect();
            let group = Group::new(&samples, &members);
            let of_h = h.select_rows(&members).select_columns(&members);
            let size = 1.0 + h.amax();
            prop_assert!((group.matrix() - &of_h).amax() <= 1e-14 * size);

            let masked: Vec<f64> = (0..count).map(|k| if group.contains[k] { raises[k] } else { 0.0 }).collect();
            let of_members = |all: &[f64]| DVector::from_iterator(members.len(), members.iter().map(|&k| all[k]));
            let laplacian = of_group(&h, &members);
            let mut image = vec![f64::NAN; count];
            group.laplacian_times(&masked, &mut Parts::default(), &mut image);
            prop_assert!((&laplacian * of_members(&masked) - of_members(&image)).amax() <= 1e-13 * size);
            prop_assert!((0..count).all(|k| group.contains[k] || image[k] == 0.0));

            let options: Vec<Option<f64>> = (0..count).map(|k| group.contains[k].then_some(raises[k])).collect();
            let (expected, _) = linear_term(&responsibilities, &options);
            let found = group.linear_term(&masked);
            prop_assert!(expected.iter().zip(&found).all(|(a, b)| (a - b).abs() <= 1e-13 * size), "{expected:?} {found:?}");

            // Solves if the group is connected by strong links; with weak links only, solutions are large.
            let elimination = Elimination::new(&laplacian);
            if members.len() > 1 && laplacian.symmetric_eigenvalues().iter().filter(|&&value| value < 1e-6).count() == 1 {
                let mut right = masked;
                centre(&group, &mut right);
                let solved = solve(&group, &Preconditioner::new(&group).unwrap(), right.clone(), 1e-9).unwrap();
                let expected = DVector::from_vec(elimination.solve(of_members(&right).as_slice()));
                prop_assert!((of_members(&solved) - &expected).amax() <= 1e-6 * expected.amax());
                // With few trajectories all links are kept, except those between two that share another's sample.
                let links = sparsifier(&group);
                prop_assert!(links.iter().all(|&(k, j, weight)| k < j && weight > 0.0));
                let mut ends: Vec<usize> = links.iter().flat_map(|&(k, j, _)| [k as usize, j as usize]).collect();
                ends.sort_unstable();
                ends.dedup();
                prop_assert_eq!(ends, members);
            }
        }
    }
}
