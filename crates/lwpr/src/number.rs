//! What the learning rules calculate with.
//!
//! They are written once, over [`Number`] for a field's scalars and [`Element`] for its rows, and run in three ways that
//! agree bit for bit because they do the same operations in the same order:
//!
//! | scalars | elements of rows | |
//! |---|---|---|
//! | `f64` | `f64` | one field, short rows |
//! | `f64` | [`Lanes`] | one field, several dimensions at a time |
//! | [`Lanes`] | [`Lanes`] | several fields side by side, one dimension at a time (batch training) |
//!
//! Rows are always slices of `f64`.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

use pulp::Simd;

use crate::exponential::exp;

/// One number, or a few side by side. Plain numbers mix in as the same number in every lane.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// The numbers in memory.
    type Raw: Copy;
    /// The outcome of a comparison, lane by lane.
    type Mask: Copy;
    /// The right to use the processor's vectors.
    type Token: Copy;

    fn token(self) -> Self::Token;
    /// `value` in every lane.
    fn splat(token: Self::Token, value: f64) -> Self;
    /// As an element of a row in memory.
    fn of(token: Self::Token, raw: Self::Raw) -> Self;
    fn raw(self) -> Self::Raw;
    /// A row's elements.
    fn elements(row: &[f64]) -> &[Self::Raw];
    fn elements_mut(row: &mut [f64]) -> &mut [Self::Raw];
    fn recip(self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn exp(self) -> Self;
    fn above(self, other: Self) -> Self::Mask;
    /// `self` where the mask is set, `other` elsewhere.
    fn or_else(self, mask: Self::Mask, other: Self) -> Self;
    fn both(token: Self::Token, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether any lane is set.
    fn any(token: Self::Token, mask: Self::Mask) -> bool;

    /// `value` in every lane.
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.token(), value)
    }

    /// Between −`limit` and `limit`.
    #[inline(always)]
    fn clip(self, limit: f64) -> Self {
        self.smaller(self.like(limit)).larger(self.like(-limit))
    }

    /// The larger; `other` where they cannot be compared.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.or_else(self.above(other), other)
    }

    /// The smaller; `other` where they cannot be compared.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.or_else(other.above(self), other)
    }
}

/// An element of the rows of a field whose scalars are `T`.
pub(crate) trait Element<T: Number>: Number + Mul<T, Output = Self> {
    /// The scalar, for as many elements as there are.
    fn spread(token: Self::Token, value: T) -> Self;
    fn spread_mask(token: Self::Token, mask: T::Mask) -> Self::Mask;
    /// aᵀb of rows.
    fn dot(token: Self::Token, a: &[f64], b: &[f64]) -> T;
    /// Largest |a| of a row.
    fn largest(token: Self::Token, a: &[f64]) -> T;
}

impl Number for f64 {
    type Raw = f64;
    type Mask = bool;
    type Token = ();

    #[inline(always)]
    fn token(self) {}

    #[inline(always)]
    fn splat((): (), value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn of((): (), raw: f64) -> f64 {
        raw
    }

    #[inline(always)]
    fn raw(self) -> f64 {
        self
    }

    #[inline(always)]
    fn elements(row: &[f64]) -> &[f64] {
        row
    }

    #[inline(always)]
    fn elements_mut(row: &mut [f64]) -> &mut [f64] {
        row
    }

    #[inline(always)]
    fn recip(self) -> f64 {
        1.0 / self
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        self.sqrt()
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn exp(self) -> f64 {
        exp(self)
    }

    #[inline(always)]
    fn above(self, other: f64) -> bool {
        self > other
    }

    #[inline(always)]
    fn or_else(self, mask: bool, other: f64) -> f64 {
        if mask { self } else { other }
    }

    #[inline(always)]
    fn both((): (), a: bool, b: bool) -> bool {
        a & b
    }

    #[inline(always)]
    fn any((): (), mask: bool) -> bool {
        mask
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

    /// Rows are 1, 2, 4 or a multiple of 8 long. The halving order is what vector instructions do.
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
                let [a, b, c, d, e, f, g, h] = sums;
                ((a + e) + (c + g)) + ((b + f) + (d + h))
            }
        }
    }

    #[inline(always)]
    fn largest((): (), a: &[f64]) -> f64 {
        a.iter().fold(0.0, |max, a| Number::larger(a.abs(), max))
    }
}

/// As many numbers as a vector register holds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lanes<S: Simd> {
    value: S::f64s,
    simd: S,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    fn with(self, value: S::f64s) -> Self {
        Lanes { value, ..self }
    }

    #[inline(always)]
    fn numbers(&mut self) -> &mut [f64] {
        pulp::bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.value))
    }

    /// The first lane from `start` on that is below `limit`; past the end if there is none.
    #[inline(always)]
    pub(crate) fn first_below(mut self, limit: Self, start: usize) -> usize {
        if const { size_of::<S::m64s>() == 1 } {
            // One bit a lane, the first lane lowest (`first_true_m64s` takes it for the highest).
            let below = u32::from(pulp::bytemuck::cast::<S::m64s, u8>(limit.above(self)));
            return (below >> start << start).trailing_zeros() as usize;
        }
        if start > 0 {
            self.numbers()[..start].fill(f64::INFINITY);
        }
        self.simd.first_true_m64s(limit.above(self))
    }

    /// The number of lane `lane`.
    #[inline(always)]
    pub(crate) fn get(mut self, lane: usize) -> f64 {
        self.numbers()[lane]
    }

    /// Replaces the number of lane `lane`.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, value: f64) {
        self.numbers()[lane] = value;
    }
}

macro_rules! operators {
    ($($operator:ident, $function:ident, $instruction:ident;)*) => {$(
        impl<S: Simd> $operator for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.with(self.simd.$instruction(self.value, other.value))
            }
        }

        impl<S: Simd> $operator<f64> for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                self.$function(self.like(other))
            }
        }
    )*};
}

operators! {
    Add, add, add_f64s;
    Sub, sub, sub_f64s;
    Mul, mul, mul_f64s;
}

impl<S: Simd> AddAssign for Lanes<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Lanes<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<S: Simd> Number for Lanes<S> {
    type Raw = S::f64s;
    type Mask = S::m64s;
    type Token = S;

    #[inline(always)]
    fn token(self) -> S {
        self.simd
    }

    #[inline(always)]
    fn splat(simd: S, value: f64) -> Self {
        Lanes { value: simd.splat_f64s(value), simd }
    }

    #[inline(always)]
    fn of(simd: S, value: S::f64s) -> Self {
        Lanes { value, simd }
    }

    #[inline(always)]
    fn raw(self) -> S::f64s {
        self.value
    }

    #[inline(always)]
    fn elements(row: &[f64]) -> &[S::f64s] {
        S::as_simd_f64s(row).0
    }

    #[inline(always)]
    fn elements_mut(row: &mut [f64]) -> &mut [S::f64s] {
        S::as_mut_simd_f64s(row).0
    }

    #[inline(always)]
    fn recip(self) -> Self {
        self.with(self.simd.div_f64s(self.simd.splat_f64s(1.0), self.value))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.value))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let zero = self.like(0.0);
        self.or_else(self.above(zero), zero - self)
    }

    #[inline(always)]
    fn exp(mut self) -> Self {
        for value in self.numbers() {
            *value = exp(*value);
        }
        self
    }

    #[inline(always)]
    fn above(self, other: Self) -> S::m64s {
        self.simd.greater_than_f64s(self.value, other.value)
    }

    #[inline(always)]
    fn or_else(self, mask: S::m64s, other: Self) -> Self {
        self.with(self.simd.select_f64s(mask, self.value, other.value))
    }

    #[inline(always)]
    fn both(simd: S, a: S::m64s, b: S::m64s) -> S::m64s {
        simd.and_m64s(a, b)
    }

    #[inline(always)]
    fn any(simd: S, mask: S::m64s) -> bool {
        simd.first_true_m64s(mask) < S::F64_LANES
    }
}

/// Several dimensions of one field.
impl<S: Simd> Element<f64> for Lanes<S> {
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
        // The number of accumulators that makes eight lanes.
        let step = if S::F64_LANES == 4 && a.len() > 1 { 2 } else { 1 };
        let mut sum = Self::of(simd, a[0]) * Self::of(simd, b[0]);
        if step == 1 {
            for (&a, &b) in a.iter().zip(b).skip(1) {
                sum += Self::of(simd, a) * Self::of(simd, b);
            }
        } else {
            let mut odd = Self::of(simd, a[1]) * Self::of(simd, b[1]);
            for (a, b) in a.as_chunks::<2>().0.iter().zip(b.as_chunks::<2>().0).skip(1) {
                sum += Self::of(simd, a[0]) * Self::of(simd, b[0]);
                odd += Self::of(simd, a[1]) * Self::of(simd, b[1]);
            }
            sum += odd;
        }
        simd.reduce_sum_f64s(sum.value)
    }

    #[inline(always)]
    fn largest(simd: S, a: &[f64]) -> f64 {
        simd.reduce_max_f64s(<Self as Element<Self>>::largest(simd, a).value)
    }
}

/// The same dimension of several fields: a row has as many numbers a dimension as there are lanes. It has up to eight
/// dimensions or a multiple of eight.
impl<S: Simd> Element<Lanes<S>> for Lanes<S> {
    #[inline(always)]
    fn spread(_: S, value: Self) -> Self {
        value
    }

    #[inline(always)]
    fn spread_mask(_: S, mask: S::m64s) -> S::m64s {
        mask
    }

    /// In each lane, the order of the sum over a padded row.
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
