//! Predictive standard deviation.

use lanes::{LANES, Number, Register, total};
use pulp::Simd;

use super::field_table::{FieldTable, NOISE, NOISE_KNOWN};
use super::query::Active;

/// √(Σ w σ² + Σ w (y − `value`)²), with variances σ² = Γ(1 + w Σ s²/Σ w s²). Fields without errors contribute their spread,
/// but no noise. Infinite if no field has errors. A separate function, compiled once for all dimensions.
pub(super) struct Confidence<'a> {
    pub(super) table: &'a FieldTable,
    pub(super) x: &'a [f64],
    pub(super) active: &'a [Active],
    pub(super) value: f64,
}

impl pulp::WithSimd for Confidence<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Confidence { table, x, active, value } = self;
        let (mut sums, mut known) = ([0.0; LANES], [0.0; LANES]);
        for found in active {
            let block = table.block(table.shape(), found.block);
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
}
