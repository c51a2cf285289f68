//! The innermost loop of the alignment: all squared distances between the samples of two trajectories, of which only
//! the smallest of every row and every column is kept.

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

/// Samples are padded to a multiple of the widest vector.
const WIDTH: usize = 8;
/// Rows that share one load of the other trajectory's coordinates.
const ROWS: usize = 4;

/// The states of one trajectory, one dimension after the other, each padded with infinity, which is nobody's nearest.
#[derive(Debug)]
pub(crate) struct Lanes {
    coordinates: Vec<f64>,
    n_samples: usize,
    padded: usize,
}

impl Lanes {
    pub(crate) fn new(positions: &DMatrix<f64>) -> Self {
        let n_samples = positions.ncols();
        let padded = n_samples.next_multiple_of(WIDTH);
        let mut coordinates = vec![f64::INFINITY; padded * positions.nrows()];
        for (row, lane) in positions.row_iter().zip(coordinates.chunks_exact_mut(padded)) {
            lane.iter_mut().zip(row.iter()).for_each(|(lane, &value)| *lane = value);
        }
        Lanes { coordinates, n_samples, padded }
    }
}

/// For each of some samples, the nearest sample of one trajectory.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Nearest {
    /// Squared distance to it.
    pub(crate) squared_distances: Vec<f64>,
    /// Its index; the lowest of those equally near.
    pub(crate) samples: Vec<u32>,
}

impl Nearest {
    fn new(squared_distances: &[f64], samples: &[u64]) -> Self {
        Nearest { squared_distances: squared_distances.to_vec(), samples: samples.iter().map(|&i| i as u32).collect() }
    }

    /// The smallest squared distance of all.
    pub(crate) fn smallest(&self) -> f64 {
        self.squared_distances.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Compares one trajectory, sample by sample, with others.
#[derive(Debug)]
pub(crate) struct BlockSearch<'a> {
    rows: &'a DMatrix<f64>,
    arch: Arch,
    row_minimum: Vec<f64>,
    row_sample: Vec<u64>,
    column_minimum: Vec<f64>,
    column_sample: Vec<u64>,
}

impl<'a> BlockSearch<'a> {
    pub(crate) fn new(rows: &'a DMatrix<f64>) -> Self {
        let n = rows.ncols();
        BlockSearch {
            rows,
            arch: Arch::new(),
            row_minimum: vec![0.0; n],
            row_sample: vec![0; n],
            column_minimum: Vec::new(),
            column_sample: Vec::new(),
        }
    }

    /// What is nearest in `other` to the samples of this trajectory, and in this trajectory to those of `other`.
    pub(crate) fn run(&mut self, other: &Lanes) -> (Nearest, Nearest) {
        self.column_minimum.clear();
        self.column_minimum.resize(other.padded, f64::INFINITY);
        self.column_sample.clear();
        self.column_sample.resize(other.padded, 0);
        self.arch.dispatch(Block {
            rows: self.rows.as_slice(),
            n_states: self.rows.nrows(),
            other: &other.coordinates,
            row_minimum: &mut self.row_minimum,
            row_sample: &mut self.row_sample,
            column_minimum: &mut self.column_minimum,
            column_sample: &mut self.column_sample,
        });
        (
            Nearest::new(&self.row_minimum, &self.row_sample),
            Nearest::new(&self.column_minimum[..other.n_samples], &self.column_sample[..other.n_samples]),
        )
    }
}

/// One pair of trajectories: rows are samples of the one, vector lanes samples of the other.
struct Block<'a> {
    rows: &'a [f64],
    n_states: usize,
    other: &'a [f64],
    row_minimum: &'a mut [f64],
    row_sample: &'a mut [u64],
    column_minimum: &'a mut [f64],
    column_sample: &'a mut [u64],
}

impl WithSimd for Block<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // A known number of dimensions unrolls the innermost loop.
        match self.n_states {
            1 => self.search::<S, 1>(simd),
            2 => self.search::<S, 2>(simd),
            3 => self.search::<S, 3>(simd),
            6 => self.search::<S, 6>(simd),
            _ => self.search::<S, 0>(simd),
        }
    }
}

impl Block<'_> {
    /// `N` is the number of dimensions, or 0 where it is known at run time only.
    #[inline(always)]
    fn search<S: Simd, const N: usize>(self, simd: S) {
        let n_states = if N == 0 { self.n_states } else { N };
        let n_rows = self.row_minimum.len();
        let other = S::as_simd_f64s(self.other).0;
        let (column_minimum, column_sample) =
            (S::as_mut_simd_f64s(self.column_minimum).0, S::as_mut_simd_u64s(self.column_sample).0);
        let n_vectors = column_minimum.len();
        let other: &[S::f64s] = &other[..n_vectors * n_states];
        let column_sample = &mut column_sample[..n_vectors];

        for first in (0..n_rows).step_by(ROWS) {
            // Rows beyond the last repeat it: a repeated row is never strictly nearer.
            let index: [usize; ROWS] = std::array::from_fn(|r| (first + r).min(n_rows - 1));
            let row: [&[f64]; ROWS] = index.map(|i| &self.rows[i * n_states..(i + 1) * n_states]);
            let name = index.map(|i| simd.splat_u64s(i as u64));
            let mut minimum = [simd.splat_f64s(f64::INFINITY); ROWS];
            let mut vector_of = [simd.splat_u64s(0); ROWS];
            for v in 0..n_vectors {
                let mut distance = [simd.splat_f64s(0.0); ROWS];
                for c in 0..n_states {
                    let y = other[c * n_vectors + v];
                    for r in 0..ROWS {
                        let difference = simd.sub_f64s(simd.splat_f64s(row[r][c]), y);
                        distance[r] = simd.add_f64s(distance[r], simd.mul_f64s(difference, difference));
                    }
                }
                let here = simd.splat_u64s(v as u64);
                let (mut nearest, mut sample) = (column_minimum[v], column_sample[v]);
                for r in 0..ROWS {
                    let nearer = simd.less_than_f64s(distance[r], nearest);
                    nearest = simd.select_f64s(nearer, distance[r], nearest);
                    sample = simd.select_u64s(nearer, name[r], sample);
                    let nearer = simd.less_than_f64s(distance[r], minimum[r]);
                    minimum[r] = simd.select_f64s(nearer, distance[r], minimum[r]);
                    vector_of[r] = simd.select_u64s(nearer, here, vector_of[r]);
                }
                column_minimum[v] = nearest;
                column_sample[v] = sample;
            }
            for r in 0..ROWS {
                (self.row_minimum[index[r]], self.row_sample[index[r]]) = first_minimum::<S>(minimum[r], vector_of[r]);
            }
        }
    }
}

/// The smallest of all lanes, and the lowest sample that attains it.
#[inline(always)]
fn first_minimum<S: Simd>(minimum: S::f64s, vector_of: S::u64s) -> (f64, u64) {
    let minimum: &[f64] = pulp::bytemuck::cast_slice(std::slice::from_ref(&minimum));
    let vector_of: &[u64] = pulp::bytemuck::cast_slice(std::slice::from_ref(&vector_of));
    let lanes = minimum.iter().zip(vector_of).enumerate();
    lanes.fold((f64::INFINITY, u64::MAX), |best, (lane, (&distance, &vector))| {
        let sample = vector * S::F64_LANES as u64 + lane as u64;
        if distance < best.0 || (distance == best.0 && sample < best.1) { (distance, sample) } else { best }
    })
}
