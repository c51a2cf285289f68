#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use nalgebra::{DMatrix, DVectorView};
use pulp::{Arch, Simd, WithSimd};

use crate::kernel::block::{Block, length};
use crate::kernel::chunks::{CHUNK, Chunk, Chunks};
use crate::kernel::covariance::Covariance;
use crate::kernel::shape::{Radial, Shape, add_divergence_free};

/// Covariances (S3) of slopes along the directions `n`, (n, M), at scaled states and contexts `z`, (n + p, M).
#[derive(Debug)]
pub(crate) struct SlopeCovariance<'a> {
    pub(crate) blocks: &'a [Block],
    pub(crate) z: &'a DMatrix<f64>,
    pub(crate) n: &'a DMatrix<f64>,
}

impl Covariance for SlopeCovariance<'_> {
    fn n_blocks(&self) -> usize {
        self.blocks.len()
    }

    fn each_among(&self, rows: &[usize]) -> Vec<DMatrix<f64>> {
        let (z, n) = (self.z.select_columns(rows), self.n.select_columns(rows));
        let among = SlopeCovariance { blocks: self.blocks, z: &z, n: &n };
        let alone = |block: usize| {
            let amplitudes: Vec<_> = (0..self.blocks.len()).map(|b| f64::from(u8::from(b == block))).collect();
            among.sum(&amplitudes)
        };
        (0..self.blocks.len()).map(alone).collect()
    }

    fn sum(&self, amplitudes: &[f64]) -> DMatrix<f64> {
        let (states, directions) = (Chunks::new(self.z), Chunks::new(self.n));
        let count = self.z.ncols();
        let mut matrix = DMatrix::zeros(count, count);
        for (row, mut column) in matrix.column_iter_mut().enumerate() {
            let point = (self.z.column(row), self.n.column(row));
            for chunk in row / CHUNK..states.len() {
                let rows = (states.get(chunk), directions.get(chunk));
                let values = slopes_with(point, rows, self.blocks, amplitudes);
                let first = chunk * CHUNK;
                let place = &mut column.as_mut_slice()[first..count.min(first + CHUNK)];
                place.copy_from_slice(&values[..place.len()]);
            }
            column[row] += own_rounding(self.z.column(row).as_slice(), self.blocks, amplitudes);
        }
        matrix
    }

    fn with<'a>(&'a self, rows: &[usize], amplitudes: &'a [f64]) -> impl Fn(usize, &mut [f64]) + Sync + 'a {
        let (states, directions) =
            (Chunks::new(&self.z.select_columns(rows)), Chunks::new(&self.n.select_columns(rows)));
        move |row, covariances| {
            let point = (self.z.column(row), self.n.column(row));
            for (chunk, place) in covariances.chunks_mut(CHUNK).enumerate() {
                let values = slopes_with(point, (states.get(chunk), directions.get(chunk)), self.blocks, amplitudes);
                place.copy_from_slice(&values[..place.len()]);
            }
        }
    }

    fn variance(&self, row: usize, amplitudes: &[f64]) -> f64 {
        let (z, n) = (self.z.column(row), self.n.column(row));
        self.blocks.iter().zip(amplitudes).map(|(block, amplitude)| amplitude * block.slope_slope(z, n, z, n)).sum()
    }
}

/// Loss on the diagonal of a Matérn 3/2 block: with fused products, rounding leaves the squared distance |z|² − 2zᵀz + |z|²
/// slightly above 0, and g decays with the distance itself, so that 1e-16 becomes 1e-8.
///
/// The reference values contain this loss. Other shapes decay with the square and are not affected.
fn own_rounding(z: &[f64], blocks: &[Block], amplitudes: &[f64]) -> f64 {
    let plain: f64 = z.iter().map(|z| z * z).sum();
    let fused = z.iter().fold(0.0, |sum: f64, z| z.mul_add(*z, sum));
    let squared = (2.0 * (plain - fused)).max(0.0);
    let loss = |(&block, &amplitude): (&Block, &f64)| match block {
        Block::Potential(shape @ Shape::Matern32, scale) => {
            let radial = Radial { shape, length: length(scale, z.len()) };
            amplitude * (radial.slopes_at(squared).0 - 1.0)
        }
        _ => 0.0,
    };
    blocks.iter().zip(amplitudes).map(loss).sum()
}

/// Covariances of the slope along n at z with those of a chunk of rows.
pub(crate) fn slopes_with(
    point: (DVectorView<'_, f64>, DVectorView<'_, f64>),
    rows: (&[Chunk], &[Chunk]),
    blocks: &[Block],
    amplitudes: &[f64],
) -> Chunk {
    let (z, n) = (point.0.as_slice(), point.1.as_slice());
    Arch::new().dispatch(SlopesWith { z, n, states: rows.0, directions: rows.1, blocks, amplitudes })
}

struct SlopesWith<'a> {
    z: &'a [f64],
    n: &'a [f64],
    states: &'a [Chunk],
    directions: &'a [Chunk],
    blocks: &'a [Block],
    amplitudes: &'a [f64],
}

impl WithSimd for SlopesWith<'_> {
    type Output = Chunk;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Chunk {
        let mut squared = [0.0; CHUNK];
        let [mut nu, mut alpha, mut beta] = [[0.0; CHUNK]; 3];
        let [mut zz, mut nz, mut zn] = [[0.0; CHUNK]; 3];
        for (k, (&z, &n)) in self.z.iter().zip(self.n).enumerate() {
            let (states, directions) = (&self.states[k], &self.directions[k]);
            for lane in 0..CHUNK {
                let (z2, n2) = (states[lane], directions[lane]);
                let apart = z - z2;
                squared[lane] += apart * apart;
                nu[lane] += n * n2;
                alpha[lane] += n * apart;
                beta[lane] += n2 * apart;
                zz[lane] += z * z2;
                nz[lane] += n * z2;
                zn[lane] += z * n2;
            }
        }
        // Rotation concerns the state only.
        let (moving, xx) = (squared, zz);
        let dim = self.n.len();
        for (&z, states) in self.z[dim..].iter().zip(&self.states[dim..]) {
            for lane in 0..CHUNK {
                let apart = z - states[lane];
                squared[lane] += apart * apart;
                zz[lane] += z * states[lane];
            }
        }
        let sizes = (dim, self.z.len());
        let (g, h) = falling(self.blocks, self.amplitudes, sizes, (&squared, &moving));
        let [linear, quadratic, skew] = trend(self.blocks, self.amplitudes, sizes);
        let mut values = [0.0; CHUNK];
        for lane in 0..CHUNK {
            let (turned, along) = (nu[lane] * zz[lane], nz[lane] * zn[lane]);
            let rotated = nu[lane] * xx[lane] - along;
            values[lane] = (g[lane] * nu[lane] - h[lane] * alpha[lane] * beta[lane])
                + (linear * nu[lane] + quadratic * (turned + along) + skew * rotated);
        }
        values
    }
}

/// Σ a_b g_b and Σ a_b h_b over the blocks that decay with distance, for state and context, and for the state alone, (n) of (n +
/// p).
#[inline(always)]
pub(crate) fn falling(
    blocks: &[Block],
    amplitudes: &[f64],
    (moving_dim, dim): (usize, usize),
    (squared_distances, moving): (&Chunk, &Chunk),
) -> (Chunk, Chunk) {
    let [mut g, mut h] = [[0.0; CHUNK]; 2];
    for (&block, &amplitude) in blocks.iter().zip(amplitudes) {
        if amplitude == 0.0 {
            continue;
        }
        match block {
            Block::Potential(shape, scale) => {
                let radial = Radial { shape, length: length(scale, dim) };
                radial.add_slopes(amplitude, squared_distances, &mut g, &mut h);
            }
            Block::DivergenceFree(scale) => {
                let sizes = (length(scale, dim), moving_dim);
                add_divergence_free(sizes, amplitude, (squared_distances, moving), &mut g, &mut h);
            }
            Block::Linear | Block::Quadratic | Block::Skew => {}
        }
    }
    (g, h)
}

/// The factors of ν, of ν zᵀz' + (nᵀz')(n'ᵀz), and of their difference in the state alone.
#[inline(always)]
pub(crate) fn trend(blocks: &[Block], amplitudes: &[f64], (moving_dim, dim): (usize, usize)) -> [f64; 3] {
    let (moving_dim, dim) = (moving_dim as f64, dim as f64);
    let mut factors = [0.0; 3];
    for (&block, &amplitude) in blocks.iter().zip(amplitudes) {
        match block {
            Block::Linear => factors[0] += amplitude,
            Block::Quadratic => factors[1] += amplitude / (dim + 1.0),
            Block::Skew => factors[2] += amplitude / (moving_dim - 1.0).max(1.0),
            Block::Potential(..) | Block::DivergenceFree(_) => {}
        }
    }
    factors
}
