//! Evaluation of learners: every candidate gets the same recordings and held-out samples, and is compared with the same truth.

use std::collections::BTreeMap;

use align::{Aligned, PolicyAlign};
use constraints::PfaffianConstraint;
use demo_gen::{Recording, demonstrations};
use motion::{LearntPolicy, Policy};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::Measures;
use crate::evaluation::candidate::Candidate;
use crate::evaluation::judge::Judge;
use crate::evaluation::test_samples::TestSamples;
use crate::measure::Measure;

/// Description of the test samples.
pub(crate) const TESTED_ON: &str =
    "held-out samples of the movements that alignment keeps; measures named _all: of all movements";

/// The trained learners, and the judges of their errors.
pub(crate) struct Evaluation<'a> {
    aligned: Aligned,
    /// On samples of the movements that alignment keeps, and of all movements.
    judges: [Judge<'a>; 2],
    learnt: Vec<Box<dyn LearntPolicy>>,
}

/// Errors of the learnt policy, and of its potential if it and the truth have one.
pub(crate) fn errors(judge: &Judge<'_>, learnt: &dyn LearntPolicy) -> anyhow::Result<BTreeMap<Measure, f64>> {
    let [nupe, ncpe] = judge.policy(&learnt)?;
    let mut errors = BTreeMap::from([(Measure::Nupe, nupe), (Measure::Ncpe, ncpe)]);
    if let Some(potential) = learnt.potential().filter(|_| judge.has_potential()) {
        errors.insert(Measure::PotentialNmse, judge.potential(potential)?);
    }
    Ok(errors)
}

/// The evaluated learners, and the share of held-out samples.
#[derive(Serialize)]
pub(crate) struct Protocol {
    pub(crate) algorithm: PolicyAlign,
    #[serde(rename = "pupils")]
    pub(crate) candidates: Vec<Candidate>,
    /// Share of held-out samples.
    pub(crate) held_out: f64,
}

impl Protocol {
    /// Aligns the recordings, draws the held-out samples and trains each learner.
    pub(crate) fn evaluate<'a>(
        &self,
        recordings: &'a [Recording],
        rng: &mut ChaCha8Rng,
    ) -> anyhow::Result<Evaluation<'a>> {
        let aligned = self.algorithm.align(&demonstrations(recordings)?)?;
        let test = TestSamples::draw(&aligned, self.held_out, rng)?;
        let learnt = self
            .candidates
            .iter()
            .map(|candidate| candidate.learn(&aligned, &test.of_all, rng))
            .collect::<Result<_, _>>()?;
        Ok(Evaluation { aligned, judges: test.judges(recordings), learnt })
    }
}

impl<'a> Evaluation<'a> {
    /// The learnt policies, in the order of the candidates.
    pub(crate) fn learnt(&self) -> impl Iterator<Item = &dyn LearntPolicy> {
        self.learnt.iter().map(|learnt| &**learnt)
    }

    /// The judge on samples of kept movements.
    pub(crate) fn judge(&self) -> &Judge<'a> {
        &self.judges[0]
    }

    /// A row for each learner, in order: its errors on samples of kept movements, and its policy's errors on samples of all
    /// movements.
    pub(crate) fn rows(&self) -> anyhow::Result<Measures> {
        let row = |learnt: &dyn LearntPolicy| {
            let mut row = self.errors(self.judge(), learnt)?;
            let [nupe, ncpe] = self.judges[1].policy(&learnt)?;
            row.extend([(Measure::NupeAll, nupe), (Measure::NcpeAll, ncpe)]);
            row.insert(Measure::Unsupported, self.unsupported_percent(learnt));
            if let Some(kept) = learnt.kept() {
                let all = self.aligned.demonstrations().n_trajectories();
                row.insert(Measure::Disc, 100.0 * (all - kept.len()) as f64 / all as f64);
            }
            Ok(row)
        };
        self.learnt().map(row).collect()
    }

    /// Error of a policy under a constraint at time 0 that no recording contains: on samples of kept movements, and of all
    /// movements.
    pub(crate) fn unseen(&self, policy: &dyn Policy, constraint: &dyn PfaffianConstraint) -> anyhow::Result<[f64; 2]> {
        let [kept, all] = self.judges.each_ref().map(|judge| judge.policy_under(policy, constraint));
        Ok([kept?, all?])
    }

    /// Errors on samples of kept movements. They include those of the potential if the learner has one, and of the alignment if
    /// the learner uses it.
    pub(crate) fn errors(
        &self,
        judge: &Judge<'_>,
        learnt: &dyn LearntPolicy,
    ) -> anyhow::Result<BTreeMap<Measure, f64>> {
        let mut errors = errors(judge, learnt)?;
        if learnt.kept().is_some() {
            errors.insert(Measure::AlignmentNmse, judge.alignment(&self.aligned)?);
        }
        Ok(errors)
    }

    /// Share of the test samples, as observed, in regions without support from the demonstrations.
    fn unsupported_percent(&self, learnt: &dyn LearntPolicy) -> f64 {
        let trajectories = self.aligned.demonstrations().trajectories();
        let samples = self.judge().samples();
        let unsupported =
            samples.iter().filter(|at| learnt.support(trajectories[at.trajectory].state(at.sample)) == 0.0);
        100.0 * (unsupported.count() as f64 / samples.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use align::{Bandwidth, DirectPolicyLearning, LwprRegressor};
    use demo_gen::{ToyPotential, ToySystem};
    use gp::{AutoGp, GpLearner, SlopeGp};
    use proptest::prelude::*;

    use super::*;
    use crate::seed::generator;

    fn candidates() -> Vec<Candidate> {
        let slope = || SlopeGp { max_rows: 60, hyper_rows: 40, ..SlopeGp::default() };
        vec![
            Candidate::PolicyAlign(LwprRegressor { passes: 2, ..LwprRegressor::default() }),
            Candidate::other(DirectPolicyLearning::default()).unwrap(),
            Candidate::other(GpLearner { gp: slope(), ..GpLearner::default() }).unwrap(),
            Candidate::other(GpLearner { gp: AutoGp { slope: slope(), ..AutoGp::default() }, ..GpLearner::default() })
                .unwrap(),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4))]

        /// Other true movements change every error, but not a single bit of the learnt policies.
        #[test]
        fn recorded_truth_affects_only_the_errors(seed in 1_u64..1000, forger in 1000_u64..2000, samples in 20_usize..40, held_out in 0.05..0.5) {
            let record = |potential, seed| {
                let system = ToySystem { potential, n_trajectories: 12, n_samples: samples, ..ToySystem::default() };
                system.record(&mut generator(seed, 0, 0)).unwrap()
            };
            let recordings = record(ToyPotential::parabola(), seed);
            let others = record(ToyPotential::sinusoidal(), forger);
            let swap = |(recording, other): (&Recording, Recording)| Recording { truth: other.truth, ..recording.clone() };
            let forged: Vec<Recording> = recordings.iter().zip(others).map(swap).collect();
            let algorithm = PolicyAlign { bandwidth: Bandwidth::Medium, ..PolicyAlign::default() };
            let protocol = Protocol { algorithm, candidates: candidates(), held_out };
            let [evaluation, of_forged] = [&recordings, &forged]
                .map(|recordings| protocol.evaluate(recordings, &mut generator(seed, 0, 1)).unwrap());
            prop_assert_eq!(&evaluation.aligned, &of_forged.aligned);
            prop_assert_eq!(evaluation.judge().samples(), of_forged.judge().samples());
            for (ours, theirs) in evaluation.learnt().zip(of_forged.learnt()) {
                prop_assert_eq!((ours.kept(), ours.warnings()), (theirs.kept(), theirs.warnings()));
                for state in recordings.iter().flat_map(|recording| recording.observed.states().column_iter()) {
                    let bits = |learnt: &dyn LearntPolicy| learnt.action(state).map(f64::to_bits);
                    prop_assert_eq!(bits(ours), bits(theirs));
                    prop_assert_eq!(ours.support(state).to_bits(), theirs.support(state).to_bits());
                }
            }
            for (ours, theirs) in evaluation.rows().unwrap().iter().zip(of_forged.rows().unwrap()) {
                prop_assert!(ours[&Measure::Nupe] != theirs[&Measure::Nupe], "a mark that does not know the truth");
            }
        }
    }
}
