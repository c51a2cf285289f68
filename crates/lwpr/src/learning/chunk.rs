//! A range of samples from which all fields of an output learn, one field after the other.

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
    /// For each block of eight samples, one array per dimension; beyond the end everything is infinitely far away.
    blocks: Vec<Lanes>,
}

/// Maximum dimension in which batches go field by field ([`Settings::side_by_side`]), and maximum number of values of a
/// metric.
const MOST: usize = 6;
const MOST_ELEMENTS: usize = MOST * (MOST + 1) / 2;

/// Centre and metric of a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shape {
    kind: Metric,
    n_in: usize,
    centre: [f64; MOST],
    /// The diagonal of D, or the upper triangle of M, row by row.
    elements: [f64; MOST_ELEMENTS],
}

impl Shape {
    /// The shape without its metric, which is set later.
    pub(crate) fn new(settings: &Settings, centre: &[f64]) -> Self {
        let n_in = settings.n_in;
        let mut shape =
            Shape { kind: settings.params.metric, n_in, centre: [0.0; MOST], elements: [0.0; MOST_ELEMENTS] };
        shape.centre[..n_in].copy_from_slice(&centre[..n_in]);
        shape
    }

    /// Copies M, given in rows of `width` dimensions; every `lanes`-th number belongs to this field.
    #[inline(always)]
    pub(crate) fn set_metric(&mut self, m: &[f64], width: usize, lanes: usize) {
        match (self.kind, self.n_in) {
            (Metric::Diagonal, 2) => self.set_metric_of((Metric::Diagonal, 2), m, 2, lanes),
            (Metric::Full, 2) => self.set_metric_of((Metric::Full, 2), m, 2, lanes),
            kind => self.set_metric_of(kind, m, width, lanes),
        }
    }

    #[inline(always)]
    fn set_metric_of(&mut self, (kind, n): (Metric, usize), m: &[f64], width: usize, lanes: usize) {
        if kind == Metric::Diagonal {
            for (i, d) in self.elements[..n].iter_mut().enumerate() {
                *d = m[i * lanes] * m[i * lanes];
            }
            return;
        }
        let mut elements = self.elements.iter_mut();
        for i in 0..n {
            for (column, element) in (i..n).zip(&mut elements) {
                *element = m[(column * width + i) * lanes];
            }
        }
    }

    /// Squared distances of the samples of part `part` of a block, summed in the order of the activation table.
    #[inline(always)]
    fn distance<S: Simd>(&self, simd: S, kind: Metric, block: &[Lanes], part: usize) -> Register<S> {
        let mut q = Register::splat(simd, 0.0);
        if kind == Metric::Diagonal {
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
    /// Replaces the samples, columns of length `n_in`.
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

    /// The first sample from `start` on, before `end`, closer than the radius, and its squared distance. The sum has
    /// the order of the activation table. As there, two dimensions are a constant for the compiler.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &self,
        simd: S,
        shape: &Shape,
        (start, end): (usize, usize),
        squared_radius: f64,
    ) -> Option<(usize, f64)> {
        let (span, radius) = ((start, end), squared_radius);
        match (shape.kind, self.n_in) {
            (Metric::Diagonal, 2) => self.find_with(simd, (Metric::Diagonal, 2), shape, span, radius),
            (Metric::Full, 2) => self.find_with(simd, (Metric::Full, 2), shape, span, radius),
            kind => self.find_with(simd, kind, shape, span, radius),
        }
    }

    /// [`find`](Self::find) for one kind of metric and one number of dimensions, which may be constants.
    #[inline(always)]
    fn find_with<S: Simd>(
        &self,
        simd: S,
        (kind, n_in): (Metric, usize),
        shape: &Shape,
        (start, end): (usize, usize),
        squared_radius: f64,
    ) -> Option<(usize, f64)> {
        let n = S::F64_LANES;
        let mut first = start / n * n;
        let near = Register::splat(simd, squared_radius);
        while first < end {
            let block = &self.blocks[first / LANES * n_in..][..n_in];
            let q = shape.distance(simd, kind, block, first % LANES / n);
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
