//! The rows of a field, and their arithmetic with its scalars.
//!
//! The learning rules are written once, over [`Number`] for a field's scalars and [`Element`] for its rows, and run in
//! three ways, which agree bit for bit because they perform the same operations in the same order:
//!
//! | scalars | elements of rows | |
//! |---|---|---|
//! | `f64` | `f64` | one field, short rows |
//! | `f64` | [`Register`] | one field, several dimensions at a time |
//! | [`Register`] | [`Register`] | several fields side by side, one dimension at a time (batch training) |
//!
//! Rows are always slices of `f64`.

use std::ops::Mul;

use lanes::{Number, Register, total};
use pulp::Simd;

/// An element of the rows of a field whose scalars are `T`.
pub(crate) trait Element<T: Number>: Number + Mul<T, Output = Self> {
    /// Repeats the scalar for all elements.
    fn spread(token: Self::Token, value: T) -> Self;
    fn spread_mask(token: Self::Token, mask: T::Mask) -> Self::Mask;
    /// aᵀb of rows.
    fn dot(token: Self::Token, a: &[f64], b: &[f64]) -> T;
    /// Largest |a| of a row.
    fn largest(token: Self::Token, a: &[f64]) -> T;
}

/// y ← y + a·x for rows.
#[inline(always)]
pub(crate) fn add_scaled<T: Number, E: Element<T>>(token: E::Token, y: &mut [f64], a: T, x: &[f64]) {
    for (y, &x) in E::elements_mut(y).iter_mut().zip(E::elements(x)) {
        *y = (E::of(token, *y) + E::of(token, x) * a).raw();
    }
}

impl Element<f64> for f64 {
    #[inline(always)]
    fn spread((): (), value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn spread_mask((): (), mask: bool) -> bool {
        mask
    }

    /// Rows have 1, 2, 4 or a multiple of 8 elements. The sum is halved in the order of vector instructions.
    #[inline(always)]
    fn dot((): (), a: &[f64], b: &[f64]) -> f64 {
        match a.len() {
            1 => a[0] * b[0],
            2 => a[0] * b[0] + a[1] * b[1],
            4 => (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3]),
            _ => {
                let (a, b) = (a.as_chunks::<8>().0, b.as_chunks::<8>().0);
                let mut sums: [f64; 8] = std::array::from_fn(|lane| a[0][lane] * b[0][lane]);
                for (a, b) in a.iter().zip(b).skip(1) {
                    for lane in 0..8 {
                        sums[lane] += a[lane] * b[lane];
                    }
                }
                total(sums)
            }
        }
    }

    #[inline(always)]
    fn largest((): (), a: &[f64]) -> f64 {
        a.iter().fold(0.0, |max, a| Number::larger(a.abs(), max))
    }
}

/// Several dimensions of one field.
impl<S: Simd> Element<f64> for Register<S> {
    #[inline(always)]
    fn spread(simd: S, value: f64) -> Self {
        Self::splat(simd, value)
    }

    #[inline(always)]
    fn spread_mask(simd: S, mask: bool) -> S::m64s {
        simd.greater_than_f64s(simd.splat_f64s(if mask { 1.0 } else { 0.0 }), simd.splat_f64s(0.0))
    }

    #[inline(always)]
    fn dot(simd: S, a: &[f64], b: &[f64]) -> f64 {
        if S::F64_LANES != 4 && S::F64_LANES != 8 {
            return f64::dot((), a, b);
        }
        let (a, b) = (Self::elements(a), Self::elements(b));
        // Eight accumulators, whatever the register width.
        let step = if S::F64_LANES == 4 && a.len() > 1 { 2 } else { 1 };
        let mut sum = Self::of(simd, a[0]) * Self::of(simd, b[0]);
        for i in (step..a.len()).step_by(step) {
            sum += Self::of(simd, a[i]) * Self::of(simd, b[i]);
        }
        if step == 2 {
            let mut odd = Self::of(simd, a[1]) * Self::of(simd, b[1]);
            for i in (3..a.len()).step_by(2) {
                odd += Self::of(simd, a[i]) * Self::of(simd, b[i]);
            }
            sum += odd;
        }
        sum.sum()
    }

    #[inline(always)]
    fn largest(simd: S, a: &[f64]) -> f64 {
        <Self as Element<Self>>::largest(simd, a).largest()
    }
}

/// The same dimension of several fields: for each dimension, a row has as many numbers as there are lanes. It has up to
/// eight dimensions or a multiple of eight.
impl<S: Simd> Element<Register<S>> for Register<S> {
    #[inline(always)]
    fn spread(_: S, value: Self) -> Self {
        value
    }

    #[inline(always)]
    fn spread_mask(_: S, mask: S::m64s) -> S::m64s {
        mask
    }

    /// In each lane, the sum has the order of that over a padded row.
    #[inline(always)]
    fn dot(simd: S, a: &[f64], b: &[f64]) -> Self {
        let (a, b) = (Self::elements(a), Self::elements(b));
        let mut sums = [Self::splat(simd, 0.0); 8];
        if a.len() < 8 {
            for lane in 0..a.len() {
                sums[lane] = Self::of(simd, a[lane]) * Self::of(simd, b[lane]);
            }
        } else {
            for lane in 0..8 {
                sums[lane] = Self::of(simd, a[lane]) * Self::of(simd, b[lane]);
            }
        }
        for (a, b) in a.as_chunks::<8>().0.iter().zip(b.as_chunks::<8>().0).skip(1) {
            for lane in 0..8 {
                sums[lane] += Self::of(simd, a[lane]) * Self::of(simd, b[lane]);
            }
        }
        let [s0, s1, s2, s3, s4, s5, s6, s7] = sums;
        match a.len() {
            1 => s0,
            2 => s0 + s1,
            3 | 4 => (s0 + s2) + (s1 + s3),
            _ => ((s0 + s4) + (s2 + s6)) + ((s1 + s5) + (s3 + s7)),
        }
    }

    #[inline(always)]
    fn largest(simd: S, a: &[f64]) -> Self {
        let mut max = Self::splat(simd, 0.0);
        for &a in Self::elements(a) {
            max = Self::of(simd, a).abs().larger(max);
        }
        max
    }
}
