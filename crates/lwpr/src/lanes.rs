//! Numbers side by side in a vector register.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

use pulp::Simd;

use crate::exponential::exp;
use crate::number::{Element, Number};

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
        let magnitude = self.like(f64::from_bits(u64::MAX >> 1));
        self.with(self.simd.and_f64s(self.value, magnitude.value))
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
        // Eight accumulators, whatever the register.
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
