//! A stretch of samples that all fields of an output learn from, one field after the other.

use lanes::{LANES, Lanes, Number, Register};
use nalgebra::DVectorView;
use pulp::Simd;

use crate::Metric;
use crate::settings::Settings;

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

/// Where a field is and how wide it is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Shape {
    kind: Metric,
    n_in: usize,
    /// Padded.
    pub(crate) centre: Vec<f64>,
    /// The diagonal of D, or the upper triangle of M, row after row.
    elements: Vec<f64>,
}

impl Shape {
    /// A row of `width`; the metric is yet to come.
    pub(crate) fn new(settings: &Settings, centre: &[f64]) -> Self {
        Shape {
            kind: settings.params.metric,
            n_in: settings.n_in,
            centre: centre.to_vec(),
            elements: vec![0.0; settings.shape_len()],
        }
    }

    /// Takes over M, given in rows of `width` dimensions; every `lanes`-th number belongs to this field.
    #[inline(always)]
    pub(crate) fn set_metric(&mut self, m: &[f64], width: usize, lanes: usize) {
        if self.kind == Metric::Diagonal {
            for (d, &m) in self.elements.iter_mut().zip(m.iter().step_by(lanes)) {
                *d = m * m;
            }
            return;
        }
        let mut elements = self.elements.iter_mut();
        for i in 0..self.n_in {
            for (column, element) in (i..self.n_in).zip(&mut elements) {
                *element = m[(column * width + i) * lanes];
            }
        }
    }

    /// Squared distances of the samples of part `part` of a block, summed as in the activation table.
    #[inline(always)]
    fn distance<S: Simd>(&self, simd: S, block: &[Lanes], part: usize) -> Register<S> {
        let mut q = Register::splat(simd, 0.0);
        if self.kind == Metric::Diagonal {
            for ((x, &c), &d) in block.iter().zip(&self.centre).zip(&self.elements) {
                let dx = Register::load(simd, x, part) - c;
                q += dx * dx * d;
            }
            return q;
        }
        let mut elements = self.elements.iter();
        for i in 0..block.len() {
            let mut t = Register::splat(simd, 0.0);
            for ((x, &c), &m) in block[i..].iter().zip(&self.centre[i..]).zip(&mut elements) {
                t += (Register::load(simd, x, part) - c) * m;
            }
            q += t * t;
        }
        q
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

    /// The first sample from `start` on, before `end`, closer than the radius, and its squared distance. The order of
    /// the sum is the activation table's.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &self,
        simd: S,
        shape: &Shape,
        (start, end): (usize, usize),
        squared_radius: f64,
    ) -> Option<(usize, f64)> {
        let n = S::F64_LANES;
        let mut first = start / n * n;
        let near = Register::splat(simd, squared_radius);
        while first < end {
            let block = &self.blocks[first / LANES * self.n_in..][..self.n_in];
            let q = shape.distance(simd, block, first % LANES / n);
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
