//! Random numbers: one independent stream for each system and data set.

use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

/// The generator of one data set of one system.
///
/// The stream depends on nothing else, so that rows which differ only in a learner's parameters see the same
/// demonstrations, and one row alone equals that row of a full run.
pub(crate) fn generator(seed: u64, system: u32, data_set: u32) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(u64::from(system) << 32 | u64::from(data_set));
    rng
}

/// A generator beside that of a data set, in a stream that no data set has: what is drawn from it takes nothing from
/// the other, wherever that one stands.
pub(crate) fn beside(rng: &ChaCha8Rng) -> ChaCha8Rng {
    let mut beside = rng.clone();
    beside.set_stream(rng.get_stream() | 1 << 63);
    beside.set_word_pos(0);
    beside
}

/// A generator of movements that nobody learns from, in a stream that neither a data set nor what stands beside it has.
pub(crate) fn fresh(rng: &ChaCha8Rng) -> ChaCha8Rng {
    let mut fresh = rng.clone();
    fresh.set_stream(rng.get_stream() | 1 << 62);
    fresh.set_word_pos(0);
    fresh
}
