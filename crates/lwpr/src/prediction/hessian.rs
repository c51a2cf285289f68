//! Second derivatives of a prediction.

use lanes::{LANES, Lanes, Number, Register, total};
use pulp::Simd;

use super::distance::{differences, turned};
use super::field_table::FieldTable;
use super::query::{Active, Query, Scale};
use crate::Kernel;

/// Writes the second derivative: Σ (y − `value`)(4 w″ vvᵀ + 2 w′ D) + Σ 2 w′ (v sᵀ + s vᵀ), minus g aᵀ + a gᵀ with the
/// gradient g and a = Σ 2 w′ v, divided by Σ w. A separate function, compiled once for all dimensions.
pub(super) struct Hessian<'a> {
    pub(super) query: &'a Query<'a>,
    pub(super) scale: f64,
    pub(super) value: f64,
    pub(super) x: &'a [f64],
    pub(super) active: &'a [Active],
    /// Scratch: x − c of a block, D(x − c) of all.
    pub(super) dx: &'a mut [Lanes],
    pub(super) v: &'a mut Vec<Lanes>,
    /// Sums of the gradient in each lane, and Σ w.
    pub(super) sums: &'a [Lanes],
    pub(super) sum_w: f64,
    pub(super) into: &'a mut [f64],
}

impl pulp::WithSimd for Hessian<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Hessian { query, scale, value, x, active, dx, v, sums, sum_w, into } = self;
        let Query { table, scale: Scale { kernel, per_norm_in, .. }, .. } = *query;
        let n = x.len();
        turn_all(simd, table, x, active, (dx, v));
        for i in 0..n {
            for j in i..n {
                let (sum, a_i, a_j) = hessian_sums(simd, table, active, v, (*kernel, value), (i, j));
                let (g_i, g_j) = (total(sums[i]) / sum_w, total(sums[j]) / sum_w);
                let element = (sum - (g_i * a_j + a_i * g_j)) * (scale * per_norm_in[i] * per_norm_in[j]);
                (into[j * n + i], into[i * n + j]) = (element, element);
            }
        }
    }
}

/// v = D(x − c) of all active blocks; `dx` is scratch.
#[inline(always)]
fn turn_all<S: Simd>(
    simd: S,
    table: &FieldTable,
    x: &[f64],
    active: &[Active],
    (dx, v): (&mut [Lanes], &mut Vec<Lanes>),
) {
    let (n, shape) = (x.len(), table.shape());
    if v.len() < n * active.len() {
        v.resize(n * active.len(), [0.0; LANES]);
    }
    for (found, v) in active.iter().zip(v.chunks_exact_mut(n)) {
        let block = table.block(shape, found.block);
        differences(simd, block, x, dx);
        for (i, v) in v.iter_mut().enumerate() {
            for part in 0..Register::<S>::parts() {
                let element = if shape.is_full() {
                    turned(simd, block, dx, i, part)
                } else {
                    Register::load(simd, &dx[i], part) * Register::load(simd, &block.metric[i], part)
                };
                element.store(v, part);
            }
        }
    }
}

/// The sums of element (i, j), and of aᵢ and aⱼ.
#[inline(always)]
fn hessian_sums<S: Simd>(
    simd: S,
    table: &FieldTable,
    active: &[Active],
    v: &[Lanes],
    (kernel, value): (Kernel, f64),
    (i, j): (usize, usize),
) -> (f64, f64, f64) {
    let n = table.shape().n_in;
    let (mut sums, mut a_i, mut a_j) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for part in 0..Register::<S>::parts() {
        let zero = Register::splat(simd, 0.0);
        let (mut sum, mut sum_i, mut sum_j) = (zero, zero, zero);
        for (k, found) in active.iter().enumerate() {
            let block = table.block(table.shape(), found.block);
            let dw = Register::load(simd, &found.dw, part);
            let counts = Register::load(simd, &found.w, part).above(zero);
            let curvature = kernel.at(Register::load(simd, &found.q, part)).curvature.or_else(counts, zero);
            let off = Register::load(simd, &found.y, part) - Register::splat(simd, value);
            let (v_i, v_j) = (Register::load(simd, &v[k * n + i], part), Register::load(simd, &v[k * n + j], part));
            let (s_i, s_j) =
                (Register::load(simd, &block.axes[i][1], part), Register::load(simd, &block.axes[j][1], part));
            let d = if table.shape().is_full() {
                Register::load(simd, &block.metric[i * (2 * n - i + 1) / 2 + j - i], part)
            } else if i == j {
                Register::load(simd, &block.metric[i], part)
            } else {
                zero
            };
            sum += off * (curvature * v_i * v_j * 4.0 + dw * d) + dw * (v_i * s_j + s_i * v_j);
            (sum_i, sum_j) = (sum_i + dw * v_i, sum_j + dw * v_j);
        }
        sum.store(&mut sums, part);
        sum_i.store(&mut a_i, part);
        sum_j.store(&mut a_j, part);
    }
    (total(sums), total(a_i), total(a_j))
}
