//! An exponential function that the compiler can vectorise.

/// e^x to about one unit in the last place; 0 below −708, where the true value is under 4e-308 (or for NaN).
///
/// `x` must be under 709. With n = round(x/ln 2) and r = x − n ln 2, |r| ≤ ln 2 / 2, it is 2ⁿ times the Taylor polynomial
/// of degree 13.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    // Adding 1.5·2⁵² leaves the rounded integer in the low bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    // ln 2 in two parts; the first has 32 trailing zeros, so that n times it is exact.
    const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
    const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = (x - n * LN_2_HIGH) - n * LN_2_LOW;
    let (r2, r4) = (r * r, (r * r) * (r * r));
    let low = (1.0 / 2.0 + r * (1.0 / 6.0)) + r2 * (1.0 / 24.0 + r * (1.0 / 120.0));
    let middle = (1.0 / 720.0 + r * (1.0 / 5040.0)) + r2 * (1.0 / 40320.0 + r * (1.0 / 362_880.0));
    let high =
        (1.0 / 3_628_800.0 + r * (1.0 / 39_916_800.0)) + r2 * (1.0 / 479_001_600.0 + r * (1.0 / 6_227_020_800.0));
    let polynomial = 1.0 + (r + r2 * (low + r4 * (middle + r4 * high)));
    let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    if x > -708.0 { polynomial * power } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::exp;

    #[test]
    fn agrees_with_the_standard_library() {
        for i in 0..400_000 {
            let x = -707.9 + f64::from(i) * (718.0 / 400_000.0);
            let (ours, theirs) = (exp(x), x.exp());
            assert!((ours - theirs).abs() <= 3e-16 * theirs, "exp({x}) = {ours}, not {theirs}");
        }
    }

    #[test]
    fn ends_are_sound() {
        assert_eq!(exp(0.0).to_bits(), 1.0_f64.to_bits());
        for x in [-708.0, -1e9, -1e300, f64::NEG_INFINITY, f64::NAN] {
            assert_eq!(exp(x).to_bits(), 0, "exp({x})");
        }
    }
}
