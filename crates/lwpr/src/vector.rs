//! Sums over the rows of a field, which are 1, 2, 4 or a multiple of 8 numbers long.
//!
//! The lanes are spelled out, so that the compiler may use vectors of any length and every machine adds in the same
//! order. Callers pass slices whose length is a constant after inlining.

/// aᵀb.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    match a.len() {
        1 => a[0] * b[0],
        2 => a[0] * b[0] + a[1] * b[1],
        4 => (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3]),
        _ => {
            let mut sums = [0.0; 8];
            for (a, b) in a.as_chunks::<8>().0.iter().zip(b.as_chunks::<8>().0) {
                for lane in 0..8 {
                    sums[lane] += a[lane] * b[lane];
                }
            }
            let [a, b, c, d, e, f, g, h] = sums;
            ((a + e) + (c + g)) + ((b + f) + (d + h))
        }
    }
}

/// y ← y + a·x.
#[inline(always)]
pub(crate) fn add_scaled(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}
