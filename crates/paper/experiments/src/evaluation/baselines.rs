//! Baselines, compared with the paper's learner: the same recordings, the same held-out samples, the same judge.

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

/// Data sets that they learn from: errors that are smaller by orders of magnitude need no hundred.
pub const DATA_SETS: u32 = 5;

/// Who is compared with the paper's learner.
#[derive(Serialize)]
pub struct Baselines {
    /// The naive learner, where the paper's table has none.
    pub(crate) naive: Option<DirectPolicyLearning>,
    /// Least squares on radial basis functions, where states are planar.
    pub(crate) constraint_consistent: Option<ConstraintConsistent>,
    pub(crate) gaussians: Gaussians,
    /// Share of the samples that is held out.
    pub held_out: f64,
}

/// What they learnt, and those who judge it.
pub(crate) struct TrainedBaselines<'a> {
    /// For each alignment: on samples of the movements that it keeps, and of all.
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

    /// In the order of the rows.
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

    /// A line of the table: those of a case and PolicyAlign, of which the case is named.
    pub(crate) fn comparison(&self, case: &str, measure: Measure) -> Comparison {
        Comparison::of(case, measure, &self.methods()).with(Method::PolicyAlign, case, measure)
    }

    /// The setup of this name and system in which a trial of them measures the rows of these cases.
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

    /// The slope GP alone.
    ///
    /// # Errors
    /// If nothing can be learnt from them.
    pub fn slope(
        &self,
        demonstrations: &Demonstrations,
        held_out: &[SampleIndex],
        rng: &mut ChaCha8Rng,
    ) -> anyhow::Result<SlopeFit> {
        self.gaussians.slope(Trend::Quadratic, demonstrations, held_out, rng)
    }

    /// Lets them learn from all samples but those held out for any of the alignments. The generator stands where it does
    /// when alignment draws its test samples, and is left there.
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
    /// In the order of the rows.
    pub(crate) fn learnt(&self) -> Vec<&dyn LearntPolicy> {
        let naive = self.naive.as_deref();
        let gaussians: [&dyn LearntPolicy; 3] = [self.both.slope(), &self.no_trend, self.both.direct()];
        let radial_basis = self.radial_basis.as_ref().map(|learnt| learnt as &dyn LearntPolicy);
        naive.into_iter().chain(radial_basis).chain(gaussians).collect()
    }

    /// On samples of movements that an alignment keeps, and of all.
    pub(crate) fn judges(&self, alignment: usize) -> &[Judge<'a>; 2] {
        &self.judges[alignment]
    }

    /// A row for each learner and alignment, alignment after alignment.
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

    /// What the learners say of themselves, into the last rows.
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

/// Where recordings come from.
pub(crate) trait Scene: Serialize + Send + Sync {
    fn recordings(&self, rng: &mut ChaCha8Rng) -> anyhow::Result<Vec<Recording>>;

    /// Movements that nobody learns from; none where only held-out samples are tested.
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

/// Their rows of a table, for one or more alignments of the same recordings.
#[derive(Serialize)]
pub(crate) struct BaselinesTrial<S> {
    pub(crate) scene: S,
    pub(crate) algorithms: Vec<PolicyAlign>,
    #[serde(rename = "beside")]
    pub(crate) baselines: Baselines,
}

impl<S: Scene + 'static> BaselinesTrial<S> {
    /// Such trials, of a scene.
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

    /// The same samples as PolicyAlign's evaluation, and no learner has seen one of them.
    #[test]
    fn they_are_tested_where_policy_align_is() {
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
        // The parabola is in the slope GP's families; without a trend it is not.
        assert!(slope < 1e-12 && slope < no_trend && no_trend < 1e-2, "{slope} {no_trend}");
        assert!(naive > 0.1 && direct > 0.1, "{naive} {direct}");
        assert!(radial_basis < naive, "{radial_basis}");
        assert_eq!(rows[2][&Measure::ReadConstrained], 100.0);
    }
}
