//! Smoothed and fused movements. Samples are rows in the files.

use std::path::Path;

use anyhow::ensure;
use motion::{Demonstrations, Trajectory};
use nalgebra::DVector;
use serde::Deserialize;
use smoothing::{AxisScale, Fusion, NoiseVariance, Smoothed, Smoother};

use super::{Agreement, columns, read_json};

/// Movements as rows: the time stamps (K, N), positions and velocities (K, N, n).
type Rows = Vec<Vec<Vec<f64>>>;

#[derive(Debug, Deserialize)]
struct SmootherCase {
    times: Vec<Vec<f64>>,
    positions: Rows,
    s_squared: f64,
    s_squared_auto: f64,
    log_evidence: Vec<f64>,
    states: Rows,
    velocities: Rows,
    state_variance: Vec<Vec<f64>>,
    velocity_variance: Vec<Vec<f64>>,
    window_begins: Vec<Vec<f64>>,
}

#[derive(Debug, Deserialize)]
struct FusionCase {
    times: Vec<Vec<f64>>,
    positions: Rows,
    velocities: Rows,
    rule: String,
    rho: f64,
    log10_q_over_rho: f64,
    states: Rows,
    variance: Vec<Vec<f64>>,
}

/// Compares the smoother at the given noise, and the noise that it estimates; axes are not rotated.
pub(super) fn check_smoother(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let cases: Vec<SmootherCase> = read_json(file)?;
    let mut agreements = vec![
        Agreement::new("log evidence", 1e-9),
        Agreement::new("averages", 1e-6),
        Agreement::new("noise by evidence", 0.2),
    ];
    for case in &cases {
        let movements = Demonstrations::new(stamped(&case.times, &case.positions)?)?;
        let axes = AxisScale::Given(DVector::from_element(movements.dim(), 1.0));
        let given = Smoother { axis_scale: axes, noise: NoiseVariance::Given(case.s_squared), ..Smoother::default() };
        let smoothed = given.smooth(&movements)?;
        agreements[0].compare(smoothed.movements.iter().map(|movement| movement.log_evidence), &case.log_evidence);
        case.compare_averages(&smoothed, &mut agreements[1]);
        let found = Smoother { noise: NoiseVariance::ByEvidence, ..given }.smooth(&movements)?;
        agreements[2].compare([found.noise_variance], &[case.s_squared_auto]);
    }
    Ok(agreements)
}

impl SmootherCase {
    fn compare_averages(&self, ours: &Smoothed, agreement: &mut Agreement) {
        let ours = || ours.movements.iter();
        agreement.compare(ours().flat_map(|ours| ours.states.iter().copied()), &flat(&self.states));
        agreement.compare(ours().flat_map(|ours| ours.velocities.iter().copied()), &flat(&self.velocities));
        agreement.compare(ours().flat_map(|ours| ours.state_variance.iter().copied()), &self.state_variance.concat());
        agreement
            .compare(ours().flat_map(|ours| ours.velocity_variance.iter().copied()), &self.velocity_variance.concat());
        agreement.compare(ours().flat_map(|ours| ours.window_begins.iter().copied()), &self.window_begins.concat());
    }
}

/// Compares fusion, with the rule and ratio that it selects.
pub(super) fn check_fusion(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let cases: Vec<FusionCase> = read_json(file)?;
    let mut agreement = Agreement::new("states and variances", 1e-9);
    for case in &cases {
        let movements = stamped(&case.times, &case.positions)?.into_iter().zip(&case.velocities);
        let movements: Vec<Trajectory> =
            movements.map(|(movement, v)| movement.with_velocities(columns(v))).collect::<Result<_, _>>()?;
        let ours = Fusion::default().fuse(&Demonstrations::new(movements)?)?;
        let rule = ours.rule.to_string().to_lowercase();
        ensure!(rule == case.rule, "the rule is {rule}, in the reference {}", case.rule);
        let (ratio, theirs) = (ours.log10_ratio, case.log10_q_over_rho);
        ensure!(ratio == theirs, "log10 q/rho is {ratio}, in the reference {theirs}");
        agreement.compare([ours.noise_variance], &[case.rho]);
        agreement.compare(ours.movements.iter().flat_map(|ours| ours.states.iter().copied()), &flat(&case.states));
        agreement
            .compare(ours.movements.iter().flat_map(|ours| ours.variance.iter().copied()), &case.variance.concat());
    }
    Ok(vec![agreement])
}

fn stamped(times: &[Vec<f64>], positions: &Rows) -> anyhow::Result<Vec<Trajectory>> {
    let movements = times.iter().zip(positions).map(|(times, x)| Trajectory::stamped(times.clone(), columns(x)));
    Ok(movements.collect::<Result<_, _>>()?)
}

/// The numbers sample by sample, in the memory order of our matrices.
fn flat(rows: &Rows) -> Vec<f64> {
    rows.iter().flatten().flatten().copied().collect()
}
