//! A stretch of samples that all fields of an output learn from, one field after the other.

use nalgebra::DVectorView;
use pulp::Simd;

use crate::settings::Settings;
use lanes::{LANES, Lanes, Number, Register};

/// Normalised inputs, sample by sample and eight samples side by side.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chunk {
    pub(crate) n: usize,
    n_in: usize,
    width: usize,
    rows: Vec<f64>,
    /// For each block of eight samples, one array a dimension; beyond the end everything is infinitely far away.
    blocks: Vec<Lanes>,
}

/// Centre and diagonal D of a field, padded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shape {
    pub(crate) centre: Vec<f64>,
    pub(crate) d: Vec<f64>,
}

impl Shape {
    /// A row of `width`; D is yet to come.
    pub(crate) fn new(centre: &[f64]) -> Self {
        Shape { centre: centre.to_vec(), d: vec![0.0; centre.len()] }
    }

    /// Takes over D = M².
    #[inline(always)]
    pub(crate) fn set_metric<'a>(&mut self, m: impl Iterator<Item = &'a f64>) {
        for (d, &m) in self.d.iter_mut().zip(m) {
            *d = m * m;
        }
    }
}

impl Chunk {
    /// Takes in other samples, columns of length `n_in`.
    pub(crate) fn fill<'a>(
        &mut self,
        settings: &Settings,
        columns: impl ExactSizeIterator<Item = DVectorView<'a, f64>>,
    ) {
        let (n_in, width) = (settings.n_in, settings.width);
        self.n = columns.len();
        self.n_in = n_in;
        self.width = width;
        self.rows.clear();
        self.rows.resize(self.n * width, 0.0);
        self.blocks.clear();
        self.blocks.resize(self.n.div_ceil(LANES) * n_in, [f64::INFINITY; LANES]);
        for (sample, x) in columns.enumerate() {
            for (i, (x, norm)) in x.iter().zip(&settings.norm_in).enumerate() {
                self.rows[sample * width + i] = x / norm;
                self.blocks[sample / LANES * n_in + i][sample % LANES] = x / norm;
            }
        }
    }

    /// The padded sample.
    #[inline(always)]
    pub(crate) fn row(&self, sample: usize) -> &[f64] {
        &self.rows[sample * self.width..][..self.width]
    }

    /// The first sample from `start` on, before `end`, that is closer than `reach`, and its squared distance. The order of
    /// the sum is the activation table's.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &self,
        simd: S,
        shape: &Shape,
        (start, end): (usize, usize),
        reach: f64,
    ) -> Option<(usize, f64)> {
        let n = S::F64_LANES;
        let mut first = start / n * n;
        let near = Register::splat(simd, reach);
        while first < end {
            let block = &self.blocks[first / LANES * self.n_in..][..self.n_in];
            let mut q = Register::splat(simd, 0.0);
            for ((x, &c), &d) in block.iter().zip(&shape.centre).zip(&shape.d) {
                let dx = Register::of(simd, Register::<S>::elements(x)[first % LANES / n]) - c;
                q += dx * dx * d;
            }
            let lane = q.first_below(near, start.saturating_sub(first));
            if lane < n {
                let sample = first + lane;
                return (sample < end).then(|| (sample, q.get(lane)));
            }
            first += n;
        }
        None
    }
}
