#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use nalgebra::{DMatrix, DVectorView};
use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};

use crate::kernel::block::length;
use crate::kernel::chunks::{CHUNK, Chunk, Chunks};
use crate::kernel::covariance::Covariance;
use crate::kernel::family::Family;
use crate::kernel::shape::{Radial, Shape};

/// One term of the direct GP's prior, the same for each component of the velocity. Distances are in scaled coordinates
/// z; a scale s stands for the length s √(2n).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DirectBlock {
    /// 1.
    Constant,
    /// zᵀz'/n.
    Linear,
    /// (zᵀz')²/n².
    Quadratic,
    /// A shape at a scale.
    Shape(Shape, f64),
}

impl DirectBlock {
    /// Covariance of a component at `z` and `z2`, both (n).
    pub fn covariance(self, z: DVectorView<'_, f64>, z2: DVectorView<'_, f64>) -> f64 {
        let dim = z.len() as f64;
        match self {
            DirectBlock::Constant => 1.0,
            DirectBlock::Linear => z.dot(&z2) / dim,
            DirectBlock::Quadratic => (z.dot(&z2) / dim).powi(2),
            DirectBlock::Shape(shape, scale) => {
                Radial { shape, length: length(scale, z.len()) }.value_at((z - z2).norm_squared())
            }
        }
    }
}

impl Family {
    /// The family's blocks in the direct GP: constant, linear, quadratic, and its shape at five scales.
    pub fn direct_blocks(self) -> Vec<DirectBlock> {
        let scales = match self {
            Family::Smooth => [0.125, 0.25, 0.5, 1.0, 2.0],
            Family::Medium | Family::Rough => [0.25, 0.5, 1.0, 2.0, 4.0],
        };
        let trend = [DirectBlock::Constant, DirectBlock::Linear, DirectBlock::Quadratic];
        trend.into_iter().chain(scales.map(|scale| DirectBlock::Shape(self.shape(), scale))).collect()
    }
}

/// Covariances of a velocity component at scaled states `z`, (n, M).
#[derive(Debug)]
pub(crate) struct DirectCovariance<'a> {
    pub(crate) blocks: &'a [DirectBlock],
    pub(crate) z: &'a DMatrix<f64>,
}

impl Covariance for DirectCovariance<'_> {
    fn n_blocks(&self) -> usize {
        self.blocks.len()
    }

    fn each_among(&self, rows: &[usize]) -> Vec<DMatrix<f64>> {
        let z = self.z.select_columns(rows);
        let alone = |block| DirectCovariance { blocks: std::slice::from_ref(block), z: &z }.sum(&[1.0]);
        self.blocks.iter().map(alone).collect()
    }

    fn sum(&self, amplitudes: &[f64]) -> DMatrix<f64> {
        let states = Chunks::new(self.z);
        let count = self.z.ncols();
        let mut matrix = DMatrix::zeros(count, count);
        for (row, mut column) in matrix.column_iter_mut().enumerate() {
            for chunk in row / CHUNK..states.len() {
                let point = self.z.column(row);
                let values = covariances_with(point.as_slice(), states.get(chunk), self.blocks, amplitudes);
                let first = chunk * CHUNK;
                let place = &mut column.as_mut_slice()[first..count.min(first + CHUNK)];
                place.copy_from_slice(&values[..place.len()]);
            }
        }
        matrix
    }

    fn with<'a>(&'a self, rows: &[usize], amplitudes: &'a [f64]) -> impl Fn(usize, &mut [f64]) + Sync + 'a {
        let states = Chunks::new(&self.z.select_columns(rows));
        move |row, covariances| {
            let z = self.z.column(row);
            for (chunk, place) in covariances.chunks_mut(CHUNK).enumerate() {
                let values = covariances_with(z.as_slice(), states.get(chunk), self.blocks, amplitudes);
                place.copy_from_slice(&values[..place.len()]);
            }
        }
    }

    fn variance(&self, row: usize, amplitudes: &[f64]) -> f64 {
        let z = self.z.column(row);
        self.blocks.iter().zip(amplitudes).map(|(block, amplitude)| amplitude * block.covariance(z, z)).sum()
    }
}

/// Σ a_b k_b(z, z') for a chunk of rows z'.
pub(crate) fn covariances_with(z: &[f64], states: &[Chunk], blocks: &[DirectBlock], amplitudes: &[f64]) -> Chunk {
    Arch::new().dispatch(CovariancesWith { z, states, blocks, amplitudes })
}

struct CovariancesWith<'a> {
    z: &'a [f64],
    states: &'a [Chunk],
    blocks: &'a [DirectBlock],
    amplitudes: &'a [f64],
}

impl WithSimd for CovariancesWith<'_> {
    type Output = Chunk;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Chunk {
        combined(|k| self.z[k], self.states, self.blocks, self.amplitudes)
    }
}

/// As [`covariances_with`]; `z` returns one coordinate at a time.
#[inline(always)]
pub(crate) fn combined(
    z: impl Fn(usize) -> f64,
    states: &[Chunk],
    blocks: &[DirectBlock],
    amplitudes: &[f64],
) -> Chunk {
    let dim = states.len();
    let [mut squared, mut product] = [[0.0; CHUNK]; 2];
    for (k, states) in states.iter().enumerate() {
        let z = z(k);
        for lane in 0..CHUNK {
            let apart = z - states[lane];
            squared[lane] += apart * apart;
            product[lane] += z * states[lane];
        }
    }
    let mut values = [0.0; CHUNK];
    for (&block, &amplitude) in blocks.iter().zip(amplitudes) {
        if let DirectBlock::Shape(shape, scale) = block {
            Radial { shape, length: length(scale, dim) }.add_values(amplitude, &squared, &mut values);
        }
    }
    let [constant, linear, quadratic] = trend(blocks, amplitudes, dim);
    for lane in 0..CHUNK {
        values[lane] += constant + product[lane] * (linear + quadratic * product[lane]);
    }
    values
}

/// Factors of 1, of zᵀz' and of (zᵀz')².
#[inline(always)]
pub(crate) fn trend(blocks: &[DirectBlock], amplitudes: &[f64], dim: usize) -> [f64; 3] {
    let mut factors = [0.0; 3];
    for (&block, &amplitude) in blocks.iter().zip(amplitudes) {
        match block {
            DirectBlock::Constant => factors[0] += amplitude,
            DirectBlock::Linear => factors[1] += amplitude / dim as f64,
            DirectBlock::Quadratic => factors[2] += amplitude / (dim * dim) as f64,
            DirectBlock::Shape(..) => {}
        }
    }
    factors
}
