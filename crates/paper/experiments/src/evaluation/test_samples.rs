//! Samples that no learner sees, so that all can be tested on them.

use align::Aligned;
use demo_gen::Recording;
use motion::SampleIndex;
use rand_chacha::ChaCha8Rng;

use crate::evaluation::judge::Judge;
use crate::seed::separate_stream;

/// The samples of one data set that are held out, ascending.
pub struct TestSamples {
    /// Of the trajectories that alignment keeps.
    pub of_kept: Vec<SampleIndex>,
    /// Of all trajectories: the same and the same share of the samples of the discarded ones.
    pub of_all: Vec<SampleIndex>,
}

impl TestSamples {
    /// Who judges on the samples of kept movements, and on those of all.
    pub(crate) fn judges<'a>(&self, recordings: &'a [Recording]) -> [Judge<'a>; 2] {
        [&self.of_kept, &self.of_all].map(|samples| Judge::new(recordings, samples))
    }

    /// Draws a share of the samples, in (0, 1). Those of discarded trajectories come from a stream of their own, so that they change none of the
    /// random numbers that learning goes on with.
    ///
    /// # Errors
    /// If there is nothing to draw from.
    pub fn draw(aligned: &Aligned, share: f64, rng: &mut ChaCha8Rng) -> anyhow::Result<TestSamples> {
        let demonstrations = aligned.demonstrations();
        let of_kept = demonstrations.hold_out_samples(aligned.kept(), share, rng)?;
        let mut of_all = of_kept.clone();
        if !aligned.discarded().is_empty() {
            of_all.extend(demonstrations.hold_out_samples(aligned.discarded(), share, &mut separate_stream(rng))?);
            of_all.sort_unstable();
        }
        Ok(TestSamples { of_kept, of_all })
    }
}

#[cfg(test)]
mod tests {
    use align::PolicyAlign;
    use demo_gen::{ToySystem, demonstrations};
    use rand::Rng as _;

    use super::*;
    use crate::seed::generator;

    #[test]
    fn a_tenth_is_held_out_of_the_kept_and_of_the_discarded() {
        let recordings = ToySystem::default().record(&mut generator(1, 0, 3)).unwrap();
        let aligned = PolicyAlign::default().align(&demonstrations(&recordings).unwrap()).unwrap();
        let (kept, discarded) = (aligned.kept().len(), aligned.discarded().len());
        assert!(kept > 20 && discarded > 1, "{kept} {discarded}");
        let mut rng = generator(1, 0, 3);
        let TestSamples { of_kept, of_all } = TestSamples::draw(&aligned, 0.1, &mut rng).unwrap();
        assert_eq!((of_kept.len(), of_all.len()), (kept * 40 / 10, kept * 40 / 10 + discarded * 40 / 10));
        let is_kept = |at: &&SampleIndex| aligned.kept().contains(&at.trajectory);
        assert!(of_all.is_sorted() && of_all.iter().filter(is_kept).eq(&of_kept));

        // The kept ones alone leave the generator where both together do.
        let mut other = generator(1, 0, 3);
        assert_eq!(aligned.demonstrations().hold_out_samples(aligned.kept(), 0.1, &mut other).unwrap(), of_kept);
        assert_eq!(rng.next_u64(), other.next_u64());
    }
}
