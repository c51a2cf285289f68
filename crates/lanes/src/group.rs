//! Numbers in groups of eight: loops over them vectorize without a remainder, and sums over them have the same order on
//! every machine.

/// Numbers in a group: as many as the widest register holds.
pub const LANES: usize = 8;

/// One group of numbers.
pub type Lanes = [f64; LANES];

/// Number of groups that hold `count` numbers.
#[inline(always)]
pub fn groups_of(count: usize) -> usize {
    count.div_ceil(LANES)
}

/// The sum over a group, computed by halving.
#[inline(always)]
pub fn total([a, b, c, d, e, f, g, h]: Lanes) -> f64 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}
