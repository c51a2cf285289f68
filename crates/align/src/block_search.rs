//! The innermost loop of the alignment: all squared distances between the samples of two trajectories, of which only
//! the smallest of every row and every column is kept.

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use crate::lanes::{LANES, Lanes, groups_of};

/// Rows that share one load of the other trajectory's coordinates.
const ROWS: usize = 4;

/// The states of one trajectory in tiles of as many samples as a vector has lanes: a tile holds one vector for each
/// dimension. The last tile is filled up with infinity, which is nobody's nearest.
#[derive(Debug)]
pub(crate) struct Tiles {
    coordinates: Vec<f64>,
    n_samples: usize,
}

impl Tiles {
    pub(crate) fn new(positions: &DMatrix<f64>) -> Self {
        let (n_states, n_samples) = positions.shape();
        let lanes = Arch::new().dispatch(LaneCount);
        let padded = n_samples.next_multiple_of(lanes);
        let mut coordinates = vec![f64::INFINITY; padded * n_states];
        for (sample, state) in positions.column_iter().enumerate() {
            let first = (sample / lanes) * lanes * n_states + sample % lanes;
            let places = coordinates[first..].iter_mut().step_by(lanes);
            places.zip(state.iter()).for_each(|(place, &value)| *place = value);
        }
        Tiles { coordinates, n_samples }
    }
}

struct LaneCount;

impl WithSimd for LaneCount {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> usize {
        S::F64_LANES
    }
}

/// The nearest samples found so far; indices are exact in f64, and compare and blend like the distances.
#[derive(Debug, Default)]
pub(crate) struct Minima {
    /// Squared distances, filled up with infinity.
    pub(crate) distances: Vec<Lanes>,
    /// Whole numbers.
    pub(crate) samples: Vec<Lanes>,
}

impl Minima {
    fn reset(&mut self, count: usize) {
        self.distances.clear();
        self.distances.resize(groups_of(count), [f64::INFINITY; LANES]);
        self.samples.clear();
        self.samples.resize(groups_of(count), [0.0; LANES]);
    }
}

/// Compares one trajectory, sample by sample, with others.
#[derive(Debug)]
pub(crate) struct BlockSearch<'a> {
    rows: &'a DMatrix<f64>,
    row_groups: Vec<[f64; ROWS]>,
    arch: Arch,
    /// For the samples of this trajectory, the nearest of the other.
    pub(crate) of_rows: Minima,
    /// For the samples of the other trajectory, the nearest of this.
    pub(crate) of_columns: Minima,
}

impl<'a> BlockSearch<'a> {
    pub(crate) fn new(rows: &'a DMatrix<f64>) -> Self {
        let (of_rows, of_columns) = (Minima::default(), Minima::default());
        BlockSearch { rows, row_groups: row_groups(rows), arch: Arch::new(), of_rows, of_columns }
    }

    /// Finds what is nearest for the samples of both trajectories, and the smallest squared distance of all.
    pub(crate) fn run(&mut self, other: &Tiles) -> f64 {
        self.of_rows.reset(self.rows.ncols());
        self.of_columns.reset(other.n_samples);
        self.arch.dispatch(Block {
            n_states: self.rows.nrows(),
            n_rows: self.rows.ncols(),
            row_groups: &self.row_groups,
            other: &other.coordinates,
            of_rows: &mut self.of_rows,
            of_columns: &mut self.of_columns,
        })
    }
}

/// The states in groups of `ROWS`, for each group and each dimension one coordinate a row. The last group is filled up
/// with its last state: a repeated row is never strictly nearer.
fn row_groups(states: &DMatrix<f64>) -> Vec<[f64; ROWS]> {
    let last = states.ncols() - 1;
    let group = |first| (0..states.nrows()).map(move |c| std::array::from_fn(|r| states[(c, last.min(first + r))]));
    (0..=last).step_by(ROWS).flat_map(group).collect()
}

/// One pair of trajectories: rows are samples of the one, vector lanes samples of the other.
struct Block<'a> {
    n_states: usize,
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
        match self.n_states {
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

        for (group, rows) in self.row_groups.chunks_exact(self.n_states).enumerate() {
            let index: [usize; ROWS] = std::array::from_fn(|r| (ROWS * group + r).min(self.n_rows - 1));
            let names = index.map(|i| simd.splat_f64s(i as f64));
            let mut nearest = [infinity; ROWS];
            let mut samples = [infinity; ROWS];
            let mut here = lanes;
            let columns = column_distances.iter_mut().zip(column_samples.iter_mut());
            for (tile, (column_distance, column_sample)) in tiles.chunks_exact(self.n_states).zip(columns) {
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
