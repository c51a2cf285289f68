//! Distances of a query from eight fields at a time.

use lanes::{Lanes, Number, Register};
use pulp::Simd;

use super::field_table::{Block, FAR, OFFSET};

/// q = (x − c)ᵀD(x − c) with diagonal D, and the local prediction.
#[inline(always)]
pub(super) fn diagonal_distance<S: Simd>(
    simd: S,
    block: Block<'_>,
    x: &[f64],
    part: usize,
) -> (Register<S>, Register<S>) {
    let mut q = Register::load(simd, &block.head[FAR], part);
    let mut y = Register::load(simd, &block.head[OFFSET], part);
    for (([c, s], d), &x) in block.axes.iter().zip(block.metric).zip(x) {
        let dx = Register::splat(simd, x) - Register::load(simd, c, part);
        q = (dx * dx).mul_add(Register::load(simd, d, part), q);
        y = dx.mul_add(Register::load(simd, s, part), y);
    }
    (q, y)
}

/// The same with full D: Σᵢ dxᵢ (Dᵢᵢ dxᵢ + 2 Σⱼ Dᵢⱼ dxⱼ) over the upper triangle.
#[inline(always)]
pub(super) fn full_distance<S: Simd>(simd: S, block: Block<'_>, x: &[f64], part: usize) -> (Register<S>, Register<S>) {
    let mut q = Register::load(simd, &block.head[FAR], part);
    let mut y = Register::load(simd, &block.head[OFFSET], part);
    let mut metric = block.metric.iter();
    for (i, ([c, s], &xi)) in block.axes.iter().zip(x).enumerate() {
        let dx = Register::splat(simd, xi) - Register::load(simd, c, part);
        y = dx.mul_add(Register::load(simd, s, part), y);
        let Some(diagonal) = metric.next() else { break };
        let mut beside = Register::splat(simd, 0.0);
        for (([c, _], &xj), d) in block.axes[i + 1..].iter().zip(&x[i + 1..]).zip(&mut metric) {
            beside = (Register::splat(simd, xj) - Register::load(simd, c, part))
                .mul_add(Register::load(simd, d, part), beside);
        }
        q = dx.mul_add((beside + beside) + dx * Register::load(simd, diagonal, part), q);
    }
    // A singular D may give a negative value by rounding; NaN stays NaN.
    let zero = Register::splat(simd, 0.0);
    (zero.or_else(zero.above(q), q), y)
}

/// x − c of a block.
#[inline(always)]
pub(super) fn differences<S: Simd>(simd: S, block: Block<'_>, x: &[f64], dx: &mut [Lanes]) {
    for part in 0..Register::<S>::parts() {
        for (([c, _], &x), dx) in block.axes.iter().zip(x).zip(&mut *dx) {
            (Register::splat(simd, x) - Register::load(simd, c, part)).store(dx, part);
        }
    }
}

/// Element `i` of v = D(x − c) with full D.
#[inline(always)]
pub(super) fn turned<S: Simd>(simd: S, block: Block<'_>, dx: &[Lanes], i: usize, part: usize) -> Register<S> {
    // Row j of the triangle starts n, n − 1, … numbers later.
    let mut at = i;
    let mut sum = Register::splat(simd, 0.0);
    for (j, dx_j) in dx[..i].iter().enumerate() {
        sum = Register::load(simd, dx_j, part).mul_add(Register::load(simd, &block.metric[at], part), sum);
        at += dx.len() - 1 - j;
    }
    for (dx_j, d) in dx[i..].iter().zip(&block.metric[at..]) {
        sum = Register::load(simd, dx_j, part).mul_add(Register::load(simd, d, part), sum);
    }
    sum
}
