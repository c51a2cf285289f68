//! Stored fits: a file of version 1 is read for ever, damaged ones are refused.

mod drawn;

use gp::BothReadings;
use motion::Policy as _;
use nalgebra::DVector;
use serde_json::{Value, json};

/// Written by version 1: both readings of six drawn movements, and what both policies do at three states.
const GOLDEN: &str = include_str!("golden/both_readings_v1.json");

fn golden() -> Value {
    serde_json::from_str(GOLDEN).expect("JSON")
}

#[test]
fn version_1_is_read() {
    let golden = golden();
    let fit: BothReadings = serde_json::from_value(golden["fit"].clone()).expect("a fit");
    for case in golden["cases"].as_array().expect("cases") {
        let numbers = |name: &str| -> DVector<f64> {
            let numbers =
                case[name].as_array().expect("numbers").iter().map(|number| number.as_f64().expect("a number"));
            DVector::from_vec(numbers.collect())
        };
        let (x, slope, direct) = (numbers("state"), numbers("slope"), numbers("direct"));
        assert!((fit.slope().action(x.as_view()) - &slope).norm() <= 1e-9 * slope.norm());
        assert!((fit.direct().action(x.as_view()) - &direct).norm() <= 1e-9 * direct.norm());
    }
}

#[test]
fn damaged_files_are_refused() {
    let damages: [(&str, Value); 12] = [
        ("/slope/slope_gp/version", json!(2)),
        ("/slope/slope_gp/dim", json!(3)),
        ("/slope/slope_gp/dim", json!(u64::MAX)),
        ("/slope/slope_gp/unit", json!(0.0)),
        ("/slope/slope_gp/noise", json!(-1.0)),
        ("/slope/slope_gp/blocks", json!([])),
        ("/slope/slope_gp/blocks/0/1", json!(-0.5)),
        ("/slope/slope_gp/weights", json!([1.0])),
        ("/slope/slope_gp/noise_weights/0", json!(0.0)),
        ("/slope/directions/0", json!(2.0)),
        ("/direct/direct_gp/weights", json!([1.0])),
        ("/direct/direct_gp/scaling/mean", json!([1.0])),
    ];
    for (place, value) in damages {
        let mut fit = golden()["fit"].clone();
        *fit.pointer_mut(place).expect("a place in the file") = value;
        assert!(serde_json::from_value::<BothReadings>(fit).is_err(), "{place}");
    }
}

/// Writes the golden file anew: `cargo test --package gp --test stored -- --ignored`. Only for a new version.
#[test]
#[ignore = "writes the golden file"]
fn write_golden() {
    use drawn::{descent, rng, rows, vector};
    let learner = gp::ReadingLearner::default();
    let fit = learner.fit(&rows(2, (6, 8), descent, &mut rng(20)), &mut rng(21)).expect("a fit");
    let numbers = |vector: DVector<f64>| vector.data.as_vec().clone();
    let case = |seed: u64| {
        let x = vector(2, &mut rng(seed));
        let (slope, direct) = (fit.slope().action(x.as_view()), fit.direct().action(x.as_view()));
        json!({"state": numbers(x), "slope": numbers(slope), "direct": numbers(direct)})
    };
    let text = json!({"fit": &fit, "cases": [case(1), case(2), case(3)]}).to_string();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/both_readings_v1.json");
    std::fs::write(path, text + "\n").expect("a file");
}
