//! One sweep over the fields of an output, for everything that is asked of a query.

use std::cell::RefCell;

use lanes::{LANES, Lanes, Number, Register, total};
use pulp::Simd;

use super::distance::{diagonal_distance, differences, full_distance, turned};
use super::field_table::{CUTOFF, FieldTable, NOISE, NOISE_KNOWN};
use super::hessian::write_hessian;
use crate::Kernel;

/// What a query needs to know besides the fields.
#[derive(Debug, Clone, Copy)]
pub(super) struct Query<'a> {
    pub(super) kernel: Kernel,
    /// Squared distance beyond which activations are below the cutoff.
    pub(super) squared_radius: f64,
    pub(super) x: &'a [f64],
    pub(super) per_norm_in: &'a [f64],
    pub(super) norm_out: f64,
}

/// What is asked for besides the value. All answers are in the units of inputs and outputs.
#[derive(Debug, Default)]
pub(super) struct Wanted<'a> {
    /// The gradient, one element every `stride`.
    pub(super) gradient: Option<(&'a mut [f64], usize)>,
    /// Second derivatives (n, n).
    pub(super) hessian: Option<&'a mut [f64]>,
    /// Standard deviation; infinite where no field that takes part has collected errors.
    pub(super) confidence: Option<&'a mut f64>,
    /// Activation of the nearest field, whether it takes part or not; answered without support too.
    pub(super) max_activation: Option<&'a mut f64>,
}

/// A block with activated fields: squared distances, activations, 2 dw/dq, local predictions.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Active {
    pub(super) block: usize,
    pub(super) q: Lanes,
    pub(super) w: Lanes,
    pub(super) dw: Lanes,
    pub(super) y: Lanes,
}

/// What a query works in; each thread has one, so that none allocates more than once.
#[derive(Debug, Default)]
struct Scratch {
    x: Vec<f64>,
    active: Vec<Active>,
    /// x − c of a block.
    dx: Vec<Lanes>,
    /// D(x − c) of every active block, for second derivatives.
    v: Vec<Lanes>,
    /// Sums of the gradient, dimension by dimension.
    sums: Vec<Lanes>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Sums over all fields that take part.
#[derive(Debug, Clone, Copy)]
struct Sums {
    w: f64,
    wy: f64,
    /// The least squared distances of all fields, in each lane.
    nearest: Lanes,
}

/// The weighted mean of the local predictions, and what else is wanted; `None` without support.
pub(super) fn sweep(table: &FieldTable, query: Query<'_>, wanted: Wanted<'_>) -> Option<f64> {
    SCRATCH.with_borrow_mut(|scratch| pulp::Arch::new().dispatch(Sweep { table, query, wanted, scratch }))
}

impl Scratch {
    #[inline(always)]
    fn make_room(&mut self, table: &FieldTable) {
        let n = table.n_in();
        if self.x.len() < n {
            self.x.resize(n, 0.0);
            self.dx.resize(n, [0.0; LANES]);
            self.sums.resize(n, [0.0; LANES]);
        }
        if self.active.len() < table.n_blocks() {
            self.active.resize(table.n_blocks(), Active::default());
        }
    }
}

/// [`sweep`], compiled for the processor at hand.
struct Sweep<'a> {
    table: &'a FieldTable,
    query: Query<'a>,
    wanted: Wanted<'a>,
    scratch: &'a mut Scratch,
}

impl pulp::WithSimd for Sweep<'_> {
    type Output = Option<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<f64> {
        let Sweep { table, query, wanted, scratch } = self;
        scratch.make_room(table);
        let Scratch { x, active, dx, v, sums } = scratch;
        let n = table.n_in();
        let (x, dx, sums) = (&mut x[..n], &mut dx[..n], &mut sums[..n]);
        for ((x, raw), per_norm) in x.iter_mut().zip(query.x).zip(query.per_norm_in) {
            *x = raw * per_norm;
        }
        let (found, count) = find(simd, table, query, x, active);
        let active = &active[..count];
        if let Some(max_activation) = wanted.max_activation {
            let mut nearest = f64::INFINITY;
            for q in found.nearest {
                nearest = if q < nearest { q } else { nearest };
            }
            *max_activation = query.kernel.at(nearest).w;
        }
        if found.w <= 0.0 {
            return None;
        }
        let per_w = 1.0 / found.w;
        let (value, scale) = (found.wy * per_w, query.norm_out * per_w);
        if let Some(confidence) = wanted.confidence {
            *confidence = scale * spread(simd, table, x, active, value);
        }
        if wanted.gradient.is_some() || wanted.hessian.is_some() {
            add_gradients(simd, table, x, active, value, (dx, sums));
        }
        if let Some((gradient, stride)) = wanted.gradient {
            for ((gradient, sum), per_norm) in gradient.iter_mut().step_by(stride).zip(&*sums).zip(query.per_norm_in) {
                *gradient = total(*sum) * (scale * per_norm);
            }
        }
        if let Some(hessian) = wanted.hessian {
            let gradients = (&*sums, found.w);
            write_hessian(simd, table, (query, scale, value), (x, active), (dx, v, gradients), hessian);
        }
        Some(value * query.norm_out)
    }
}

/// Finds the blocks with activated fields, and how many they are.
#[inline(always)]
fn find<S: Simd>(simd: S, table: &FieldTable, query: Query<'_>, x: &[f64], active: &mut [Active]) -> (Sums, usize) {
    let (squared_radius, zero) = (Register::splat(simd, query.squared_radius), Register::splat(simd, 0.0));
    let (mut sum_w, mut sum_wy, mut nearest) = ([0.0; LANES], [0.0; LANES], [f64::INFINITY; LANES]);
    let mut count = 0;
    for (b, block) in table.blocks().enumerate() {
        let (mut distance, mut local) = ([0.0; LANES], [0.0; LANES]);
        let mut near = false;
        for part in 0..Register::<S>::parts() {
            let (q, y) = if table.is_full() {
                full_distance(simd, block, x, part)
            } else {
                diagonal_distance(simd, block, x, part)
            };
            near |= Register::<S>::any(simd, squared_radius.above(q));
            q.store(&mut distance, part);
            y.store(&mut local, part);
            q.smaller(Register::load(simd, &nearest, part)).store(&mut nearest, part);
        }
        if !near {
            continue;
        }
        let found = &mut active[count];
        count += 1;
        (found.block, found.q, found.y) = (b, distance, local);
        for part in 0..Register::<S>::parts() {
            let activation = query.kernel.at(Register::load(simd, &distance, part));
            let counts = activation.w.above(Register::load(simd, &block.head[CUTOFF], part));
            let w = activation.w.or_else(counts, zero);
            w.store(&mut found.w, part);
            (activation.slope * 2.0).or_else(counts, zero).store(&mut found.dw, part);
            (Register::load(simd, &sum_w, part) + w).store(&mut sum_w, part);
            let sum = Register::load(simd, &sum_wy, part);
            w.mul_add(Register::load(simd, &local, part), sum).store(&mut sum_wy, part);
        }
    }
    (Sums { w: total(sum_w), wy: total(sum_wy), nearest }, count)
}

/// Σ w ∂y/∂x + Σ ∂w/∂x (y − `value`), in each lane; `dx` is a row of scratch.
#[inline(always)]
fn add_gradients<S: Simd>(
    simd: S,
    table: &FieldTable,
    x: &[f64],
    active: &[Active],
    value: f64,
    (dx, sums): (&mut [Lanes], &mut [Lanes]),
) {
    for sum in &mut *sums {
        *sum = [0.0; LANES];
    }
    for found in active {
        let block = table.block(found.block);
        if table.is_full() {
            differences(simd, block, x, dx);
        }
        for part in 0..Register::<S>::parts() {
            let w = Register::load(simd, &found.w, part);
            let off = Register::load(simd, &found.y, part) - Register::splat(simd, value);
            let off = off * Register::load(simd, &found.dw, part);
            if table.is_full() {
                for (i, ([_, slope], sum)) in block.axes.iter().zip(&mut *sums).enumerate() {
                    let v = turned(simd, table, block, dx, i, part);
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

/// √(Σ w σ² + Σ w (y − `value`)²), with variances σ² = Γ(1 + w Σ s²/Σ w s²); fields without errors add their spread, but no
/// noise of their own. Infinite if none has errors.
#[inline(always)]
fn spread<S: Simd>(simd: S, table: &FieldTable, x: &[f64], active: &[Active], value: f64) -> f64 {
    let (mut sums, mut known) = ([0.0; LANES], [0.0; LANES]);
    for found in active {
        let block = table.block(found.block);
        let (mean, loadings) = table.loadings(found.block);
        for part in 0..Register::<S>::parts() {
            let mut squares = Register::splat(simd, 0.0);
            for direction in loadings.chunks_exact(x.len()) {
                let mut s = Register::splat(simd, 0.0);
                for ((a, mean), &x) in direction.iter().zip(mean).zip(x) {
                    let z = Register::splat(simd, x) - Register::load(simd, mean, part);
                    s = Register::load(simd, a, part).mul_add(z, s);
                }
                squares = s.mul_add(s, squares);
            }
            let w = Register::load(simd, &found.w, part);
            let off = Register::load(simd, &found.y, part) - Register::splat(simd, value);
            let noise = Register::load(simd, &block.head[NOISE], part) * (w * squares + 1.0);
            let sum = w.mul_add(off.mul_add(off, noise), Register::load(simd, &sums, part));
            sum.store(&mut sums, part);
            let known_too =
                w.mul_add(Register::load(simd, &block.head[NOISE_KNOWN], part), Register::load(simd, &known, part));
            known_too.store(&mut known, part);
        }
    }
    if total(known) > 0.0 { total(sums).sqrt() } else { f64::INFINITY }
}
