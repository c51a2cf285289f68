//! What a rule calculates with.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// One number, or a few side by side. Plain numbers mix in as the same number in every lane.
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
    /// The outcome of a comparison, lane by lane.
    type Mask: Copy;
    /// The right to use the processor's vectors.
    type Token: Copy;

    /// The right that this number was made with.
    fn token(self) -> Self::Token;
    /// `value` in every lane.
    fn splat(token: Self::Token, value: f64) -> Self;
    /// As an element of a row in memory.
    fn of(token: Self::Token, raw: Self::Raw) -> Self;
    /// As it stands in memory.
    fn raw(self) -> Self::Raw;
    /// A row's elements.
    fn elements(row: &[f64]) -> &[Self::Raw];
    /// A row's elements, to be changed.
    fn elements_mut(row: &mut [f64]) -> &mut [Self::Raw];
    /// `self` · `factor` + `term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// 1 / `self`.
    fn recip(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// 2ⁿ, where n was added to 1.5 · 2⁵².
    fn power_of_two(self) -> Self;
    /// Where `self` is larger; nowhere beside NaN.
    fn above(self, other: Self) -> Self::Mask;
    /// `self` where the mask is set, `other` elsewhere.
    fn or_else(self, mask: Self::Mask, other: Self) -> Self;
    /// Where both masks are set.
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
