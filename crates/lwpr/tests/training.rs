//! Invariances: batch and online, storing, threads, units, order of outputs.

use crate::support::{Case, case};
use lwpr::{Lwpr, Metric, Pruning};
use nalgebra::DMatrix;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The complete state as text; equal texts mean equal bits.
fn state(model: &Lwpr) -> String {
    serde_json::to_string(model).unwrap()
}

fn train_online(case: &Case, samples: std::ops::Range<usize>, model: &mut Lwpr) {
    for i in samples {
        model.update(case.xs.column(i).as_view(), case.ys.column(i).as_view()).unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn a_batch_is_its_samples_one_by_one(case in case(400)) {
        let mut online = case.model();
        for _ in 0..2 {
            train_online(&case, 0..case.xs.ncols(), &mut online);
        }
        prop_assert_eq!(state(&case.trained(2)), state(&online));
    }

    #[test]
    fn a_stored_model_resumes_training_identically(case in case(300), at in 1_usize..299) {
        let mut whole = case.model();
        train_online(&case, 0..300, &mut whole);
        let mut first = case.model();
        train_online(&case, 0..at, &mut first);
        let mut resumed: Lwpr = serde_json::from_str(&state(&first)).unwrap();
        train_online(&case, at..300, &mut resumed);
        prop_assert_eq!(state(&resumed), state(&whole));
        let predictor = whole.predictor(0.001);
        let stored: lwpr::Predictor = serde_json::from_str(&serde_json::to_string(&predictor).unwrap()).unwrap();
        prop_assert_eq!(stored, predictor);
    }

    #[test]
    fn results_depend_on_the_seed_not_on_threads(case in case(200)) {
        let run = |threads: usize, seed: u64| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut model = case.model();
                model.fit_batch(case.xs.as_view(), case.ys.as_view(), 2, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
                let predictions = model.predictor(0.001).predict_batch(case.xs.as_view()).unwrap();
                (state(&model), predictions)
            })
        };
        let ours = run(1, case.seed);
        prop_assert!(run(3, case.seed) == ours);
        prop_assert!(run(1, case.seed.wrapping_add(1)) != ours, "another seed is another order");
    }

    #[test]
    fn units_do_not_matter(case in case(200), exponent in -8_i32..8) {
        let scale = 2.0_f64.powi(exponent);
        let mut other = case.clone();
        other.xs *= scale;
        other.params.norm_in = case.params.norm_in.clone().map(|norm| norm * scale);
        let (plain, scaled) = (case.trained(1).predictor(0.001), other.trained(1).predictor(0.001));
        for i in 0..case.xs.ncols() {
            let (a, b) = (plain.predict(case.xs.column(i).as_view()), scaled.predict(other.xs.column(i).as_view()));
            prop_assert_eq!(a.map(|p| (p.value, p.gradient)), b.map(|p| (p.value, p.gradient * scale)));
        }
    }

    #[test]
    fn outputs_are_learnt_independently(case in case(200)) {
        let together = case.trained(1).predictor(0.001);
        for output in 0..case.n_out {
            let mut alone = case.clone();
            alone.n_out = 1;
            alone.ys = DMatrix::from_rows(&[case.ys.row(output)]);
            alone.params.norm_out = alone.params.norm_out.map(|norm| norm.rows(output, 1).into_owned());
            let alone = alone.trained(1).predictor(0.001);
            for x in case.xs.column_iter() {
                prop_assert_eq!(together.value(x, output), alone.value(x, 0));
            }
        }
    }

    #[test]
    fn of_two_fields_the_chosen_one_is_pruned(case in case(300), at in 0_usize..300) {
        // Unpruned fields of many shapes; then the same sample three times.
        let mut case = Case { n_out: 1, ..case };
        case.ys = DMatrix::from_rows(&[case.ys.row(0)]);
        case.params.norm_out = case.params.norm_out.map(|norm| norm.rows(0, 1).into_owned());
        case.params.w_prune = 1.0;
        let grown: serde_json::Value = serde_json::from_str(&state(&case.trained(2))).unwrap();
        let after = |w_prune: f64, pruning: Pruning| {
            let mut stored = grown.clone();
            stored["params"]["w_prune"] = serde_json::to_value(w_prune).unwrap();
            stored["params"]["pruning"] = serde_json::to_value(pruning).unwrap();
            let mut model: Lwpr = serde_json::from_value(stored).unwrap();
            train_online(&case, at..at + 1, &mut model);
            // Fields are compared by the trace of D for normalised inputs.
            let norm = case.params.norm_in.as_ref().unwrap();
            let trace = |d: DMatrix<f64>| d.diagonal().component_mul(norm).dot(norm);
            let shape = |field: lwpr::ReceptiveField<'_>| (field.centre(), trace(field.distance_metric()));
            let mut fields: Vec<_> = model.receptive_fields(0).map(shape).collect();
            fields.sort_by(|a, b| a.0.as_slice().partial_cmp(b.0.as_slice()).unwrap());
            (model.n_pruned(0), fields)
        };
        let (_, all) = after(1.0, Pruning::Wider);
        let low = case.params.w_gen * 1.01;
        let [(n_wider, without_wider), (n_narrower, without_narrower)] =
            [Pruning::Wider, Pruning::Narrower].map(|pruning| after(low, pruning));
        prop_assert_eq!(n_wider, n_narrower);
        prop_assert!(n_wider <= 1);
        let gone = |rest: &Vec<_>| all.iter().filter(|field| !rest.contains(*field)).cloned().collect::<Vec<_>>();
        let (wider, narrower) = (gone(&without_wider), gone(&without_narrower));
        prop_assert_eq!((wider.len(), narrower.len()), (n_wider, n_wider));
        if let ([wider], [narrower]) = (&wider[..], &narrower[..]) {
            prop_assert!(wider.0 != narrower.0);
            prop_assert!(wider.1 <= narrower.1, "the wider one has the smaller trace: {wider:?} {narrower:?}");
        }
    }

    #[test]
    fn metrics_stay_positive_definite_and_activations_shares(case in case(300)) {
        let model = case.trained(2);
        let predictor = model.predictor(0.0);
        for output in 0..case.n_out {
            for field in model.receptive_fields(output) {
                // D = MᵀM with an M that may be almost singular: positive definite up to rounding.
                let values = field.distance_metric().symmetric_eigenvalues();
                prop_assert!(values.min() >= -1e-14 * values.max() && values.max() > 0.0, "{values}");
                if case.params.metric == Metric::Diagonal {
                    prop_assert!(values.min() > 0.0, "{values}");
                }
                prop_assert!((1..=case.n_in).contains(&field.n_projections()));
            }
            for x in case.xs.column_iter() {
                prop_assert!((0.0..=1.0).contains(&predictor.max_activation(x, output)));
            }
        }
    }
}
