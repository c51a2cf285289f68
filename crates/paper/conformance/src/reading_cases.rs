//! The direct GP, near passes, and the reading that the data support. Samples are rows in the files.

use std::path::Path;

use anyhow::{Context as _, bail};
use gp::{AutoGp, DirectBlock, DirectData, Hypothesis, ReadingNumbers, Rows, Shape, SlopeData};
use motion::Policy as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use serde::Deserialize;

use super::near_passes::NearPasses;
use super::slope_cases::{rows, short, view};
use super::{Agreement, read_json};

type Table = Vec<Vec<f64>>;

#[derive(Debug, Deserialize)]
struct DirectCase {
    x: Table,
    u: Table,
    trajectory: Vec<usize>,
    noise_weights: Vec<f64>,
    mean: Vec<f64>,
    scale: f64,
    unit: f64,
    fits: Vec<DirectFit>,
}

#[derive(Debug, Deserialize)]
struct DirectFit {
    blocks: Vec<(String, f64)>,
    theta: Vec<f64>,
    evidence: f64,
    gradient: Vec<f64>,
    kernel_corner: Vec<Table>,
    loto_residual: Table,
    loto_variance: Vec<f64>,
    r_squared: f64,
    at: Table,
    policy: Table,
    variance: Vec<f64>,
}

#[derive(Debug, Deserialize)]
struct NearCase {
    x: Table,
    u: Table,
    trajectory: Vec<usize>,
    results: Vec<NearResult>,
}

#[derive(Debug, Deserialize)]
struct NearResult {
    delta: f64,
    pairs: usize,
    samples: usize,
    share: Option<f64>,
}

#[derive(Debug, Deserialize)]
struct ReadingCase {
    positions: Vec<Table>,
    velocities: Vec<Table>,
    prototype: Prototype,
    expected_reading: Hypothesis,
    frozen: Frozen,
}

/// The parameters of both models, with noise already raised.
#[derive(Debug, Deserialize)]
struct Frozen {
    slope_blocks: Vec<(String, f64)>,
    slope_theta: Vec<f64>,
    direct_blocks: Vec<(String, f64)>,
    direct_theta: Vec<f64>,
}

#[derive(Debug, Deserialize)]
struct Prototype {
    a_s: f64,
    a_d: f64,
    p_d: f64,
    gap: f64,
    least_d: f64,
    ratio: f64,
    t: f64,
    ml: f64,
    tl: f64,
    hidden: f64,
}

/// Compares (R1) to (R4).
pub(super) fn check_direct(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let case: DirectCase = read_json(file)?;
    let mut agreements = vec![Agreement::new("direct GP", 1e-9), Agreement::new("gradient of its evidence", 1e-7)];
    let given = rows(&case.x, &case.u, &case.trajectory)?;
    let data = DirectData::new(&given, case.noise_weights.clone())?;
    let (mean, scale) = data.scaling();
    agreements[0].compare(mean.iter().copied(), &case.mean);
    agreements[0].compare([scale, data.unit()], &[case.scale, case.unit]);
    let z: Table = case.x.iter().map(|x| x.iter().zip(mean).map(|(x, mean)| (x - mean) / scale).collect()).collect();
    for fit in &case.fits {
        let blocks: Vec<DirectBlock> = fit.blocks.iter().map(direct_block).collect::<anyhow::Result<_>>()?;
        for (block, corner) in blocks.iter().zip(&fit.kernel_corner) {
            let pairs = (0..corner.len()).flat_map(|i| (0..corner.len()).map(move |j| (i, j)));
            agreements[0].compare(pairs.map(|(i, j)| block.covariance(view(&z[i]), view(&z[j]))), &corner.concat());
        }
        let evidence = data.evidence(&blocks, &fit.theta).context("no Cholesky factor")?;
        agreements[0].compare([evidence.value], &[fit.evidence]);
        agreements[1].compare(evidence.gradient.iter().copied(), &fit.gradient);
        let (model, left_out) = data.condition(&blocks, &fit.theta, 1.0).context("no Cholesky factor")?;
        agreements[0].compare(left_out.residuals.transpose().iter().copied(), &fit.loto_residual.concat());
        agreements[0].compare(left_out.variances, &fit.loto_variance);
        agreements[0].compare([left_out.r_squared], &[fit.r_squared]);
        let at = || fit.at.iter().map(|x| view(x));
        agreements[0].compare(at().flat_map(|x| model.action(x).data.as_vec().clone()), &fit.policy.concat());
        agreements[0].compare(at().map(|x| model.variance(x)), &fit.variance);
    }
    Ok(agreements)
}

/// Compares (R9); counts must be equal.
pub(super) fn check_near(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let cases: Vec<NearCase> = read_json(file)?;
    let mut agreements = vec![Agreement::new("pairs that pass near", 0.0), Agreement::new("share", 1e-12)];
    for case in &cases {
        let given = rows(&case.x, &case.u, &case.trajectory)?;
        for result in &case.results {
            let near = NearPasses::of(&given, result.delta)?;
            let counts = [near.pairs, near.samples].map(|count| count as f64);
            agreements[0].compare(counts, &[result.pairs, result.samples].map(|count| count as f64));
            let share = |share: Option<f64>| share.into_iter().collect::<Vec<_>>();
            agreements[1].compare(share(near.share), &share(result.share));
        }
    }
    Ok(agreements)
}

/// The readings of our fits, which must be equal; their numbers must be within a factor of 3 if above 1e-3.
pub(super) fn check_readings(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let cases: Vec<ReadingCase> = read_json(file)?;
    let mut agreements =
        vec![Agreement::new("readings that differ", 0.0), Agreement::new("log₃ of a ratio of numbers", 1.0)];
    agreements.push(Agreement::new("numbers with everything given", 1e-4));
    for case in &cases {
        case.compare_frozen(&mut agreements[2])?;
        let fit = AutoGp::default().fit(&case.rows()?, &mut ChaCha8Rng::seed_from_u64(0))?;
        let differs = f64::from(u8::from(fit.reading() != case.expected_reading));
        agreements[0].compare([1.0 + differs], &[1.0]);
        let (ours, theirs) = (fit.numbers(), &case.prototype);
        let least = ours.least_seen.coverage();
        let numbers = [
            (ours.a_s, theirs.a_s),
            (ours.a_d, theirs.a_d),
            (ours.p_d, theirs.p_d),
            (ours.gap, theirs.gap),
            (least, theirs.least_d),
        ];
        for (ours, theirs) in numbers.into_iter().filter(|(_, theirs)| *theirs > 1e-3) {
            agreements[1].compare([1.0 + (ours / theirs).ln() / 3.0_f64.ln()], &[1.0]);
        }
    }
    Ok(agreements)
}

impl ReadingCase {
    /// Compares (R7) of models with all parameters given.
    fn compare_frozen(&self, agreement: &mut Agreement) -> anyhow::Result<()> {
        let (frozen, rows) = (&self.frozen, self.rows()?);
        let certain = vec![1.0; rows.len()];
        let (data, direct) = (SlopeData::new(&rows, certain.clone())?, DirectData::new(&rows, certain)?);
        let slope_blocks = frozen.slope_blocks.iter().map(|(name, scale)| short(name, *scale));
        let direct_blocks = frozen.direct_blocks.iter().map(direct_block);
        let slope = data.condition(&slope_blocks.collect::<anyhow::Result<Vec<_>>>()?, &frozen.slope_theta, 1.0);
        let direct = direct.condition(&direct_blocks.collect::<anyhow::Result<Vec<_>>>()?, &frozen.direct_theta, 1.0);
        let (slope, direct) = (slope.context("no Cholesky factor")?, direct.context("no Cholesky factor")?);
        let ours = ReadingNumbers::of(&rows, &data, (&slope.0, &slope.1), (&direct.0, &direct.1));
        let theirs = &self.prototype;
        let numbers = [
            (ours.a_s, theirs.a_s),
            (ours.a_d, theirs.a_d),
            (ours.q, theirs.ratio),
            (ours.t, theirs.t),
            (ours.lambda, theirs.ml),
            (ours.t_lambda, theirs.tl),
            (ours.p_d, theirs.p_d),
            (ours.gap, theirs.gap),
            (ours.hidden, theirs.hidden.max(0.0)),
        ];
        for (ours, theirs) in numbers {
            agreement.compare([ours], &[theirs]);
        }
        Ok(())
    }

    fn rows(&self) -> anyhow::Result<Rows> {
        let trajectories = self.positions.iter().enumerate();
        let trajectory: Vec<usize> = trajectories.flat_map(|(k, samples)| vec![k; samples.len()]).collect();
        rows(&self.positions.concat(), &self.velocities.concat(), &trajectory)
    }
}

fn direct_block((name, scale): &(String, f64)) -> anyhow::Result<DirectBlock> {
    Ok(match name.as_str() {
        "con" => DirectBlock::Constant,
        "lin" => DirectBlock::Linear,
        "quad" => DirectBlock::Quadratic,
        "se" => DirectBlock::Shape(Shape::SquaredExponential, *scale),
        "m5" => DirectBlock::Shape(Shape::Matern52, *scale),
        "m3" => DirectBlock::Shape(Shape::Matern32, *scale),
        other => bail!("there is no block {other}"),
    })
}
