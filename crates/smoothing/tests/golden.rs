//! Compares with movements smoothed and fused by another program; see `golden/README.md`.

use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use smoothing::{AxisScale, Fusion, NoiseVariance, Smoother};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn columns(rows: &Value) -> DMatrix<f64> {
    let columns: Vec<_> = rows.as_array().unwrap().iter().map(|row| DVector::from_vec(numbers(row))).collect();
    DMatrix::from_columns(&columns)
}

fn movements(case: &Value) -> Demonstrations {
    let times = case["times"].as_array().unwrap().iter().map(numbers);
    let movements = times.zip(case["positions"].as_array().unwrap());
    Demonstrations::new(movements.map(|(t, x)| Trajectory::stamped(t, columns(x)).unwrap()).collect()).unwrap()
}

#[track_caller]
fn agree(ours: &[f64], theirs: &[f64], tolerance: f64) {
    assert_eq!(ours.len(), theirs.len());
    let largest = theirs.iter().fold(0.0, |largest, x| f64::max(largest, x.abs()));
    for (i, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
        assert!((ours - theirs).abs() <= tolerance * largest, "{i}: {ours} against {theirs}");
    }
}

fn check_smoother(text: &str) {
    let case: Value = serde_json::from_str(text).unwrap();
    let movements = movements(&case);
    let given = Smoother {
        axis_scale: AxisScale::Given(DVector::from_element(movements.dim(), 1.0)),
        noise: NoiseVariance::Given(case["s_squared"].as_f64().unwrap()),
        ..Smoother::default()
    };
    let smoothed = given.smooth(&movements).unwrap();
    let evidence: Vec<f64> = smoothed.movements.iter().map(|movement| movement.log_evidence).collect();
    agree(&evidence, &numbers(&case["log_evidence"]), 1e-9);
    for (k, states) in case["states"].as_array().unwrap().iter().enumerate() {
        let ours = &smoothed.movements[k];
        agree(ours.states.as_slice(), columns(states).as_slice(), 1e-6);
        agree(ours.velocities.as_slice(), columns(&case["velocities"][k]).as_slice(), 1e-6);
        agree(ours.state_variance.as_slice(), &numbers(&case["state_variance"][k]), 1e-6);
        agree(ours.velocity_variance.as_slice(), &numbers(&case["velocity_variance"][k]), 1e-6);
        agree(ours.window_begins.as_slice(), &numbers(&case["window_begins"][k]), 1e-6);
    }
    let found = Smoother { noise: NoiseVariance::ByEvidence, ..given }.smooth(&movements).unwrap();
    agree(&[found.noise_variance], &[case["s_squared_auto"].as_f64().unwrap()], 0.2);
}

#[test]
fn a_movement_with_uneven_stamps() {
    check_smoother(include_str!("golden/smoother_uneven.json"));
}

#[test]
fn a_movement_whose_constraint_switches() {
    check_smoother(include_str!("golden/smoother_switches.json"));
}

fn check_fusion(text: &str) {
    let case: Value = serde_json::from_str(text).unwrap();
    let velocities = case["velocities"].as_array().unwrap().iter().map(columns);
    let movements = movements(&case);
    let movements = movements.trajectories().iter().zip(velocities);
    let movements = movements.map(|(x, v)| x.clone().with_velocities(v).unwrap()).collect();
    let fused = Fusion::default().fuse(&Demonstrations::new(movements).unwrap()).unwrap();
    assert_eq!(fused.rule.to_string().to_lowercase(), case["rule"].as_str().unwrap());
    assert_eq!(fused.log10_ratio, case["log10_q_over_rho"].as_f64().unwrap());
    agree(&[fused.noise_variance], &[case["rho"].as_f64().unwrap()], 1e-9);
    agree(fused.movements[0].states.as_slice(), columns(&case["states"][0]).as_slice(), 1e-9);
    agree(fused.movements[0].variance.as_slice(), &numbers(&case["variance"][0]), 1e-9);
}

#[test]
fn fusion_with_uneven_stamps() {
    check_fusion(include_str!("golden/fusion_uneven.json"));
}

#[test]
fn fusion_of_a_smooth_flow() {
    check_fusion(include_str!("golden/fusion_cubic.json"));
}
