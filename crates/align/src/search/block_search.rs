//! The innermost loop of the alignment: squared distances between the samples of two trajectories, of which only the
//! minimum of each row and each column is kept. Segments whose boxes are beyond the search radius are skipped.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use std::ops::Range;

use lanes::Lanes;
use pulp::{Simd, WithSimd};

use super::boxes::SEGMENT;
use super::distances;
use super::minima::Minima;
use super::tiles::{ROWS, Tiles};

/// Compares one trajectory with others, sample by sample.
#[derive(Debug)]
pub(crate) struct BlockSearch<'a> {
    one: &'a Tiles,
    squared_radius: f64,
    /// The segments of the other trajectory within the search radius of the present segment, as ranges of adjacent
    /// ones.
    within_radius: Vec<Range<usize>>,
    /// For each sample of this trajectory, the nearest of the other.
    pub(crate) of_rows: Minima,
    /// For each sample of the other trajectory, the nearest of this one.
    pub(crate) of_columns: Minima,
}

impl<'a> BlockSearch<'a> {
    /// A search for samples at squared distances of at most `squared_radius` from those of one trajectory.
    pub(crate) fn new(one: &'a Tiles, squared_radius: f64) -> Self {
        let (of_rows, of_columns) = (Minima::default(), Minima::default());
        BlockSearch { one, squared_radius, within_radius: Vec::new(), of_rows, of_columns }
    }

    /// Finds the nearest samples for both trajectories, and the smallest squared distance of all.
    ///
    /// A sample whose nearest is beyond the search radius gets an arbitrary squared distance beyond it, finite or not.
    pub(crate) fn run(&mut self, other: &Tiles) -> f64 {
        self.of_rows.reset(self.one.n_samples);
        self.of_columns.reset(other.n_samples);
        self.one.arch.dispatch(Pair { search: self, other })
    }

    /// Finds the segments of the other trajectory within the search radius of one of this, as ranges of adjacent ones.
    fn find_within_radius(&mut self, segment: usize, other: &Tiles) {
        self.within_radius.clear();
        for b in 0..other.boxes.len() {
            if self.one.boxes.squared_gap(segment, &other.boxes, b) <= self.squared_radius {
                match self.within_radius.last_mut() {
                    Some(run) if run.end == b => run.end = b + 1,
                    _ => self.within_radius.push(b..b + 1),
                }
            }
        }
    }
}

/// One pair of trajectories: rows are samples of this one, vector lanes samples of the other.
struct Pair<'s, 'a> {
    search: &'s mut BlockSearch<'a>,
    other: &'s Tiles,
}

impl WithSimd for Pair<'_, '_> {
    type Output = f64;

    /// The smallest squared distance of the pair.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        // Few dimensions stay in registers; for many, the loop overhead no longer matters.
        match self.other.dim {
            1 => self.run(simd, |rows, tile| distances::fixed::<S, 1>(simd, rows, tile)),
            2 => self.run(simd, |rows, tile| distances::fixed::<S, 2>(simd, rows, tile)),
            3 => self.run(simd, |rows, tile| distances::fixed::<S, 3>(simd, rows, tile)),
            6 => self.run(simd, |rows, tile| distances::fixed::<S, 6>(simd, rows, tile)),
            _ => self.run(simd, |rows, tile| distances::any(simd, rows, tile)),
        }
    }
}

impl Pair<'_, '_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S, squared_distances: impl Fn(&[[f64; ROWS]], &[S::f64s]) -> [S::f64s; ROWS]) -> f64 {
        let Pair { search, other } = self;
        let (dim, n_rows) = (other.dim, search.one.n_samples);
        let tiles = S::as_simd_f64s(&other.columns).0;
        let count: Lanes = std::array::from_fn(|lane| lane as f64);
        let count = S::as_simd_f64s(&count).0[0];
        let infinity = simd.splat_f64s(f64::INFINITY);
        let mut smallest = infinity;

        for segment in 0..search.one.boxes.len() {
            search.find_within_radius(segment, other);
            let BlockSearch { one, within_radius, of_rows, of_columns, .. } = &mut *search;
            let row_distances = of_rows.distances.as_flattened_mut();
            let row_samples = of_rows.samples.as_flattened_mut();
            let column_distances = S::as_mut_simd_f64s(of_columns.distances.as_flattened_mut()).0;
            let column_samples = S::as_mut_simd_f64s(of_columns.samples.as_flattened_mut()).0;
            let groups = one.rows.chunks_exact(dim).enumerate();
            let groups = groups.skip(segment * SEGMENT / ROWS).take(SEGMENT / ROWS);
            for (group, rows) in groups.take(if within_radius.is_empty() { 0 } else { SEGMENT }) {
                let index: [usize; ROWS] = std::array::from_fn(|r| (ROWS * group + r).min(n_rows - 1));
                let names = index.map(|i| simd.splat_f64s(i as f64));
                let mut nearest = [infinity; ROWS];
                let mut samples = [infinity; ROWS];
                for run in within_radius.iter() {
                    let first = run.start * SEGMENT / S::F64_LANES;
                    let last = (run.end * SEGMENT / S::F64_LANES).min(tiles.len() / dim);
                    let mut here = simd.add_f64s(count, simd.splat_f64s((run.start * SEGMENT) as f64));
                    let columns = column_distances[first..last].iter_mut().zip(&mut column_samples[first..last]);
                    let tiles = tiles[first * dim..last * dim].chunks_exact(dim);
                    for (tile, (column_distance, column_sample)) in tiles.zip(columns) {
                        let distance = squared_distances(rows, tile);
                        // Kept in registers, because reading a masked store back immediately would wait for memory.
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
                }
                for r in 0..ROWS {
                    let least = simd.reduce_min_f64s(nearest[r]);
                    let attained = simd.equal_f64s(nearest[r], simd.splat_f64s(least));
                    row_distances[index[r]] = least;
                    row_samples[index[r]] = simd.reduce_min_f64s(simd.select_f64s(attained, samples[r], infinity));
                    smallest = simd.min_f64s(smallest, nearest[r]);
                }
            }
        }
        simd.reduce_min_f64s(smallest)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use pulp::Arch;

    use super::*;

    /// A few distinct coordinates, so that many samples are equally near; or arbitrary ones; or steps from one sample
    /// to the next, so that most segments are apart.
    fn states(dim: usize) -> impl Strategy<Value = DMatrix<f64>> {
        let coordinate = prop_oneof![(-2..3).prop_map(f64::from), -1.0..1.0];
        (1usize..100, any::<bool>()).prop_flat_map(move |(n, walks)| {
            vec(coordinate.clone(), n * dim).prop_map(move |mut values| {
                (dim..if walks { values.len() } else { 0 })
                    .for_each(|at| values[at] = values[at - dim] + 0.2 * values[at]);
                DMatrix::from_vec(dim, n, values)
            })
        })
    }

    fn two_trajectories() -> impl Strategy<Value = (DMatrix<f64>, DMatrix<f64>)> {
        (1usize..9).prop_flat_map(|dim| (states(dim), states(dim)))
    }

    /// Every kind of vector instruction of this machine.
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
        let nearest_to = |m: usize| {
            let all: Vec<f64> = (0..states.ncols()).map(|i| distance(i, m)).collect();
            let least = all.iter().copied().fold(f64::INFINITY, f64::min);
            (least, all.iter().position(|&d| d == least).unwrap() as f64)
        };
        (0..to.ncols()).map(nearest_to).collect()
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
                let [tiles, others] = [&one, &other].map(|states| Tiles::new(states, arch));
                let mut search = BlockSearch::new(&tiles, f64::INFINITY);
                let smallest = search.run(&others);
                // All bits agree, because sums have the same order on every machine.
                let of_one = nearest(&other, &one);
                prop_assert_eq!(&found(&search.of_rows, one.ncols()), &of_one);
                prop_assert_eq!(found(&search.of_columns, other.ncols()), nearest(&one, &other));
                prop_assert_eq!(smallest, of_one.iter().fold(f64::INFINITY, |least, (d, _)| least.min(*d)));
            }
        }

        #[test]
        fn finds_the_same_within_the_radius((one, other) in two_trajectories(), limit in prop_oneof![0.0..1.0, 0.0..20.0]) {
            for arch in kinds() {
                let [tiles, others] = [&one, &other].map(|states| Tiles::new(states, arch));
                let mut search = BlockSearch::new(&tiles, limit);
                let smallest = search.run(&others);
                let [of_one, of_other] = [nearest(&other, &one), nearest(&one, &other)];
                let least = of_one.iter().fold(f64::INFINITY, |least, (d, _)| least.min(*d));
                prop_assert!(if least <= limit { smallest == least } else { smallest > limit }, "{smallest} {least}");
                let all = [(&search.of_rows, of_one), (&search.of_columns, of_other)];
                for (minima, nearest) in all {
                    for (found, nearest) in found(minima, nearest.len()).into_iter().zip(nearest) {
                        prop_assert!(if nearest.0 <= limit { found == nearest } else { found.0 > limit }, "{found:?}");
                    }
                }
            }
        }
    }
}
