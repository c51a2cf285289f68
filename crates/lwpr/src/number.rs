//! What the learning rules calculate with.
//!
//! They are written once, over [`Number`] for a field's scalars and [`Element`] for its rows, and run in three ways that
//! agree bit for bit because they do the same operations in the same order:
//!
//! | scalars | elements of rows | |
//! |---|---|---|
//! | `f64` | `f64` | one field, short rows |
//! | `f64` | [`Lanes`](crate::lanes::Lanes) | one field, several dimensions at a time |
//! | [`Lanes`] | [`Lanes`] | several fields side by side, one dimension at a time (batch training) |
//!
//! Rows are always slices of `f64`.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

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
