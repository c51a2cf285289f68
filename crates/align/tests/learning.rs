//! From demonstrations to a policy, on the paper's toy system.

use align::{
    AlignError, Aligned, Bandwidth, DirectPolicyLearning, LwprRegressor, PolicyAlign, PotentialPolicyLearning,
    Regressor,
};
use demo_gen::{Parabola, Recording, ToySystem, demonstrations};
use lwpr::LwprParams;
use motion::{Demonstrations, Learner, LearntPolicy, NegativeGradient, Policy, Potential, SampleIndex, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::Rng;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn recordings(seed: u64) -> Vec<Recording> {
    ToySystem::default().record(&mut rng(seed)).unwrap()
}

fn align_toy(bandwidth: Bandwidth, seed: u64) -> Aligned {
    PolicyAlign { bandwidth, ..Default::default() }.align(&demonstrations(&recordings(seed)).unwrap()).unwrap()
}

fn params() -> LwprParams {
    LwprParams { init_d: 10.0, w_gen: 0.5, penalty: 1e-5, ..Default::default() }
}

fn regressor() -> LwprRegressor {
    LwprRegressor { params: params(), ..Default::default() }
}

fn naive() -> DirectPolicyLearning {
    DirectPolicyLearning { regressor: regressor() }
}

/// Values (n, M) of a vector function at all true states.
fn everywhere(recordings: &[Recording], f: impl Fn(&DVector<f64>) -> DVector<f64>) -> DMatrix<f64> {
    let states = recordings.iter().flat_map(|r| r.truth.states.column_iter());
    DMatrix::from_columns(&states.map(|x| f(&x.into_owned())).collect::<Vec<_>>())
}

#[test]
fn the_policy_is_recovered_where_the_naive_one_is_not() {
    let recordings = recordings(1);
    let aligned = align_toy(Bandwidth::Medium, 1);
    let learnt = aligned.learn(&regressor(), &mut rng(2)).unwrap();
    let naive = naive().learn_policy(aligned.demonstrations(), &[], &mut rng(2)).unwrap();

    let truth = everywhere(&recordings, |x| -0.1 * x);
    let error = |policy: &dyn Policy| {
        let actions = everywhere(&recordings, |x| policy.action(x.as_view()));
        metrics::nupe(&truth, &actions).unwrap()
    };
    // The paper has .024 ± .011 for this set-up; the naive policy cannot learn unobserved components.
    assert!(error(&learnt) < 0.1, "{}", error(&learnt));
    assert!(error(&naive) > 0.3, "{}", error(&naive));
}

#[test]
fn unsplit_parts_are_the_groups() {
    let mut most = 0;
    for seed in 0..10 {
        let aligned = align_toy(Bandwidth::Narrow, seed);
        let splits = aligned.splits();
        let all: Vec<usize> = (0..aligned.demonstrations().n_trajectories()).collect();
        let parts = splits.iter().flat_map(|split| &split.parts).chain([&all]);
        let mut leaves: Vec<_> = parts.filter(|part| splits.iter().all(|split| split.group != **part)).collect();
        leaves.sort();
        let mut groups: Vec<_> = aligned.groups().iter().collect();
        groups.sort();
        assert_eq!(leaves, groups);
        most = most.max(splits.len());
    }
    assert!(most > 2);
}

#[test]
fn recorded_truth_does_not_affect_learning() {
    let recordings = recordings(3);
    let forged: Vec<Recording> = recordings
        .iter()
        .map(|recording| {
            let mut forged = recording.clone();
            forged.truth.states *= -3.0;
            forged.truth.potential.fill(7.0);
            forged.truth.actions.fill(-1.0);
            forged.truth.projectors.reverse();
            forged
        })
        .collect();
    let learn = |recordings: &[Recording]| {
        let aligned = PolicyAlign::default().align(&demonstrations(recordings).unwrap()).unwrap();
        let learnt = aligned.learn(&regressor(), &mut rng(4)).unwrap();
        let naive = DirectPolicyLearning::default().learn_policy(aligned.demonstrations(), &[], &mut rng(4)).unwrap();
        let x = DVector::from_vec(vec![0.4, -0.3]);
        let bits = [learnt.global_potential().value(x.as_view()), learnt.action(x.as_view())[1]];
        (
            aligned,
            bits.map(f64::to_bits),
            learnt.global_potential().regression().model().predictor(0.0),
            naive.regression().model().predictor(0.0),
        )
    };
    assert_eq!(learn(&recordings), learn(&forged));
}

#[test]
fn all_bits_are_the_same_at_any_number_of_threads() {
    let learn = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let aligned = align_toy(Bandwidth::Narrow, 5);
            let model = aligned
                .learn(&regressor(), &mut rng(6))
                .unwrap()
                .global_potential()
                .regression()
                .model()
                .predictor(0.0);
            (aligned, model)
        })
    };
    let one = learn(1);
    assert_eq!(one, learn(2));
    assert_eq!(one, learn(4));
}

#[test]
fn the_gradient_is_that_of_the_value() {
    let aligned = align_toy(Bandwidth::Medium, 7);
    let learnt = aligned.learn(&regressor(), &mut rng(8)).unwrap();
    let learnt = learnt.with_cutoff(1e-9).unwrap();
    let potential = learnt.global_potential();
    let h = 1e-5;
    for (x, _) in aligned.samples().into_iter().step_by(7) {
        let gradient = potential.gradient(x);
        let action = NegativeGradient(potential).action(x);
        assert_eq!(action, learnt.action(x));
        for dimension in 0..2 {
            let at = |h: f64| {
                let mut moved = x.into_owned();
                moved[dimension] += h;
                potential.value(moved.as_view())
            };
            let difference = (at(h) - at(-h)) / (2.0 * h);
            assert!((gradient[dimension] - difference).abs() < 1e-7, "{gradient} {difference}");
            assert_eq!(action[dimension], -gradient[dimension]);
        }
    }
}

#[test]
fn far_away_there_is_no_support() {
    let aligned = align_toy(Bandwidth::Medium, 9);
    let learnt = aligned.learn(&regressor(), &mut rng(10)).unwrap();
    let naive = naive().learn_policy(aligned.demonstrations(), &[], &mut rng(10)).unwrap();
    let potential = learnt.global_potential();
    let near = DVector::from_vec(vec![0.1, 0.1]);
    let far = DVector::from_vec(vec![1e3, -1e3]);
    let model = potential.regression().model().predictor(1e-3);
    assert_eq!(learnt.support(near.as_view()), model.max_activation(near.as_view(), 0));
    let of_naive = naive.regression().model().predictor(1e-3);
    let least = of_naive.max_activation(near.as_view(), 0).min(of_naive.max_activation(near.as_view(), 1));
    assert_eq!(naive.support(near.as_view()), least);
    assert!(learnt.support(near.as_view()) > 1e-3 && least > 1e-3);
    assert_eq!([learnt.support(far.as_view()), naive.support(far.as_view())], [0.0, 0.0]);

    let mean = aligned.samples().values().mean();
    assert!((potential.regression().mean()[0] - mean).abs() < 1e-12);
    assert_eq!(potential.value(far.as_view()), potential.regression().mean()[0]);
    assert_eq!(learnt.action(far.as_view()), DVector::zeros(2));
    assert_eq!(&naive.action(far.as_view()), naive.regression().mean());

    // A smaller cutoff reaches farther, and changes little near the data.
    let edge = DVector::from_vec(vec![3.5, 3.5]);
    let wider = learnt.with_cutoff(1e-200).unwrap();
    assert!(learnt.support(edge.as_view()) == 0.0 && wider.support(edge.as_view()) > 0.0);
    let wider = naive.with_cutoff(1e-200).unwrap();
    assert!(naive.support(edge.as_view()) == 0.0 && wider.support(edge.as_view()) > 0.0);
}

/// Least squares of c + w‖x‖²: an example of a user's own regressor.
struct ParabolaFit;

impl Regressor for ParabolaFit {
    type Fitted = Parabola;
    type Error = std::convert::Infallible;

    fn fit(&self, states: &DMatrix<f64>, values: &DVector<f64>, _rng: &mut dyn Rng) -> Result<Parabola, Self::Error> {
        let squares = DVector::from_iterator(states.ncols(), states.column_iter().map(|x| x.norm_squared()));
        let squares_about = squares.add_scalar(-squares.mean());
        let weight = squares_about.dot(&values.add_scalar(-values.mean())) / squares_about.norm_squared();
        Ok(Parabola { weight, centre: DVector::zeros(states.nrows()) })
    }
}

#[test]
fn a_custom_regressor_can_be_used() {
    let aligned = align_toy(Bandwidth::Narrow, 11);
    let regressor: &dyn Regressor<Fitted = Parabola, Error = std::convert::Infallible> = &ParabolaFit;
    let learnt = aligned.regress(regressor, &aligned.samples(), &mut rng(12)).unwrap();
    // Squared displacements overestimate φ = 0.05‖x‖² by 1/(1 − 0.05·1); nearest samples add a little.
    let expected = 0.05 / 0.95;
    assert!((learnt.weight / expected - 1.0).abs() < 0.03, "{}", learnt.weight);
}

#[test]
fn held_out_samples_are_not_learnt() {
    // Two samples are such outliers that learning from them would be visible.
    let mut x = DMatrix::from_fn(1, 20, |_, i| i as f64 * 0.1);
    let mut u = DMatrix::from_element(1, 20, 1.0);
    (u[3], u[15]) = (1e6, -1e7);
    x[3] += 0.05;
    let trajectory = Trajectory::new(x, 0.1).unwrap().with_velocities(u).unwrap();
    let demonstrations = Demonstrations::new(vec![trajectory]).unwrap();
    let held_out = [SampleIndex { trajectory: 0, sample: 15 }, SampleIndex { trajectory: 0, sample: 3 }];
    let naive = DirectPolicyLearning::default().learn_policy(&demonstrations, &held_out, &mut rng(13)).unwrap();
    assert!((naive.regression().mean()[0] - 1.0).abs() < 1e-15);

    let all: Vec<_> = (0..20).map(|sample| SampleIndex { trajectory: 0, sample }).collect();
    let nothing = DirectPolicyLearning::default().learn_policy(&demonstrations, &all, &mut rng(13));
    assert_eq!(nothing.unwrap_err(), AlignError::NoSamples);
}

#[test]
fn velocities_are_differences_where_none_were_recorded() {
    let x = DMatrix::from_row_slice(1, 4, &[0.0, 1.0, 4.0, 5.0]);
    let demonstrations = Demonstrations::from_states([x], 0.5).unwrap();
    let naive = DirectPolicyLearning::default().learn_policy(&demonstrations, &[], &mut rng(14)).unwrap();
    assert!((naive.regression().mean()[0] - 5.0 / 1.5).abs() < 1e-14);
    assert_eq!(naive.regression().model().n_data(), 30);
}

#[test]
fn every_pass_learns_every_sample_of_outputs_divided_by_their_spread() {
    let aligned = align_toy(Bandwidth::Narrow, 21);
    let held_out = aligned.demonstrations().hold_out_samples(aligned.kept(), 0.2, &mut rng(22)).unwrap();
    let regressor = LwprRegressor { passes: 3, ..regressor() };
    let learnt = aligned.learn_without(&held_out, &regressor, &mut rng(23)).unwrap();
    let values = aligned.samples().without(&held_out).values();
    let model = learnt.global_potential().regression().model();
    assert_eq!(model.n_data(), 3 * values.len());
    let spread = values.variance().sqrt();
    let found = model.params().norm_out.as_ref().unwrap()[0];
    // A variance with n − 1 would differ by 4e-4.
    assert!((found / spread - 1.0).abs() < 1e-12, "{found} {spread}");
}

#[test]
fn learning_is_invariant_to_the_unit_of_length() {
    let states = recordings(24).into_iter().map(|recording| recording.observed.states().clone());
    let movements = Demonstrations::from_states(states, 1.0).unwrap();
    let metres = DirectPolicyLearning::default().learn_policy(&movements, &[], &mut rng(25)).unwrap();
    let aligned = PolicyAlign::default().align(&movements).unwrap();
    let learnt = aligned.learn(&LwprRegressor::default(), &mut rng(26)).unwrap();
    let unit = 1024.0;
    let scaled = movements.trajectories().iter().map(|t| t.states() * unit);
    let scaled = Demonstrations::from_states(scaled, 1.0).unwrap();
    let metres_scaled = DirectPolicyLearning::default().learn_policy(&scaled, &[], &mut rng(25)).unwrap();
    let aligned = PolicyAlign::default().align(&scaled).unwrap();
    let learnt_scaled = aligned.learn(&LwprRegressor::default(), &mut rng(26)).unwrap();
    let x = DVector::from_vec(vec![0.4, -0.3]);
    assert!(learnt.action(x.as_view()).norm() > 0.01);
    for (policy, scaled) in [(&metres as &dyn Policy, &metres_scaled as &dyn Policy), (&learnt, &learnt_scaled)] {
        let (one, other) = (policy.action(x.as_view()), scaled.action((&x * unit).as_view()) / unit);
        assert!((&one - &other).norm() < 1e-9 * one.norm(), "{one} {other}");
    }
}

#[test]
fn all_ways_to_learn_give_the_same_policy() {
    let demonstrations = demonstrations(&recordings(15)).unwrap();
    let aligned = PolicyAlign::default().align(&demonstrations).unwrap();
    let held_out = demonstrations.hold_out_samples(aligned.kept(), 0.1, &mut rng(16)).unwrap();
    let bits = |policy: &dyn LearntPolicy| -> Vec<u64> {
        let states = (0..50).map(|i| DVector::from_vec(vec![0.04 * f64::from(i) - 1.0, 0.3]));
        states.flat_map(|x| policy.action(x.as_view()).map(f64::to_bits).data.as_vec().clone()).collect()
    };
    // The generator also continues from the same state.
    let next = |learn: &dyn Fn(&mut ChaCha8Rng) -> Vec<u64>| {
        let mut rng = rng(17);
        (learn(&mut rng), rng.next_u64())
    };
    let samples = aligned.samples().without(&held_out);
    let regressed = next(&|rng| {
        let potential = aligned.regress(&regressor(), &samples, rng).unwrap();
        let states = (0..50).map(|i| DVector::from_vec(vec![0.04 * f64::from(i) - 1.0, 0.3]));
        states.flat_map(|x| potential.gradient(x.as_view()).map(|g| (-g).to_bits()).data.as_vec().clone()).collect()
    });
    assert_eq!(next(&|rng| bits(&aligned.learn_without(&held_out, &regressor(), rng).unwrap())), regressed);
    let learner = PotentialPolicyLearning { align: PolicyAlign::default(), regressor: regressor() };
    let learners: [&dyn Learner; 1] = [&learner];
    assert_eq!(next(&|rng| bits(&*learners[0].learn(&demonstrations, &held_out, rng).unwrap())), regressed);
    assert_ne!(next(&|rng| bits(&aligned.learn(&regressor(), rng).unwrap())), regressed);
}

#[test]
fn learnt_policies_expose_kept_potential_and_support() {
    let demonstrations = demonstrations(&recordings(18)).unwrap();
    let aligned = PolicyAlign::default().align(&demonstrations).unwrap();
    let learners: [Box<dyn Learner>; 2] = [
        Box::new(PotentialPolicyLearning { align: PolicyAlign::default(), regressor: regressor() }),
        Box::new(naive()),
    ];
    let [learnt, naive] = learners.map(|learner| learner.learn(&demonstrations, &[], &mut rng(19)).unwrap());
    assert_eq!((learnt.kept(), naive.kept()), (Some(aligned.kept()), None));
    assert!(aligned.kept().len() < 40);
    let x = DVector::from_vec(vec![0.4, -0.3]);
    assert_eq!(learnt.potential().unwrap().gradient(x.as_view()), -learnt.action(x.as_view()));
    assert!(naive.potential().is_none());
    assert!(learnt.support(x.as_view()) > 0.1 && naive.support(x.as_view()) > 0.1);

    let apart = [0.0, 1e3].map(|y| DMatrix::from_fn(2, 9, |row, i| if row == 0 { i as f64 } else { y }));
    let fixed = PolicyAlign { bandwidth: Bandwidth::Fixed(1.0), ..Default::default() };
    let learner = PotentialPolicyLearning { align: fixed, regressor: regressor() };
    let observed = Demonstrations::from_states([0.0, 0.1, 0.2].map(|y| apart[0].add_scalar(y)), 1.0).unwrap();
    assert!(learner.learn(&observed, &[], &mut rng(20)).unwrap().warnings().is_empty());
    let observed = Demonstrations::from_states([0.0, 1e3, 1e4].map(|y| apart[0].add_scalar(y)), 1.0).unwrap();
    let warnings = learner.learn(&observed, &[], &mut rng(20)).unwrap().warnings();
    assert!(warnings[0].starts_with("2 of 3 trajectories"), "{warnings:?}");
    let refused = PotentialPolicyLearning::default().learn(
        &Demonstrations::from_states(apart[..1].to_vec(), 1.0).unwrap(),
        &[],
        &mut rng(20),
    );
    assert_eq!(refused.unwrap_err().downcast_ref(), Some(&AlignError::SingleTrajectory));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn samples_fall_in_those_held_out_and_the_rest(seed in 0u64..1000, fraction in 0.0001..0.9999) {
        let aligned = align_toy(Bandwidth::Narrow, seed % 5);
        let samples = aligned.samples();
        let held_out = aligned.demonstrations().hold_out_samples(aligned.kept(), fraction, &mut rng(seed)).unwrap();
        let (train, held_out) = (samples.without(&held_out), samples.only(&held_out));
        let expected = ((samples.len() as f64 * fraction).floor() as usize).max(1);
        prop_assert_eq!((held_out.len(), train.len()), (expected, samples.len() - expected));
        let mut together = [train.indices(), held_out.indices()].concat();
        together.sort_unstable();
        prop_assert_eq!(&together, samples.indices());

        // Every sample matches its index.
        for (index, (x, value)) in held_out.indices().iter().zip(&held_out) {
            let trajectory = &aligned.demonstrations().trajectories()[index.trajectory];
            prop_assert_eq!(x, trajectory.state(index.sample));
            let local = aligned.local_potentials().nth(index.trajectory).unwrap();
            prop_assert_eq!(value, local.values()[index.sample] + aligned.offset(index.trajectory).unwrap());
        }
    }
}
