/// Share of a prior variance that the rows have taken away, from 0 to 1; 0 where numbers overflow, so far from the rows
/// that they say nothing.
pub(crate) fn support(posterior: f64, prior: f64) -> f64 {
    let left = posterior / prior;
    if left.is_nan() { 0.0 } else { 1.0 - left.clamp(0.0, 1.0) }
}
