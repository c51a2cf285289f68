//! Stored policies: after reading they have the same bits, old files remain readable, and damaged ones are refused.

use align::{
    AlignError, Bandwidth, DirectPolicy, DirectPolicyLearning, Integration, LwprRegressor, PolicyAlign,
    PotentialPolicy, PotentialPolicyLearning,
};
use demo_gen::{ToySystem, demonstrations};
use lwpr::LwprParams;
use motion::{Channel, Demonstrations, LearntPolicy, Policy};
use nalgebra::DVector;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

fn observed() -> Demonstrations {
    let system = ToySystem { n_trajectories: 12, n_samples: 25, ..ToySystem::default() };
    demonstrations(&system.record(&mut ChaCha8Rng::seed_from_u64(1)).unwrap()).unwrap()
}

/// A regressor with few fields, so that the golden files stay small.
fn regressor() -> LwprRegressor {
    let params = LwprParams { init_d: 2.0, w_gen: 0.1, ..LwprRegressor::default().params };
    LwprRegressor { params, passes: 2, ..LwprRegressor::default() }
}

fn channels() -> Vec<Channel> {
    ["x", "y"].map(|name| Channel { name: name.to_owned(), unit: Some("m".to_owned()) }).to_vec()
}

fn potential_policy() -> PotentialPolicy {
    let learner = PotentialPolicyLearning {
        align: PolicyAlign { bandwidth: Bandwidth::Medium, ..Default::default() },
        regressor: regressor(),
    };
    let learnt = learner.learn_policy(&observed(), &[], &mut ChaCha8Rng::seed_from_u64(2)).unwrap();
    learnt.with_channels(channels()).unwrap()
}

fn direct_policy() -> DirectPolicy {
    let learner = DirectPolicyLearning { regressor: regressor() };
    learner.learn_policy(&observed(), &[], &mut ChaCha8Rng::seed_from_u64(3)).unwrap()
}

/// States within and around the data.
fn states(count: usize) -> impl Iterator<Item = DVector<f64>> {
    let at = |i: usize, turn: f64| 3.0 * (turn * i as f64).sin();
    (0..count).map(move |i| DVector::from_vec(vec![at(i, 0.7), at(i, 1.3)]))
}

/// Action and support at each state.
fn answers(policy: &dyn LearntPolicy, count: usize) -> Vec<[f64; 3]> {
    let answer = |x: DVector<f64>| {
        let action = policy.action(x.as_view());
        [action[0], action[1], policy.support(x.as_view())]
    };
    states(count).map(answer).collect()
}

fn bits(policy: &dyn LearntPolicy) -> Vec<[u64; 3]> {
    answers(policy, 1000).into_iter().map(|answer| answer.map(f64::to_bits)).collect()
}

#[test]
fn stored_policies_act_bitwise_identically() {
    let learnt = potential_policy();
    let read: PotentialPolicy = serde_json::from_str(&serde_json::to_string(&learnt).unwrap()).unwrap();
    assert_eq!(bits(&read), bits(&learnt));
    assert_eq!(read.origin(), learnt.origin());
    assert_eq!((read.kept(), read.warnings()), (learnt.kept(), learnt.warnings()));
    assert_eq!((read.origin().time_step, &read.origin().channels), (1.0, &channels()));
    let [read, learnt] = [read, learnt].map(|policy| bits(&policy.with_cutoff(1e-9).unwrap()));
    assert_eq!(read, learnt);

    let learnt = direct_policy();
    let read: DirectPolicy = serde_json::from_str(&serde_json::to_string(&learnt).unwrap()).unwrap();
    assert_eq!(bits(&read), bits(&learnt));
    assert_eq!((read.origin(), read.kept()), (learnt.origin(), None));
    let supported = answers(&learnt, 1000).iter().filter(|[.., support]| *support > 0.0).count();
    assert!((100..900).contains(&supported), "{supported}");
}

fn golden(name: &str) -> Value {
    let path = format!("{}/tests/stored/{name}_policy_v1.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Later programs may compute in another order, but must agree up to rounding.
fn assert_golden(policy: &dyn LearntPolicy, golden: &Value) {
    let expected: Vec<[f64; 3]> = serde_json::from_value(golden["answers"].clone()).unwrap();
    for (found, expected) in answers(policy, expected.len()).into_iter().zip(expected) {
        let near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 1e-12);
        assert!(near, "{found:?} {expected:?}");
    }
}

#[test]
fn policies_of_version_1_are_read() {
    let potential = golden("potential");
    let policy: PotentialPolicy = serde_json::from_value(potential["policy"].clone()).unwrap();
    assert_golden(&policy, &potential);
    assert_eq!((policy.dim(), policy.origin().n_trajectories, &policy.origin().channels), (2, 12, &channels()));
    assert_eq!(json!(policy.kept()), potential["policy"]["origin"]["kept"]);
    assert_eq!(serde_json::to_value(policy.origin()).unwrap(), potential["policy"]["origin"]);
    let direct = golden("direct");
    let policy: DirectPolicy = serde_json::from_value(direct["policy"].clone()).unwrap();
    assert_golden(&policy, &direct);
}

#[test]
#[ignore = "writes the golden files, once"]
fn write_golden_files() {
    let write = |name: &str, policy: Value, answers: Vec<[f64; 3]>| {
        let path = format!("{}/tests/stored/{name}_policy_v1.json", env!("CARGO_MANIFEST_DIR"));
        std::fs::write(path, json!({ "policy": policy, "answers": answers }).to_string() + "\n").unwrap();
    };
    let (potential, direct) = (potential_policy(), direct_policy());
    write("potential", serde_json::to_value(&potential).unwrap(), answers(&potential, 50));
    write("direct", serde_json::to_value(&direct).unwrap(), answers(&direct, 50));
}

#[test]
fn damaged_policies_are_refused() {
    let sound = golden("potential")["policy"].clone();
    let read = |policy: &Value| serde_json::from_value::<PotentialPolicy>(policy.clone()).unwrap_err().to_string();
    let cases = [
        ("/format", json!("direct policy"), "of the other kind"),
        ("/format", json!("a poem"), "unknown variant"),
        ("/version", json!(2), "has version 2"),
        ("/dim", json!(3), "another dimension"),
        ("/dim", json!(1_u64 << 62), "another dimension"),
        ("/origin/time_step", json!(0.0), "time step"),
        ("/origin/n_trajectories", json!(0), "no trajectory"),
        ("/origin/n_trajectories", json!(3), "kept trajectories"),
        ("/origin/kept", json!([1, 1]), "kept trajectories"),
        ("/origin/kept", json!([]), "kept trajectories"),
        ("/origin/labels", json!([{ "name": "x", "unit": "m" }]), "the number of labels"),
        ("/origin", json!({}), "missing field"),
        ("/regression", json!(null), "invalid type"),
        ("/regression/mean", json!([0.0, 0.0]), "means"),
    ];
    for (place, damage, words) in cases {
        let mut damaged = sound.clone();
        *damaged.pointer_mut(place).unwrap() = damage;
        assert!(read(&damaged).contains(words), "{place}: {}", read(&damaged));
    }
    let mut more = sound.clone();
    more["colour"] = json!("blue");
    assert!(read(&more).contains("unknown field"));
    let direct = golden("direct")["policy"].clone();
    assert!(read(&direct).contains("of the other kind"));
    let learnt = potential_policy();
    assert_eq!(
        learnt.with_channels(channels()[..1].to_vec()).unwrap_err(),
        AlignError::Channels { found: 1, expected: 2 }
    );
}

proptest! {
    #[test]
    fn a_text_that_is_cut_off_is_refused(share in 0.0..1.0) {
        let text = golden("direct")["policy"].to_string();
        let end = (share * text.len() as f64) as usize;
        prop_assert!(serde_json::from_str::<DirectPolicy>(&text[..end]).is_err());
    }
}

#[test]
fn parameters_round_trip_and_omitted_ones_are_defaults() {
    let learner = PotentialPolicyLearning {
        align: PolicyAlign {
            bandwidth: Bandwidth::Fixed(0.25),
            integration: Integration::Work,
            eigenvalue_threshold: 1e-7,
            responsibility_floor: 1e-18,
            memory_limit: 1 << 40,
        },
        regressor: regressor(),
    };
    let text = serde_json::to_string(&learner).unwrap();
    assert_eq!(serde_json::from_str::<PotentialPolicyLearning>(&text).unwrap(), learner);
    let direct = DirectPolicyLearning { regressor: LwprRegressor { passes: 3, ..Default::default() } };
    let text = serde_json::to_string(&direct).unwrap();
    assert_eq!(text, serde_json::to_string(&direct.regressor).unwrap());
    assert!(text.starts_with(r#"{"params":{"#) && text.ends_with(r#""passes":3,"cutoff":0.001}"#), "{text}");
    assert_eq!(serde_json::from_str::<DirectPolicyLearning>(&text).unwrap(), direct);

    let said = r#"{ "align": { "bandwidth": "Medium" }, "regressor": { "passes": 7 } }"#;
    let expected = PotentialPolicyLearning {
        align: PolicyAlign { bandwidth: Bandwidth::Medium, ..Default::default() },
        regressor: LwprRegressor { passes: 7, ..Default::default() },
    };
    assert_eq!(serde_json::from_str::<PotentialPolicyLearning>(said).unwrap(), expected);
    assert!(serde_json::from_str::<DirectPolicyLearning>(r#"{ "pases": 3 }"#).is_err());
    assert!(serde_json::from_str::<PolicyAlign>(r#"{ "bandwith": "Medium" }"#).is_err());
}
