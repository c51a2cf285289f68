//! The innermost loop of the alignment: all squared distances between the samples of two trajectories, of which only
//! the smallest of every row and every column is kept.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use crate::minima::Minima;
use crate::tiles::{ROWS, Tiles, row_groups};
use lanes::Lanes;

/// Compares one trajectory, sample by sample, with others.
#[derive(Debug)]
pub(crate) struct BlockSearch {
    arch: Arch,
    dim: usize,
    n_rows: usize,
    row_groups: Vec<[f64; ROWS]>,
    /// For the samples of this trajectory, the nearest of the other.
    pub(crate) of_rows: Minima,
    /// For the samples of the other trajectory, the nearest of this.
    pub(crate) of_columns: Minima,
}

impl BlockSearch {
    /// A search with the vectors of one kind of machine, for which the other trajectories' tiles must be made.
    pub(crate) fn new(states: &DMatrix<f64>, arch: Arch) -> Self {
        let (dim, n_rows) = states.shape();
        let (of_rows, of_columns) = (Minima::default(), Minima::default());
        BlockSearch { arch, dim, n_rows, row_groups: row_groups(states), of_rows, of_columns }
    }

    /// Finds what is nearest for the samples of both trajectories, and the smallest squared distance of all.
    pub(crate) fn run(&mut self, other: &Tiles) -> f64 {
        self.of_rows.reset(self.n_rows);
        self.of_columns.reset(other.n_samples);
        self.arch.dispatch(Block {
            dim: self.dim,
            n_rows: self.n_rows,
            row_groups: &self.row_groups,
            other: &other.coordinates,
            of_rows: &mut self.of_rows,
            of_columns: &mut self.of_columns,
        })
    }
}

/// One pair of trajectories: rows are samples of the one, vector lanes samples of the other.
struct Block<'a> {
    dim: usize,
    n_rows: usize,
    row_groups: &'a [[f64; ROWS]],
    other: &'a [f64],
    of_rows: &'a mut Minima,
    of_columns: &'a mut Minima,
}

impl WithSimd for Block<'_> {
    type Output = f64;

    /// The smallest squared distance of the block.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        // Few dimensions stay in registers; many are a loop whose start and end no longer matter.
        match self.dim {
            1 => self.search(simd, |rows, tile| squared_distances::<S, 1>(simd, rows, tile)),
            2 => self.search(simd, |rows, tile| squared_distances::<S, 2>(simd, rows, tile)),
            3 => self.search(simd, |rows, tile| squared_distances::<S, 3>(simd, rows, tile)),
            6 => self.search(simd, |rows, tile| squared_distances::<S, 6>(simd, rows, tile)),
            _ => self.search(simd, |rows, tile| any_squared_distances(simd, rows, tile)),
        }
    }
}

impl Block<'_> {
    #[inline(always)]
    fn search<S: Simd>(self, simd: S, distances: impl Fn(&[[f64; ROWS]], &[S::f64s]) -> [S::f64s; ROWS]) -> f64 {
        let (row_distances, row_samples) =
            (self.of_rows.distances.as_flattened_mut(), self.of_rows.samples.as_flattened_mut());
        let tiles = S::as_simd_f64s(self.other).0;
        let column_distances = S::as_mut_simd_f64s(self.of_columns.distances.as_flattened_mut()).0;
        let column_samples = S::as_mut_simd_f64s(self.of_columns.samples.as_flattened_mut()).0;
        let lanes: Lanes = std::array::from_fn(|lane| lane as f64);
        let lanes = S::as_simd_f64s(&lanes).0[0];
        let infinity = simd.splat_f64s(f64::INFINITY);
        let mut smallest = infinity;

        for (group, rows) in self.row_groups.chunks_exact(self.dim).enumerate() {
            let index: [usize; ROWS] = std::array::from_fn(|r| (ROWS * group + r).min(self.n_rows - 1));
            let names = index.map(|i| simd.splat_f64s(i as f64));
            let mut nearest = [infinity; ROWS];
            let mut samples = [infinity; ROWS];
            let mut here = lanes;
            let columns = column_distances.iter_mut().zip(column_samples.iter_mut());
            for (tile, (column_distance, column_sample)) in tiles.chunks_exact(self.dim).zip(columns) {
                let distance = distances(rows, tile);
                // Held in registers: a masked store that is read again at once would wait for memory.
                let (mut column_nearest, mut column_row) = (*column_distance, *column_sample);
                for r in 0..ROWS {
                    let nearer = simd.less_than_f64s(distance[r], nearest[r]);
                    nearest[r] = simd.min_f64s(distance[r], nearest[r]);
                    samples[r] = simd.select_f64s(nearer, here, samples[r]);
                    let nearer = simd.less_than_f64s(distance[r], column_nearest);
                    column_nearest = simd.min_f64s(distance[r], column_nearest);
                    column_row = simd.select_f64s(nearer, names[r], column_row);
                }
                (*column_distance, *column_sample) = (column_nearest, column_row);
                here = simd.add_f64s(here, simd.splat_f64s(S::F64_LANES as f64));
            }
            for r in 0..ROWS {
                let least = simd.reduce_min_f64s(nearest[r]);
                let attained = simd.equal_f64s(nearest[r], simd.splat_f64s(least));
                row_distances[index[r]] = least;
                row_samples[index[r]] = simd.reduce_min_f64s(simd.select_f64s(attained, samples[r], infinity));
                smallest = simd.min_f64s(smallest, nearest[r]);
            }
        }
        simd.reduce_min_f64s(smallest)
    }
}

/// Of each of `ROWS` rows to each sample of a tile, in `N` dimensions.
#[inline(always)]
fn squared_distances<S: Simd, const N: usize>(simd: S, rows: &[[f64; ROWS]], tile: &[S::f64s]) -> [S::f64s; ROWS] {
    let rows: &[[f64; ROWS]; N] = rows.try_into().expect("N is the number of dimensions");
    let tile: &[S::f64s; N] = tile.try_into().expect("N is the number of dimensions");
    any_squared_distances(simd, rows, tile)
}

/// Of each of `ROWS` rows to each sample of a tile.
#[inline(always)]
fn any_squared_distances<S: Simd>(simd: S, rows: &[[f64; ROWS]], tile: &[S::f64s]) -> [S::f64s; ROWS] {
    let mut sum = [simd.splat_f64s(0.0); ROWS];
    for (row, &other) in rows.iter().zip(tile) {
        for r in 0..ROWS {
            let difference = simd.sub_f64s(simd.splat_f64s(row[r]), other);
            sum[r] = simd.add_f64s(sum[r], simd.mul_f64s(difference, difference));
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    /// Few different coordinates, so that many samples are equally near; or arbitrary ones.
    fn states(dim: usize) -> impl Strategy<Value = DMatrix<f64>> {
        let coordinate = prop_oneof![(-2..3).prop_map(f64::from), -1.0..1.0];
        (1usize..40).prop_flat_map(move |n| {
            vec(coordinate.clone(), n * dim).prop_map(move |values| DMatrix::from_vec(dim, n, values))
        })
    }

    fn two_trajectories() -> impl Strategy<Value = (DMatrix<f64>, DMatrix<f64>)> {
        (1usize..9).prop_flat_map(|dim| (states(dim), states(dim)))
    }

    /// Every kind of vector that this machine has.
    fn kinds() -> Vec<Arch> {
        let kinds = vec![Arch::Scalar, Arch::new()];
        #[cfg(target_arch = "x86_64")]
        let kinds = kinds.into_iter().chain(pulp::x86::V3::try_new().map(Arch::V3)).collect();
        kinds
    }

    fn nearest(states: &DMatrix<f64>, to: &DMatrix<f64>) -> Vec<(f64, f64)> {
        let distance = |i: usize, m: usize| {
            let (x, y) = (states.column(i), to.column(m));
            x.iter().zip(y.iter()).map(|(x, y)| (x - y) * (x - y)).sum()
        };
        let of = |m: usize| {
            let all: Vec<f64> = (0..states.ncols()).map(|i| distance(i, m)).collect();
            let least = all.iter().copied().fold(f64::INFINITY, f64::min);
            (least, all.iter().position(|&d| d == least).unwrap() as f64)
        };
        (0..to.ncols()).map(of).collect()
    }

    fn found(minima: &Minima, count: usize) -> Vec<(f64, f64)> {
        let samples = minima.samples.as_flattened().iter().copied();
        let distances = minima.distances.as_flattened().iter().copied();
        assert!(distances.clone().skip(count).all(|distance| distance == f64::INFINITY));
        distances.zip(samples).take(count).collect()
    }

    proptest! {
        #[test]
        fn finds_the_first_of_the_nearest((one, other) in two_trajectories()) {
            for arch in kinds() {
                let mut search = BlockSearch::new(&one, arch);
                let smallest = search.run(&Tiles::new(&other, arch));
                // All bits, for the sums have one order on every machine.
                let of_one = nearest(&other, &one);
                prop_assert_eq!(&found(&search.of_rows, one.ncols()), &of_one);
                prop_assert_eq!(found(&search.of_columns, other.ncols()), nearest(&one, &other));
                prop_assert_eq!(smallest, of_one.iter().fold(f64::INFINITY, |least, (d, _)| least.min(*d)));
            }
        }
    }
}
