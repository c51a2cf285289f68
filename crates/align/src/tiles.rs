#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

/// Rows of one trajectory that share one load of the other's coordinates.
pub(crate) const ROWS: usize = 4;

/// The states of one trajectory in tiles of as many samples as a vector has lanes: a tile holds one vector for each
/// dimension. The last tile is filled up with infinity, which is nobody's nearest.
#[derive(Debug)]
pub(crate) struct Tiles {
    pub(crate) coordinates: Vec<f64>,
    pub(crate) n_samples: usize,
}

impl Tiles {
    /// Tiles for the vectors of one kind of machine.
    pub(crate) fn new(positions: &DMatrix<f64>, arch: Arch) -> Self {
        let (dim, n_samples) = positions.shape();
        let lanes = arch.dispatch(LaneCount);
        let mut coordinates = vec![f64::INFINITY; n_samples.next_multiple_of(lanes) * dim];
        for (sample, state) in positions.column_iter().enumerate() {
            let first = (sample / lanes) * lanes * dim + sample % lanes;
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

/// The states of one trajectory in groups of `ROWS`: for each group and each dimension one coordinate a row. The last
/// group is filled up with its last state: a repeated row is never strictly nearer.
pub(crate) fn row_groups(states: &DMatrix<f64>) -> Vec<[f64; ROWS]> {
    let last = states.ncols() - 1;
    let group = |first| (0..states.nrows()).map(move |c| std::array::from_fn(|r| states[(c, last.min(first + r))]));
    (0..=last).step_by(ROWS).flat_map(group).collect()
}
