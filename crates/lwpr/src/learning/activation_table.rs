//! Centres and metrics of fields with few dimensions, eight side by side.

use lanes::{LANES, Lanes, Number, Register};
use pulp::Simd;

use crate::Metric;
use crate::field::Field;
use crate::settings::{Settings, padded};

/// Centres and metrics of all fields, in blocks of eight: for each dimension eight centres, then, in groups of eight, the
/// numbers that determine distances ([`distance`]).
///
/// With many dimensions the table is empty, and M is read from the fields themselves.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ActivationTable {
    pub(super) blocks: Vec<Lanes>,
}

impl ActivationTable {
    /// Stores field `k`, as a new last one or replacing the old one.
    pub(crate) fn set(&mut self, settings: &Settings, k: usize, field: &Field) {
        if !settings.narrow() {
            return;
        }
        let n = settings.n_in;
        let size = n + settings.shape_len();
        if k / LANES * size == self.blocks.len() {
            // Lanes without a field are infinitely far from everything.
            self.blocks.resize(self.blocks.len() + n, [f64::INFINITY; LANES]);
            self.blocks.resize(self.blocks.len() + size - n, [1.0; LANES]);
        }
        let block = &mut self.blocks[k / LANES * size..][..size];
        for (row, &c) in block.iter_mut().zip(field.centre(settings)) {
            row[k % LANES] = c;
        }
        self.set_metric((settings.params.metric, n), k, field.m(settings));
    }

    /// Copies M of field `k` after it has learnt. The shape is an argument so that it can be a constant.
    #[inline(always)]
    pub(crate) fn set_metric(&mut self, (metric, n): (Metric, usize), k: usize, m: &[f64]) {
        let (lane, size) = (k % LANES, n + metric.len(n));
        let rows = &mut self.blocks[k / LANES * size..][n..size];
        if metric == Metric::Diagonal {
            for (row, m) in rows.iter_mut().zip(m) {
                row[lane] = m * m;
            }
            return;
        }
        let mut rows = rows.iter_mut();
        for i in 0..n {
            for (column, row) in (i..n).zip(&mut rows) {
                row[lane] = m[column * padded(n) + i];
            }
        }
    }

    /// Removes the last field, number `k`.
    pub(crate) fn pop(&mut self, settings: &Settings, k: usize) {
        if !settings.narrow() {
            return;
        }
        let n = settings.n_in;
        let start = k / LANES * (n + settings.shape_len());
        if k.is_multiple_of(LANES) {
            self.blocks.truncate(start);
        } else {
            self.blocks[start..start + n].iter_mut().for_each(|centres| centres[k % LANES] = f64::INFINITY);
        }
    }
}

/// q = |M(x − c)|² of eight pairs of a sample and a field side by side, from the eight values of D for each dimension, or
/// with a full metric from the eight values of each element in the upper triangle of M, row by row.
#[inline(always)]
pub(super) fn distance<S: Simd>(
    simd: S,
    shape: Metric,
    (dx, metric): (&[Lanes], &[Lanes]),
    part: usize,
) -> Register<S> {
    let mut q = Register::splat(simd, 0.0);
    if shape == Metric::Diagonal {
        for (dx, d) in dx.iter().zip(metric) {
            let dx = Register::load(simd, dx, part);
            q += dx * dx * Register::load(simd, d, part);
        }
        return q;
    }
    let mut elements = metric.iter();
    for i in 0..dx.len() {
        let mut t = Register::splat(simd, 0.0);
        for (dx, m) in dx[i..].iter().zip(&mut elements) {
            t += Register::load(simd, dx, part) * Register::load(simd, m, part);
        }
        q += t * t;
    }
    q
}
