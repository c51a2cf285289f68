//! Numbers in groups of eight, the widest vector there is: loops over them vectorise without a remainder, and sums over
//! them have one order on every machine.

/// How many numbers go together.
pub(crate) const LANES: usize = 8;

/// One group of numbers.
pub(crate) type Lanes = [f64; LANES];

/// How many groups hold `count` numbers.
pub(crate) fn groups_of(count: usize) -> usize {
    count.div_ceil(LANES)
}
