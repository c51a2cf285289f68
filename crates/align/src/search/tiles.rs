#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use super::boxes::Boxes;

/// Number of rows of one trajectory that share one load of the other's coordinates.
pub(crate) const ROWS: usize = 4;

/// The states of one trajectory, laid out for comparison with those of others by the vectors of one kind of machine.
#[derive(Debug)]
pub(crate) struct Tiles {
    pub(crate) arch: Arch,
    pub(crate) dim: usize,
    pub(crate) n_samples: usize,
    /// As columns: tiles with as many samples as a vector has lanes; a tile holds one vector per dimension. The last
    /// tile is padded with infinity, which is never nearest.
    pub(crate) columns: Vec<f64>,
    /// As rows: groups of `ROWS`; for each group and each dimension, one coordinate per row. The last group is padded
    /// with its last state, because a repeated row is never strictly nearer.
    pub(crate) rows: Vec<[f64; ROWS]>,
    /// The boxes of the segments.
    pub(crate) boxes: Boxes,
}

impl Tiles {
    /// From states (n, N), one column per sample.
    pub(crate) fn new(states: &DMatrix<f64>, arch: Arch) -> Self {
        let (dim, n_samples) = states.shape();
        let (columns, rows, boxes) = (columns(states, arch.dispatch(LaneCount)), rows(states), Boxes::new(states));
        Tiles { arch, dim, n_samples, columns, rows, boxes }
    }
}

fn columns(states: &DMatrix<f64>, lanes: usize) -> Vec<f64> {
    let (dim, n_samples) = states.shape();
    let mut columns = vec![f64::INFINITY; n_samples.next_multiple_of(lanes) * dim];
    for (sample, state) in states.column_iter().enumerate() {
        let first = (sample / lanes) * lanes * dim + sample % lanes;
        let places = columns[first..].iter_mut().step_by(lanes);
        places.zip(state.iter()).for_each(|(place, &value)| *place = value);
    }
    columns
}

fn rows(states: &DMatrix<f64>) -> Vec<[f64; ROWS]> {
    let last = states.ncols() - 1;
    let group = |first| (0..states.nrows()).map(move |c| std::array::from_fn(|r| states[(c, last.min(first + r))]));
    (0..=last).step_by(ROWS).flat_map(group).collect()
}

struct LaneCount;

impl WithSimd for LaneCount {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> usize {
        S::F64_LANES
    }
}
