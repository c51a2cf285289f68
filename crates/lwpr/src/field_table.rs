//! The fields that predict, eight side by side: the fast path for diagonal metrics.

use std::cell::RefCell;

use crate::Kernel;
use crate::local_model::LocalModel;

/// Fields that are looked at together.
const LANES: usize = 8;

/// Rows of a block before those of the dimensions: 1 for each field, 0 for each lane without; offset.
const LIVE: usize = 0;
const OFFSET: usize = 1;
const HEAD: usize = 2;

/// Rows of a dimension: centre, D, slope.
const AXIS: usize = 3;

type Row = [f64; LANES];

/// All fields that predict an output, in blocks of eight.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FieldTable {
    n_in: usize,
    blocks: Vec<Row>,
}

/// What a query needs to know besides x.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Query<'a> {
    pub(crate) kernel: Kernel,
    pub(crate) cutoff: f64,
    /// Squared distance beyond which activations are below the cutoff.
    pub(crate) reach: f64,
    pub(crate) x: &'a [f64],
    pub(crate) norm_in: &'a [f64],
}

/// A block with fields in reach: activations, 2 dw/dq, and local predictions, which then become the factors of D(x − c).
#[derive(Debug, Clone, Copy)]
struct ActiveBlock {
    at: usize,
    w: Row,
    slope: Row,
    y: Row,
}

/// What a query works in; each thread has one, so that none allocates more than once.
#[derive(Debug, Default)]
struct Scratch {
    x: Vec<f64>,
    active: Vec<ActiveBlock>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl FieldTable {
    /// The table of those `models` that predict.
    pub(crate) fn new(n_in: usize, models: &[LocalModel]) -> Self {
        let trusted: Vec<_> = models.iter().filter_map(|model| Some((model, model.affine.as_ref()?))).collect();
        let mut blocks = Vec::new();
        for fields in trusted.chunks(LANES) {
            let start = blocks.len();
            blocks.resize(start + HEAD + AXIS * n_in, [0.0; LANES]);
            for (lane, (model, affine)) in fields.iter().enumerate() {
                let block = &mut blocks[start..];
                block[LIVE][lane] = 1.0;
                block[OFFSET][lane] = affine.offset;
                for i in 0..n_in {
                    let [c, d, s] = [model.centre[i], model.metric[i], affine.slope[i]];
                    for (row, value) in [c, d, s].into_iter().enumerate() {
                        block[HEAD + AXIS * i + row][lane] = value;
                    }
                }
            }
        }
        FieldTable { n_in, blocks }
    }

    /// The weighted mean of the local predictions, and its gradient if wanted, in normalised units; `None` without
    /// support.
    pub(crate) fn predict(&self, query: Query<'_>, gradient: Option<&mut [f64]>) -> Option<f64> {
        SCRATCH.with_borrow_mut(|scratch| pulp::Arch::new().dispatch(Predict { table: self, query, gradient, scratch }))
    }

    /// Finds the blocks in reach. Returns Σ w and Σ w y.
    #[inline(always)]
    fn activate(&self, query: Query<'_>, x: &[f64], active: &mut Vec<ActiveBlock>) -> (f64, f64) {
        let (mut sum_w, mut sum_wy) = ([0.0; LANES], [0.0; LANES]);
        let size = HEAD + AXIS * self.n_in;
        active.clear();
        for (b, block) in self.blocks.chunks_exact(size).enumerate() {
            let (mut q, mut y) = ([0.0; LANES], block[OFFSET]);
            for ([c, d, s], &x) in block[HEAD..].as_chunks::<AXIS>().0.iter().zip(x) {
                for lane in 0..LANES {
                    let dx = x - c[lane];
                    q[lane] += d[lane] * (dx * dx);
                    y[lane] += s[lane] * dx;
                }
            }
            let mut nearest = f64::INFINITY;
            for q in q {
                nearest = if q < nearest { q } else { nearest };
            }
            if nearest > query.reach {
                continue;
            }
            let (mut w, mut slope) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                let activation = query.kernel.at(q[lane]);
                let counts = if activation.w > query.cutoff { block[LIVE][lane] } else { 0.0 };
                w[lane] = activation.w * counts;
                slope[lane] = 2.0 * activation.slope * counts;
            }
            for lane in 0..LANES {
                sum_w[lane] += w[lane];
                sum_wy[lane] += w[lane] * y[lane];
            }
            active.push(ActiveBlock { at: b * size + HEAD, w, slope, y });
        }
        (total(sum_w), total(sum_wy))
    }

    /// Σ w ∂y/∂x + Σ ∂w/∂x (y − `value`), dimension by dimension.
    #[inline(always)]
    fn gradient(&self, x: &[f64], active: &mut [ActiveBlock], value: f64, gradient: &mut [f64]) {
        for block in &mut *active {
            for lane in 0..LANES {
                block.y[lane] = block.slope[lane] * (block.y[lane] - value);
            }
        }
        for (i, (gradient, &x)) in gradient.iter_mut().zip(x).enumerate() {
            let mut sum = [0.0; LANES];
            for block in &*active {
                let [c, d, s] = &self.blocks[block.at..].as_chunks::<AXIS>().0[i];
                for lane in 0..LANES {
                    sum[lane] += block.w[lane] * s[lane] + block.y[lane] * (d[lane] * (x - c[lane]));
                }
            }
            *gradient = total(sum);
        }
    }
}

/// The sum over lanes, in halves.
#[inline(always)]
fn total([a, b, c, d, e, f, g, h]: Row) -> f64 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// [`FieldTable::predict`], compiled for the processor at hand.
struct Predict<'a> {
    table: &'a FieldTable,
    query: Query<'a>,
    gradient: Option<&'a mut [f64]>,
    scratch: &'a mut Scratch,
}

impl pulp::WithSimd for Predict<'_> {
    type Output = Option<f64>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Option<f64> {
        let Predict { table, query, gradient, scratch } = self;
        let Scratch { x, active } = scratch;
        x.clear();
        x.extend(query.x.iter().zip(query.norm_in).map(|(x, norm)| x / norm));
        let (sum_w, sum_wy) = table.activate(query, x, active);
        if sum_w <= 0.0 {
            return None;
        }
        let value = sum_wy / sum_w;
        if let Some(gradient) = gradient {
            table.gradient(x, active, value, gradient);
            for gradient in gradient {
                *gradient /= sum_w;
            }
        }
        Some(value)
    }
}
