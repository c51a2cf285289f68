//! Numbers in groups of eight: loops over them vectorise without a remainder, and sums over them have one order on every
//! machine.

/// How many numbers go together: as many as the widest register holds.
pub const LANES: usize = 8;

/// One group of numbers.
pub type Lanes = [f64; LANES];

/// How many groups hold `count` numbers.
#[inline(always)]
pub fn groups_of(count: usize) -> usize {
    count.div_ceil(LANES)
}

/// The sum over a group, in halves.
#[inline(always)]
pub fn total([a, b, c, d, e, f, g, h]: Lanes) -> f64 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}
