//! Which fields a sample reaches: squared distances to all centres, eight at a time.

use crate::Metric;
use crate::field::{Field, Layout};
use crate::full_metric::add_scaled;
use crate::kernel::Activation;
use crate::number::Element;
use crate::settings::Settings;

/// Fields that are looked at together.
pub(crate) const LANES: usize = 8;

/// Centres and diagonal metrics of all fields, in blocks of eight: for each dimension eight centres, then eight D.
///
/// With a full metric the table is empty: M is read from the fields themselves.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ActivationTable {
    blocks: Vec<[f64; LANES]>,
}

/// A field within reach of a sample, its squared distance and activation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reached {
    pub(crate) field: usize,
    pub(crate) q: f64,
    pub(crate) activation: Activation<f64>,
}

impl ActivationTable {
    /// Puts field `k` in, as a new last one or in place of the old.
    pub(crate) fn set(&mut self, settings: &Settings, k: usize, field: &Field) {
        if settings.params.metric == Metric::Full {
            return;
        }
        let n = settings.n_in;
        if k / LANES * 2 * n == self.blocks.len() {
            // Lanes without a field are infinitely far from everything.
            for _ in 0..n {
                self.blocks.push([f64::INFINITY; LANES]);
                self.blocks.push([1.0; LANES]);
            }
        }
        let block = &mut self.blocks[k / LANES * 2 * n..][..2 * n];
        for (i, &c) in field.centre(settings).iter().enumerate() {
            block[2 * i][k % LANES] = c;
        }
        self.set_metric(settings, k, field);
    }

    /// Takes over the metric of field `k` after it has learnt.
    #[inline(always)]
    pub(crate) fn set_metric(&mut self, settings: &Settings, k: usize, field: &Field) {
        if settings.params.metric == Metric::Full {
            return;
        }
        let n = settings.n_in;
        let block = &mut self.blocks[k / LANES * 2 * n..][..2 * n];
        for (i, m) in field.m(settings)[..n].iter().enumerate() {
            block[2 * i + 1][k % LANES] = m * m;
        }
    }

    /// Forgets the last field, number `k`.
    pub(crate) fn pop(&mut self, settings: &Settings, k: usize) {
        if settings.params.metric == Metric::Full {
            return;
        }
        let n = settings.n_in;
        let start = k / LANES * 2 * n;
        if k.is_multiple_of(LANES) {
            self.blocks.truncate(start);
        } else {
            self.blocks[start..].iter_mut().step_by(2).for_each(|centres| centres[k % LANES] = f64::INFINITY);
        }
    }

    /// Reports every field whose squared distance from `x` is below `reach`, and that distance, in list order.
    #[inline(always)]
    pub(crate) fn reached(&self, n: usize, x: &[f64], reach: f64, mut found: impl FnMut(usize, f64)) {
        for (b, block) in self.blocks.chunks_exact(2 * n).enumerate() {
            let mut q = [0.0; LANES];
            for (pair, &x) in block.as_chunks::<2>().0.iter().zip(x) {
                let [centres, d] = pair;
                for lane in 0..LANES {
                    let dx = x - centres[lane];
                    q[lane] += d[lane] * (dx * dx);
                }
            }
            if q.iter().any(|&q| q < reach) {
                for (lane, &q) in q.iter().enumerate() {
                    if q < reach {
                        found(b * LANES + lane, q);
                    }
                }
            }
        }
    }
}

/// Squared distance q = (x − c)ᵀD(x − c) with full metric: |M(x − c)|². `t` is a row of scratch.
#[inline(always)]
pub(crate) fn full_distance(field: &Field, layout: Layout, x: &[f64], t: &mut [f64]) -> f64 {
    t.fill(0.0);
    let columns = field.rows[2 * layout.width..][..layout.metric].chunks_exact(layout.width);
    for ((column, &c), &x) in columns.zip(&field.rows).zip(x) {
        add_scaled::<f64, f64>((), t, x - c, column);
    }
    f64::dot((), t, t)
}
