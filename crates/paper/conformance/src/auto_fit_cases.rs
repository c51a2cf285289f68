//! Complete fits of the slope GP, compared with bounds, because another optimiser finds other amplitudes.

use std::path::Path;

use anyhow::Context as _;
use gp::{FrontEnd, ModelKind, SlopeFit, SlopeGp};
use motion::{Demonstrations, Policy as _, Trajectory};
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use serde::Deserialize;
use smoothing::Smoother;

use super::slope_cases::view;
use super::{Agreement, columns, read_json};

/// Numbers by trajectory, sample and dimension.
type Series = Vec<Vec<Vec<f64>>>;

#[derive(Debug, Deserialize)]
struct System {
    #[serde(rename = "system")]
    name: String,
    times: Vec<Vec<f64>>,
    positions: Option<Series>,
    velocities: Option<Series>,
    true_states: Series,
    true_policy: Series,
    null_space_projectors: Vec<Series>,
    prototype: Vec<Prototype>,
}

#[derive(Debug, Deserialize)]
struct Prototype {
    nupe: f64,
    ncpe: f64,
    r_squared: f64,
    model: ModelKind,
}

/// Errors, R², the kind of model and the curl test, each relative to the bound that the reference fits set.
pub(super) fn check(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let systems: Vec<System> = read_json(file)?;
    let mut agreements = vec![
        Agreement::new("errors over their bound", 1.0),
        Agreement::new("shortfall of R² over its bound", 1.0),
        Agreement::new("curl tests and kinds of model that are wrong", 0.0),
        Agreement::new("expected errors that are wrong by over 10", 0.0),
    ];
    for system in &systems {
        for seed in 0..2 {
            let gp = SlopeGp { max_rows: 400, hyper_rows: 200, ..SlopeGp::default() };
            let rows = system.front_end().rows(&system.demonstrations()?)?;
            let fit = gp.fit(&rows, &mut ChaCha8Rng::seed_from_u64(seed))?;
            system.compare(&fit, &mut agreements).with_context(|| system.name.clone())?;
        }
    }
    Ok(agreements)
}

impl System {
    fn front_end(&self) -> FrontEnd {
        if self.positions.is_some() { FrontEnd::Smoothed(Smoother::default()) } else { FrontEnd::Velocities }
    }

    fn demonstrations(&self) -> anyhow::Result<Demonstrations> {
        let states = self.positions.as_ref().unwrap_or(&self.true_states);
        let trajectory = |k: usize| -> anyhow::Result<Trajectory> {
            let observed = Trajectory::new(columns(&states[k]), self.times[k][1] - self.times[k][0])?;
            Ok(match &self.velocities {
                None => observed,
                Some(velocities) => observed.with_velocities(columns(&velocities[k]))?,
            })
        };
        Ok(Demonstrations::new((0..states.len()).map(trajectory).collect::<anyhow::Result<_>>()?)?)
    }

    fn compare(&self, fit: &SlopeFit, agreements: &mut [Agreement]) -> anyhow::Result<()> {
        let truth = columns(&self.true_policy.concat());
        let actions: Vec<_> = self.true_states.concat().iter().map(|x| fit.action(view(x))).collect();
        let learnt = DMatrix::from_columns(&actions);
        let projectors: Vec<DMatrix<f64>> = self.null_space_projectors.concat().iter().map(|n| columns(n)).collect();
        let nupe = metrics::nupe(&truth, &learnt)?;
        // A projector is symmetric, so rows can be read as columns.
        let ncpe = metrics::ncpe(&truth, &learnt, |sample, mut difference| {
            let projected = &projectors[sample] * &difference;
            difference.copy_from(&projected);
        })?;
        let largest = |of: fn(&Prototype) -> f64| self.prototype.iter().map(of).fold(0.0, f64::max);
        let bound = |error: f64| if error < 1e-7 { 1e-6 } else { 3.0 * error };
        let least = self.prototype.iter().map(|fit| fit.r_squared).fold(1.0, f64::min);
        let margin = if self.positions.is_some() { 0.05 } else { 0.01 };
        let report = fit.report();
        let t = report.curl_t.context("no curl test")?;
        let rotates = self.prototype[0].model == ModelKind::Helmholtz;
        let right = report.model == self.prototype[0].model && if rotates { t > 2.5 } else { t < 2.0 };
        let ratio = report.expected_nupe / nupe;
        let expected = nupe < 1e-3 || (0.1..10.0).contains(&ratio);
        let over = [nupe / bound(largest(|fit| fit.nupe)), ncpe / bound(largest(|fit| fit.ncpe))];
        let wrong = [(least - report.r_squared).max(0.0) / margin, f64::from(!right), f64::from(!expected)];
        let excess = [over[0].max(over[1]), wrong[0], wrong[1], wrong[2]];
        for (agreement, excess) in agreements.iter_mut().zip(excess) {
            agreement.compare([1.0 + excess], &[1.0]);
        }
        Ok(())
    }
}
