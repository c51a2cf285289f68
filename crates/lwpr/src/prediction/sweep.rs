//! One sweep over the fields of an output, for all quantities of a query.

use std::cell::RefCell;

use lanes::{LANES, Lanes, Number, Register, total};
use pulp::Simd;

use super::confidence::Confidence;
use super::distance::{diagonal_distance, differences, full_distance, turned};
use super::field_table::{BlockShape, CUTOFF, FieldTable};
use super::hessian::Hessian;
use super::query::{Active, Query, Scale};
use crate::Kernel;
use crate::field::rows::Rows;

/// Requested quantities besides the value. All results are in the units of inputs and outputs.
#[derive(Debug, Default)]
pub(super) struct Wanted<'a> {
    /// The gradient, with a distance of `stride` between its elements.
    pub(super) gradient: Option<(&'a mut [f64], usize)>,
    /// Second derivatives (n, n).
    pub(super) hessian: Option<&'a mut [f64]>,
    /// Standard deviation; infinite if no field that takes part has collected errors.
    pub(super) confidence: Option<&'a mut f64>,
    /// Activation of the nearest field, whether or not it takes part; also written without support.
    pub(super) max_activation: Option<&'a mut f64>,
}

/// Memory of a query; one per thread, so that each thread allocates only once.
#[derive(Debug, Default)]
struct Scratch {
    x: Vec<f64>,
    active: Vec<Active>,
    /// x − c of a block.
    dx: Rows,
    /// D(x − c) of every active block, for second derivatives.
    v: Vec<Lanes>,
    /// Sums of the gradient, dimension by dimension.
    sums: Rows,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// The weighted mean of the local predictions, and the other requested quantities; `None` without support.
///
/// There is separate code for two dimensions, because their arithmetic is shorter than loops around it, and for a full
/// metric with two or six.
pub(super) fn sweep(query: &Query<'_>, wanted: &mut Wanted<'_>) -> Option<f64> {
    SCRATCH.with_borrow_mut(|scratch| {
        scratch.make_room(query.table);
        let arch = pulp::Arch::new();
        let sweep = Sweep { query, wanted, scratch };
        match (query.table.shape().is_full(), query.table.shape().n_in) {
            (false, 2) => arch.dispatch(Known::<false, 2>(sweep)),
            (false, _) => arch.dispatch(Known::<false, ANY>(sweep)),
            (true, 2) => arch.dispatch(Known::<true, 2>(sweep)),
            (true, 6) => arch.dispatch(Known::<true, 6>(sweep)),
            (true, _) => arch.dispatch(Known::<true, ANY>(sweep)),
        }
    })
}

impl Scratch {
    #[inline(always)]
    fn make_room(&mut self, table: &FieldTable) {
        if self.x.len() < table.shape().n_in || self.active.len() < table.n_blocks() {
            self.grow(table);
        }
    }

    #[cold]
    fn grow(&mut self, table: &FieldTable) {
        let n = self.x.len().max(table.shape().n_in);
        self.x.resize(n, 0.0);
        (self.dx, self.sums) = (Rows::zeros(n * LANES), Rows::zeros(n * LANES));
        self.active.resize(self.active.len().max(table.n_blocks()), Active::default());
    }
}

/// A query in progress.
struct Sweep<'a, 'w> {
    query: &'a Query<'a>,
    wanted: &'a mut Wanted<'w>,
    scratch: &'a mut Scratch,
}

/// Any number of dimensions.
const ANY: usize = 0;

/// A [`Sweep`], compiled for the actual processor, for one kind of metric and, unless it is [`ANY`], for one number of
/// dimensions: loops over these unroll, and sums stay in registers.
struct Known<'a, 'w, const FULL: bool, const N: usize>(Sweep<'a, 'w>);

impl<const FULL: bool, const N: usize> pulp::WithSimd for Known<'_, '_, FULL, N> {
    type Output = Option<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<f64> {
        if const { S::F64_LANES == 1 } {
            return without_vectors::<FULL>(self.0);
        }
        self.0.run::<S, FULL, N>(simd)
    }
}

/// For a processor without vector instructions, where nothing unrolls; not inlined, so that other code does not include it.
#[cold]
#[inline(never)]
fn without_vectors<const FULL: bool>(sweep: Sweep<'_, '_>) -> Option<f64> {
    sweep.run::<pulp::Scalar, FULL, ANY>(pulp::Scalar::new())
}

impl Sweep<'_, '_> {
    #[inline(always)]
    fn run<S: Simd, const FULL: bool, const N: usize>(self, simd: S) -> Option<f64> {
        let Sweep { query, wanted, scratch } = self;
        let Query { table, scale: Scale { kernel, squared_radius, per_norm_in }, .. } = *query;
        let n = if const { N == ANY } { table.shape().n_in } else { N };
        let shape = BlockShape::new(n, FULL);
        let (mut few_x, mut few_dx, mut few_sums) = ([0.0; N], [[0.0; LANES]; N], [[0.0; LANES]; N]);
        let Scratch { x, active, dx, v, sums } = scratch;
        let (x, dx, sums) = if const { N == ANY } {
            (&mut x[..n], &mut dx.as_chunks_mut().0[..n], &mut sums.as_chunks_mut().0[..n])
        } else {
            (&mut few_x[..], &mut few_dx[..], &mut few_sums[..])
        };
        let per_norm_in = &per_norm_in[..n];
        for ((x, raw), per_norm) in x.iter_mut().zip(&query.x[..n]).zip(per_norm_in) {
            *x = raw * per_norm;
        }
        let (nearest, count) = find(simd, (table, shape), *squared_radius, x, active);
        let active = &mut active[..count];
        if let Some(max_activation) = &mut wanted.max_activation {
            **max_activation = kernel.at(least(nearest)).w;
        }
        let (sum_w, sum_wy) = weigh(simd, (table, shape), *kernel, active);
        if sum_w <= 0.0 {
            return None;
        }
        let per_w = 1.0 / sum_w;
        let (value, scale) = (sum_wy * per_w, query.norm_out * per_w);
        if let Some(confidence) = &mut wanted.confidence {
            **confidence = scale * simd.vectorize(Confidence { table, x, active, value });
        }
        if wanted.gradient.is_some() || wanted.hessian.is_some() {
            add_gradients(simd, (table, shape), x, active, value, (dx, sums));
        }
        if let Some((gradient, stride)) = &mut wanted.gradient {
            for ((gradient, sum), per_norm) in gradient.iter_mut().step_by(*stride).zip(&*sums).zip(per_norm_in) {
                *gradient = total(*sum) * (scale * per_norm);
            }
        }
        if let Some(hessian) = &mut wanted.hessian {
            simd.vectorize(Hessian { query, scale, value, x, active, dx, v, sums, sum_w, into: hessian });
        }
        Some(value * query.norm_out)
    }
}

#[inline(always)]
fn least(numbers: Lanes) -> f64 {
    numbers.into_iter().fold(f64::INFINITY, |least, q| if q < least { q } else { least })
}

/// Finds the blocks with activated fields, and their number, without a branch, because which blocks are near is
/// unpredictable. Also returns the least squared distances of all fields, in each lane.
#[inline(always)]
fn find<S: Simd>(
    simd: S,
    (table, shape): (&FieldTable, BlockShape),
    squared_radius: f64,
    x: &[f64],
    active: &mut [Active],
) -> (Lanes, usize) {
    let squared_radius = Register::splat(simd, squared_radius);
    let mut nearest = [f64::INFINITY; LANES];
    let mut count = 0;
    for (b, block) in table.blocks(shape).enumerate() {
        let found = &mut active[count];
        let mut near = false;
        for part in 0..Register::<S>::parts() {
            let (q, y) = if shape.is_full() {
                full_distance(simd, block, x, part)
            } else {
                diagonal_distance(simd, block, x, part)
            };
            near |= Register::<S>::any(simd, squared_radius.above(q));
            q.store(&mut found.q, part);
            y.store(&mut found.y, part);
            q.smaller(Register::load(simd, &nearest, part)).store(&mut nearest, part);
        }
        found.block = b;
        count += usize::from(near);
    }
    (nearest, count)
}

/// Converts distances to activations of the fields that take part. Returns Σ w and Σ w y.
#[inline(always)]
fn weigh<S: Simd>(
    simd: S,
    (table, shape): (&FieldTable, BlockShape),
    kernel: Kernel,
    active: &mut [Active],
) -> (f64, f64) {
    let zero = Register::splat(simd, 0.0);
    let (mut sum_w, mut sum_wy) = ([0.0; LANES], [0.0; LANES]);
    for found in active {
        let block = table.block(shape, found.block);
        for part in 0..Register::<S>::parts() {
            let activation = kernel.at(Register::load(simd, &found.q, part));
            let counts = activation.w.above(Register::load(simd, &block.head[CUTOFF], part));
            let w = activation.w.or_else(counts, zero);
            w.store(&mut found.w, part);
            (activation.slope * 2.0).or_else(counts, zero).store(&mut found.dw, part);
            (Register::load(simd, &sum_w, part) + w).store(&mut sum_w, part);
            let sum = Register::load(simd, &sum_wy, part);
            w.mul_add(Register::load(simd, &found.y, part), sum).store(&mut sum_wy, part);
        }
    }
    (total(sum_w), total(sum_wy))
}

/// Σ w ∂y/∂x + Σ ∂w/∂x (y − `value`), in each lane; `dx` is a row of scratch.
#[inline(always)]
fn add_gradients<S: Simd>(
    simd: S,
    (table, shape): (&FieldTable, BlockShape),
    x: &[f64],
    active: &[Active],
    value: f64,
    (dx, sums): (&mut [Lanes], &mut [Lanes]),
) {
    for sum in &mut *sums {
        *sum = [0.0; LANES];
    }
    for found in active {
        let block = table.block(shape, found.block);
        if shape.is_full() {
            differences(simd, block, x, dx);
        }
        for part in 0..Register::<S>::parts() {
            let w = Register::load(simd, &found.w, part);
            let off = Register::load(simd, &found.y, part) - Register::splat(simd, value);
            let off = off * Register::load(simd, &found.dw, part);
            if shape.is_full() {
                for (i, ([_, slope], sum)) in block.axes.iter().zip(&mut *sums).enumerate() {
                    let v = turned(simd, block, dx, i, part);
                    let so_far = w.mul_add(Register::load(simd, slope, part), Register::load(simd, sum, part));
                    off.mul_add(v, so_far).store(sum, part);
                }
                continue;
            }
            for ((([c, slope], d), &x), sum) in block.axes.iter().zip(block.metric).zip(x).zip(&mut *sums) {
                let v = (Register::splat(simd, x) - Register::load(simd, c, part)) * Register::load(simd, d, part);
                let so_far = w.mul_add(Register::load(simd, slope, part), Register::load(simd, sum, part));
                off.mul_add(v, so_far).store(sum, part);
            }
        }
    }
}
