//! Baselines for comparison with the paper's learner, on the same recordings, held-out samples and measures.

use std::collections::BTreeMap;

use align::{Aligned, DirectPolicyLearning, PolicyAlign};
use demo_gen::{HandInPlane, Recording, ThreeLinkArm, ToySystem, demonstrations};
use gp::{AutoFit, FrontEnd, SlopeFit, Trend};
use motion::{Demonstrations, Learner as _, LearntPolicy, SampleIndex};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use crate::evaluation::comparison::{Comparison, Method, row_id};
use crate::evaluation::constraint_consistent::{ConstraintConsistent, RadialBasis};
use crate::evaluation::fresh;
use crate::evaluation::gaussians::{Gaussians, own_expectations, reading_of};
use crate::evaluation::judge::Judge;
use crate::evaluation::protocol::{TESTED_ON, errors};
use crate::evaluation::recipe::HELD_OUT;
use crate::evaluation::test_samples::TestSamples;
use crate::measure::{Measure, RowOf};
use crate::seed::separate_stream;
use crate::{Measures, Row, Setup, Trial};

/// Number of data sets for the baselines. Errors that are orders of magnitude smaller do not require a hundred.
pub const DATA_SETS: u32 = 5;

/// The learners that are compared with the paper's.
#[derive(Serialize)]
pub struct Baselines {
    /// The naive learner, if the paper's table does not include it.
    pub(crate) naive: Option<DirectPolicyLearning>,
    /// Least squares on radial basis functions, for planar states.
    pub(crate) constraint_consistent: Option<ConstraintConsistent>,
    pub(crate) gaussians: Gaussians,
    /// Share of held-out samples.
    pub held_out: f64,
}

/// The trained baselines, and the judges of their errors.
pub(crate) struct TrainedBaselines<'a> {
    /// For each alignment: on held-out samples of the movements that it keeps, and of all movements.
    judges: Vec<[Judge<'a>; 2]>,
    naive: Option<Box<dyn LearntPolicy>>,
    radial_basis: Option<RadialBasis>,
    both: AutoFit,
    no_trend: SlopeFit,
}

impl Baselines {
    /// The Gaussian processes alone.
    pub(crate) fn of_gaussians(front_end: FrontEnd, max_rows: usize) -> Baselines {
        let gaussians = Gaussians::new(front_end, max_rows);
        Baselines { naive: None, constraint_consistent: None, gaussians, held_out: HELD_OUT }
    }

    /// Work of one data set, in the unit of [`Setup::cost`](crate::Setup::cost).
    pub(crate) fn cost(&self) -> u64 {
        Gaussians::cost(self.gaussians.max_rows)
    }

    /// The learners, in the order of the rows.
    pub(crate) fn methods(&self) -> Vec<Method> {
        let naive = self.naive.as_ref().map(|_| Method::Naive);
        let radial_basis = self.constraint_consistent.as_ref().map(|_| Method::ConstraintConsistent);
        let baselines = naive.into_iter().chain(radial_basis);
        baselines.chain([Method::SlopeGp, Method::SlopeGpNoTrend, Method::DirectGp]).collect()
    }

    /// The rows of a case.
    pub(crate) fn rows(&self, case: &str) -> Vec<Row> {
        let row = |method| Row { id: row_id(case, method), of: RowOf::Additional, tested_on: TESTED_ON };
        self.methods().into_iter().map(row).collect()
    }

    /// A line of the table: the errors of a case's baselines, and of PolicyAlign, whose row is named `case`.
    pub(crate) fn comparison(&self, case: &str, measure: Measure) -> Comparison {
        Comparison::of(case, measure, &self.methods()).with(Method::PolicyAlign, case, measure)
    }

    /// A setup with this name and system, whose trial measures the rows of these cases.
    pub(crate) fn setup<T: Trial + 'static>(
        self,
        (id, system): (&str, u32),
        cases: &[impl AsRef<str>],
        trial: impl FnOnce(Baselines) -> T,
    ) -> Setup {
        let rows = cases.iter().flat_map(|case| self.rows(case.as_ref())).collect();
        let cost = self.cost();
        Setup { data_sets: Some(DATA_SETS), ..Setup::new(id, system, cost, rows, trial(self)) }
    }

    /// Learns with the slope GP alone.
    ///
    /// # Errors
    /// If the demonstrations do not suffice for learning.
    pub fn slope(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut ChaCha8Rng,
    ) -> anyhow::Result<SlopeFit> {
        self.gaussians.slope(Trend::Quadratic, demonstrations, held_out, rng)
    }

    /// Learns from all samples except those held out for any of the alignments. `rng` must be in the state in which
    /// alignment draws its test samples; it does not change.
    pub(crate) fn train<'a>(
        &self,
        recordings: &'a [Recording],
        algorithms: &[PolicyAlign],
        rng: &ChaCha8Rng,
    ) -> anyhow::Result<TrainedBaselines<'a>> {
        let demonstrations = demonstrations(recordings)?;
        let align = |algorithm: &PolicyAlign| {
            let aligned = algorithm.align(&demonstrations)?;
            let test = TestSamples::draw(&aligned, self.held_out, &mut rng.clone())?;
            Ok((aligned, test))
        };
        let alignments: Vec<(Aligned, TestSamples)> = algorithms.iter().map(align).collect::<anyhow::Result<_>>()?;
        let held_out: Vec<SampleIndex> = alignments.iter().flat_map(|(_, test)| &test.of_all).copied().collect();
        let own = || separate_stream(rng);
        let learn = |naive: &DirectPolicyLearning| naive.learn(&demonstrations, &held_out, &mut own());
        Ok(TrainedBaselines {
            judges: alignments.iter().map(|(_, test)| test.judges(recordings)).collect(),
            naive: self.naive.as_ref().map(learn).transpose().map_err(anyhow::Error::from_boxed)?,
            radial_basis: self
                .constraint_consistent
                .as_ref()
                .map(|learner| learner.learn(&demonstrations, &held_out))
                .transpose()?,
            both: self.gaussians.both(&demonstrations, &held_out, &mut own())?,
            no_trend: self.gaussians.slope(Trend::None, &demonstrations, &held_out, &mut own())?,
        })
    }
}

impl<'a> TrainedBaselines<'a> {
    /// The learnt policies, in the order of the rows.
    pub(crate) fn learnt(&self) -> Vec<&dyn LearntPolicy> {
        let naive = self.naive.as_deref();
        let gaussians: [&dyn LearntPolicy; 3] = [self.both.slope(), &self.no_trend, self.both.direct()];
        let radial_basis = self.radial_basis.as_ref().map(|learnt| learnt as &dyn LearntPolicy);
        naive.into_iter().chain(radial_basis).chain(gaussians).collect()
    }

    /// Judges on samples of the movements that an alignment keeps, and of all movements.
    pub(crate) fn judges(&self, alignment: usize) -> &[Judge<'a>; 2] {
        &self.judges[alignment]
    }

    /// One row for each alignment and learner, by alignment.
    pub(crate) fn rows(&self) -> anyhow::Result<Measures> {
        let mut rows = Vec::new();
        for [kept, all] in &self.judges {
            for learnt in self.learnt() {
                let mut row = errors(kept, learnt)?;
                let [nupe, ncpe] = all.policy(&learnt)?;
                row.extend([(Measure::NupeAll, nupe), (Measure::NcpeAll, ncpe)]);
                rows.push(row);
            }
            self.add_doubts(&mut rows);
        }
        Ok(rows)
    }

    /// Adds the learners' own estimates of their errors to the last rows.
    fn add_doubts(&self, rows: &mut Measures) {
        let expected = BTreeMap::from([(Measure::ExpectedNupe, 1.0 - self.both.direct().r_squared())]);
        let mut of_slope = own_expectations(self.both.slope());
        of_slope.extend(reading_of(&self.both));
        let first = rows.len() - 3;
        for (row, of_learner) in rows[first..].iter_mut().zip([of_slope, own_expectations(&self.no_trend), expected]) {
            row.extend(of_learner);
        }
    }
}

/// Source of recordings.
pub(crate) trait Scene: Serialize + Send + Sync {
    fn recordings(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Vec<Recording>>;

    /// Test movements, which no learner sees; `None` if only held-out samples are tested.
    fn fresh(&self, _rng: &ChaCha8Rng) -> anyhow::Result<Option<Vec<Recording>>> {
        Ok(None)
    }
}

impl Scene for ToySystem {
    fn recordings(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
        Ok(self.record(rng)?)
    }

    fn fresh(&self, rng: &ChaCha8Rng) -> anyhow::Result<Option<Vec<Recording>>> {
        fresh::fresh(self, rng).map(Some)
    }
}

impl Scene for HandInPlane {
    fn recordings(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
        Ok(self.record(rng)?)
    }
}

impl Scene for ThreeLinkArm {
    fn recordings(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
        Ok(self.record(rng)?)
    }
}

/// The baselines' rows of a table, for one or more alignments of the same recordings.
#[derive(Serialize)]
pub(crate) struct BaselinesTrial<S> {
    pub(crate) scene: S,
    pub(crate) algorithms: Vec<PolicyAlign>,
    #[serde(rename = "beside")]
    pub(crate) baselines: Baselines,
}

impl<S: Scene + 'static> BaselinesTrial<S> {
    /// A setup with a trial of the baselines on a scene.
    pub(crate) fn setup(
        id: (&str, u32),
        cases: &[impl AsRef<str>],
        scene: S,
        algorithms: Vec<PolicyAlign>,
        baselines: Baselines,
    ) -> Setup {
        baselines.setup(id, cases, |baselines| BaselinesTrial { scene, algorithms, baselines })
    }
}

impl<S: Scene> Trial for BaselinesTrial<S> {
    fn run(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Measures> {
        let recordings = self.scene.recordings(rng)?;
        let trained = self.baselines.train(&recordings, &self.algorithms, rng)?;
        let mut rows = trained.rows()?;
        if let Some(recordings) = self.scene.fresh(rng)? {
            fresh::add_errors(&mut rows, trained.learnt().into_iter().cycle(), &recordings)?;
        }
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::super::protocol::Protocol;
    use super::*;
    use crate::evaluation::candidate::Candidate;
    use crate::seed::generator;
    use crate::tables::table1::{toy_baselines, toy_regressor};

    /// The test samples are those of PolicyAlign's evaluation, and no learner has seen them.
    #[test]
    fn baselines_share_the_test_samples_of_policy_align() {
        let system = ToySystem { n_trajectories: 20, ..ToySystem::default() };
        let mut rng = generator(1, 0, 0);
        let recordings = system.record(&mut rng).unwrap();
        let (baselines, algorithm) = (toy_baselines(FrontEnd::FiniteDifferences, 150), PolicyAlign::default());
        let trained = baselines.train(&recordings, std::slice::from_ref(&algorithm), &rng).unwrap();
        let candidates = vec![Candidate::PolicyAlign(toy_regressor())];
        let protocol = Protocol { algorithm: algorithm.clone(), candidates, held_out: baselines.held_out };
        let evaluation = protocol.evaluate(&recordings, &mut rng).unwrap();
        assert_eq!(trained.judges(0)[0].samples(), evaluation.judge().samples());
        assert_eq!(trained.both.slope().report().rows, 150);

        let rows = trained.rows().unwrap();
        assert_eq!(rows.len(), baselines.rows("case").len());
        let [naive, radial_basis, slope, no_trend, direct] = [0, 1, 2, 3, 4].map(|row| rows[row][&Measure::Nupe]);
        // The slope GP's families contain the parabola only with a trend.
        assert!(slope < 1e-12 && slope < no_trend && no_trend < 1e-2, "{slope} {no_trend}");
        assert!(naive > 0.1 && direct > 0.1, "{naive} {direct}");
        assert!(radial_basis < naive, "{radial_basis}");
        assert_eq!(rows[2][&Measure::ReadConstrained], 100.0);
    }
}
