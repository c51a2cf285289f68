//! Second derivatives of a prediction.

use lanes::{LANES, Lanes, Number, Register, total};
use pulp::Simd;

use super::distance::{differences, turned};
use super::field_table::FieldTable;
use super::sweep::{Active, Query};
use crate::Kernel;

/// The second derivative: Σ (y − `value`)(4 w″ vvᵀ + 2 w′ D) + Σ 2 w′ (v sᵀ + s vᵀ), less g aᵀ + a gᵀ with the gradient g
/// and a = Σ 2 w′ v, over Σ w.
#[inline(always)]
pub(super) fn write_hessian<S: Simd>(
    simd: S,
    table: &FieldTable,
    (query, scale, value): (Query<'_>, f64, f64),
    (x, active): (&[f64], &[Active]),
    (dx, v, (gradients, sum_w)): (&mut [Lanes], &mut Vec<Lanes>, (&[Lanes], f64)),
    hessian: &mut [f64],
) {
    let n = table.n_in();
    if v.len() < n * active.len() {
        v.resize(n * active.len(), [0.0; LANES]);
    }
    for (found, v) in active.iter().zip(v.chunks_exact_mut(n)) {
        let block = table.block(found.block);
        differences(simd, block, x, dx);
        for (i, v) in v.iter_mut().enumerate() {
            for part in 0..Register::<S>::parts() {
                turned(simd, table, block, dx, i, part).store(v, part);
            }
        }
    }
    for i in 0..n {
        for j in i..n {
            let (sum, a_i, a_j) = hessian_sums(simd, table, active, v, (query.kernel, value), (i, j));
            let (g_i, g_j) = (total(gradients[i]) / sum_w, total(gradients[j]) / sum_w);
            let element = (sum - (g_i * a_j + a_i * g_j)) * (scale * query.per_norm_in[i] * query.per_norm_in[j]);
            (hessian[j * n + i], hessian[i * n + j]) = (element, element);
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
    let n = table.n_in();
    let (mut sums, mut a_i, mut a_j) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for part in 0..Register::<S>::parts() {
        let zero = Register::splat(simd, 0.0);
        let (mut sum, mut sum_i, mut sum_j) = (zero, zero, zero);
        for (k, found) in active.iter().enumerate() {
            let block = table.block(found.block);
            let dw = Register::load(simd, &found.dw, part);
            let counts = Register::load(simd, &found.w, part).above(zero);
            let curvature = kernel.at(Register::load(simd, &found.q, part)).curvature.or_else(counts, zero);
            let off = Register::load(simd, &found.y, part) - Register::splat(simd, value);
            let (v_i, v_j) = (Register::load(simd, &v[k * n + i], part), Register::load(simd, &v[k * n + j], part));
            let (s_i, s_j) =
                (Register::load(simd, &block.axes[i][1], part), Register::load(simd, &block.axes[j][1], part));
            let d = if table.is_full() {
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
