//! Evenly spread states, the same at every call.

use nalgebra::DVector;

/// Point `index` (from 1) of Halton's sequence, which covers the space between bounds evenly.
pub(crate) fn between(bounds: &[[f64; 2]], index: usize) -> DVector<f64> {
    DVector::from_fn(bounds.len(), |axis, _| {
        let [low, high] = bounds[axis];
        low + (high - low) * radical_inverse(index, axis)
    })
}

/// Digits of `index` mirrored at the radix point, in the prime base of dimension `axis`: in (0, 1).
fn radical_inverse(index: usize, axis: usize) -> f64 {
    let base = (2..).filter(|n| (2..*n).take_while(|d| d * d <= *n).all(|d| n % d != 0)).nth(axis).unwrap_or(2);
    let (mut left, mut share, mut value) = (index, 1.0 / base as f64, 0.0);
    while left > 0 {
        value += share * (left % base) as f64;
        left /= base;
        share /= base as f64;
    }
    value
}
