//! The fields that predict, eight side by side: the fast path for diagonal metrics.

use std::cell::RefCell;

use pulp::Simd;

use crate::Kernel;
use crate::local_model::LocalModel;
use lanes::Number as _;
use lanes::Register;

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
    pub(crate) per_norm_in: &'a [f64],
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
    ///
    /// A block is one vector or several, `part` after `part`; left to the compiler it would be four of two lanes.
    #[inline(always)]
    fn activate<S: Simd>(&self, simd: S, query: Query<'_>, x: &[f64], active: &mut Vec<ActiveBlock>) -> (f64, f64) {
        let [reach, cutoff, zero] = [query.reach, query.cutoff, 0.0].map(|value| Register::splat(simd, value));
        let (mut sum_w, mut sum_wy) = ([0.0; LANES], [0.0; LANES]);
        let size = HEAD + AXIS * self.n_in;
        active.clear();
        for (b, block) in self.blocks.chunks_exact(size).enumerate() {
            let mut found = ActiveBlock { at: b * size + HEAD, w: [0.0; LANES], slope: [0.0; LANES], y: block[OFFSET] };
            let mut distance = [0.0; LANES];
            let mut in_reach = false;
            for part in 0..parts::<S>() {
                let (mut q, mut y) = (zero, load(simd, &found.y, part));
                for ([c, d, s], &x) in block[HEAD..].as_chunks::<AXIS>().0.iter().zip(x) {
                    let dx = Register::splat(simd, x) - load(simd, c, part);
                    q += load(simd, d, part) * (dx * dx);
                    y += load(simd, s, part) * dx;
                }
                in_reach |= Register::any(simd, reach.above(q));
                store(&mut distance, part, q);
                store(&mut found.y, part, y);
            }
            if !in_reach {
                continue;
            }
            for part in 0..parts::<S>() {
                let activation = query.kernel.at(load(simd, &distance, part));
                let counts = load(simd, &block[LIVE], part).or_else(activation.w.above(cutoff), zero);
                let w = activation.w * counts;
                store(&mut found.w, part, w);
                store(&mut found.slope, part, activation.slope * 2.0 * counts);
                let (so_far, so_far_y) = (load(simd, &sum_w, part), load(simd, &sum_wy, part));
                store(&mut sum_w, part, so_far + w);
                store(&mut sum_wy, part, so_far_y + w * load(simd, &found.y, part));
            }
            active.push(found);
        }
        (total(sum_w), total(sum_wy))
    }

    /// Σ w ∂y/∂x + Σ ∂w/∂x (y − `value`), dimension by dimension.
    #[inline(always)]
    fn gradient<S: Simd>(&self, simd: S, x: &[f64], active: &mut [ActiveBlock], value: f64, gradient: &mut [f64]) {
        for block in &mut *active {
            for part in 0..parts::<S>() {
                let factor =
                    load(simd, &block.slope, part) * (load(simd, &block.y, part) - Register::splat(simd, value));
                store(&mut block.y, part, factor);
            }
        }
        for (i, (gradient, &x)) in gradient.iter_mut().zip(x).enumerate() {
            let mut sums = [0.0; LANES];
            for part in 0..parts::<S>() {
                let mut sum = Register::splat(simd, 0.0);
                for block in &*active {
                    let [c, d, s] = &self.blocks[block.at..].as_chunks::<AXIS>().0[i];
                    let v = load(simd, d, part) * (Register::splat(simd, x) - load(simd, c, part));
                    sum += load(simd, &block.w, part) * load(simd, s, part) + load(simd, &block.y, part) * v;
                }
                store(&mut sums, part, sum);
            }
            *gradient = total(sums);
        }
    }
}

/// Vectors that make up a row.
#[inline(always)]
fn parts<S: Simd>() -> usize {
    Register::<S>::elements(&[0.0; LANES]).len()
}

#[inline(always)]
fn load<S: Simd>(simd: S, row: &Row, part: usize) -> Register<S> {
    Register::of(simd, Register::<S>::elements(row)[part])
}

#[inline(always)]
fn store<S: Simd>(row: &mut Row, part: usize, value: Register<S>) {
    Register::<S>::elements_mut(row)[part] = value.raw();
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
    fn with_simd<S: Simd>(self, simd: S) -> Option<f64> {
        let Predict { table, query, gradient, scratch } = self;
        let Scratch { x, active } = scratch;
        x.clear();
        x.extend(query.x.iter().zip(query.per_norm_in).map(|(x, per_norm)| x * per_norm));
        let (sum_w, sum_wy) = table.activate(simd, query, x, active);
        if sum_w <= 0.0 {
            return None;
        }
        let value = sum_wy / sum_w;
        if let Some(gradient) = gradient {
            table.gradient(simd, x, active, value, gradient);
            let per_sum = 1.0 / sum_w;
            for gradient in gradient {
                *gradient *= per_sum;
            }
        }
        Some(value)
    }
}
