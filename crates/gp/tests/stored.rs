//! Stored fits: files of version 1 remain readable, damaged ones are refused.

use crate::drawn;
use gp::{AutoFit, MOST_ROWS};
use motion::{LearntPolicy as _, Policy as _};
use nalgebra::DVector;
use serde_json::{Value, json};

/// Written by version 1: both readings of six random movements, and both policies' outputs at three states.
const GOLDEN: &str = include_str!("golden/both_readings_v1.json");

fn golden() -> Value {
    serde_json::from_str(GOLDEN).expect("JSON")
}

#[test]
fn version_1_is_read() {
    let golden = golden();
    let fit: AutoFit = serde_json::from_value(golden["fit"].clone()).expect("a fit");
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
        assert!(serde_json::from_value::<AutoFit>(fit).is_err(), "{place}");
    }
}

/// A stored fit of both readings with so many identical rows.
fn of_rows(rows: usize) -> Value {
    let mut fit = golden()["fit"].clone();
    let mut fill = |place: &str, value: f64, count: usize| {
        *fit.pointer_mut(place).expect("a place in the file") = json!(vec![value; count]);
    };
    for (model, weights_a_row) in [("/slope/slope_gp", 1), ("/direct/direct_gp", 2)] {
        fill(&format!("{model}/states"), 0.0, 2 * rows);
        fill(&format!("{model}/noise_weights"), 1.0, rows);
        fill(&format!("{model}/weights"), 0.0, weights_a_row * rows);
    }
    fill("/slope/directions", 0.5, 2 * rows);
    fit
}

#[test]
fn reading_a_fit_computes_no_factor() {
    let rows = 1500;
    let stored = of_rows(rows);
    let mut fit = None;
    let read = allocation_counter::measure(|| fit = serde_json::from_value::<AutoFit>(stored).ok());
    let one_factor = (8 * rows * rows) as u64;
    assert!(read.bytes_max < one_factor / 4, "{} bytes", read.bytes_max);
    let fit = fit.expect("a fit");
    let asked = allocation_counter::measure(|| {
        assert!(fit.slope().support(DVector::zeros(2).as_view()) > 0.0);
    });
    assert!(asked.bytes_max >= one_factor, "{} bytes", asked.bytes_max);
}

#[test]
fn more_rows_than_error_bars_have_memory_for_are_refused() {
    let refused = |fit: Value| serde_json::from_value::<AutoFit>(fit).expect_err("too many rows").to_string();
    let said = refused(of_rows(MOST_ROWS + 1));
    assert!(said.contains("more than 10000 rows"), "{said}");
    let learner = gp::SlopeGp { max_rows: MOST_ROWS + 1, ..gp::SlopeGp::default() };
    let given = drawn::rows(2, (6, 8), drawn::descent, &mut drawn::rng(20));
    let error = learner.fit(&given, &mut drawn::rng(21)).expect_err("too many rows");
    assert_eq!(error.to_string(), "max_rows is 10001: it must be at most 10000");
    let mut wide = of_rows(1);
    wide["slope"]["slope_gp"]["dim"] = json!(2001);
    let said = refused(wide);
    assert!(said.contains("more than 2000 dimensions"), "{said}");
}

#[test]
fn rows_without_a_factor_leave_the_prior() {
    let mut stored = of_rows(3);
    // So large that sums overflow: there is no factor.
    stored["direct"]["direct_gp"]["blocks"][0][1] = json!(1e308);
    stored["direct"]["direct_gp"]["blocks"][3][1] = json!(1e308);
    let fit: AutoFit = serde_json::from_value(stored).expect("a fit");
    let at = DVector::zeros(2);
    assert_eq!(fit.direct().support(at.as_view()), 0.0);
}

/// Writes the golden file again: `cargo test -p policy-align-gp --test all stored -- --ignored`. Only for a new
/// version.
#[test]
#[ignore = "writes the golden file"]
fn write_golden() {
    use crate::drawn::{descent, rng, rows, vector};
    let learner = gp::AutoGp::default();
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
