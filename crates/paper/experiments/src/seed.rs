//! Random numbers: one independent stream for each system and data set.

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

/// The generator of one data set of one system.
///
/// The stream depends on nothing else, so that rows which differ only in a learner's parameters see the same
/// demonstrations, and one row alone equals that row of a full run.
pub fn generator(seed: u64, system: u32, data_set: u32) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(u64::from(system) << 32 | u64::from(data_set));
    rng
}

/// A generator beside that of a data set, in a stream that no data set has: what is drawn from it takes nothing from
/// the other, wherever that one stands.
pub fn separate_stream(rng: &ChaCha8Rng) -> ChaCha8Rng {
    apart(rng, 1 << 63)
}

/// A generator of movements that nobody learns from, in a stream that neither a data set nor what stands beside it has.
pub(crate) fn fresh(rng: &ChaCha8Rng) -> ChaCha8Rng {
    apart(rng, 1 << 62)
}

/// The beginning of the stream of a data set with one more bit, which no data set's number reaches.
fn apart(rng: &ChaCha8Rng, bit: u64) -> ChaCha8Rng {
    let mut apart = rng.clone();
    apart.set_stream(rng.get_stream() | bit);
    apart.set_word_pos(0);
    apart
}
