//! The operands of generic computations.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// One number, or several in a vector. Plain numbers can be mixed in as the same number in every lane.
pub trait Number:
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
    /// The result of a comparison, lane by lane.
    type Mask: Copy;
    /// The token that permits use of the processor's vectors.
    type Token: Copy;

    /// The token with which this number was made.
    fn token(self) -> Self::Token;
    /// `value` in every lane.
    fn splat(token: Self::Token, value: f64) -> Self;
    /// Converts from an element of a row in memory.
    fn of(token: Self::Token, raw: Self::Raw) -> Self;
    /// Converts to an element in memory.
    fn raw(self) -> Self::Raw;
    /// A row's elements.
    fn elements(row: &[f64]) -> &[Self::Raw];
    /// A row's elements, mutable.
    fn elements_mut(row: &mut [f64]) -> &mut [Self::Raw];
    /// `self` · `factor` + `term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// 1 / `self`.
    fn recip(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// 2ⁿ, given n plus 1.5 · 2⁵².
    fn power_of_two(self) -> Self;
    /// Lanes in which `self` is larger; none with NaN.
    fn above(self, other: Self) -> Self::Mask;
    /// `self` where the mask is set, `other` elsewhere.
    fn or_else(self, mask: Self::Mask, other: Self) -> Self;
    /// Lanes in which both masks are set.
    fn both(token: Self::Token, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether any lane is set.
    fn any(token: Self::Token, mask: Self::Mask) -> bool;

    /// `value` in every lane.
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.token(), value)
    }

    /// Limits the number to [−`limit`, `limit`].
    #[inline(always)]
    fn clip(self, limit: f64) -> Self {
        self.smaller(self.like(limit)).larger(self.like(-limit))
    }

    /// The larger one; `other` if they cannot be compared.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.or_else(self.above(other), other)
    }

    /// The smaller one; `other` if they cannot be compared.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.or_else(other.above(self), other)
    }
}
