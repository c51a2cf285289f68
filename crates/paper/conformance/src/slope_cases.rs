//! The slope GP: kernels, evidence, left-out trajectories, and fits with all parameters given. Samples are rows in the
//! files.

use std::path::Path;

use anyhow::{Context as _, bail};
use gp::{Block, LeftOutPredictions, Rows, Shape, SlopeData, SlopeModel};
use motion::{Policy as _, Potential as _, SampleIndex};
use nalgebra::{DMatrix, DVectorView};
use serde::Deserialize;

use super::{Agreement, read_json};

type Table = Vec<Vec<f64>>;

#[derive(Debug, Deserialize)]
struct NamedBlock {
    block: String,
    scale: f64,
}

#[derive(Debug, Deserialize)]
struct KernelCase {
    z: Table,
    n: Table,
    z2: Table,
    n2: Table,
    blocks: Vec<KernelBlock>,
}

#[derive(Debug, Deserialize)]
struct KernelBlock {
    #[serde(flatten)]
    block: NamedBlock,
    slope_slope: Table,
    policy_slope: Vec<Table>,
    potential_slope: Option<Table>,
    potential_potential: Option<Table>,
}

/// The original rows, and the values derived from them.
#[derive(Debug, Deserialize)]
struct GivenRows {
    x: Table,
    u: Table,
    trajectory: Vec<usize>,
    d_weights: Vec<f64>,
    mean: Vec<f64>,
    scale: f64,
    r_bar: f64,
}

#[derive(Debug, Deserialize)]
struct Given<C> {
    rows: GivenRows,
    cases: Vec<C>,
}

#[derive(Debug, Deserialize)]
struct EvidenceCase {
    blocks: Vec<NamedBlock>,
    theta: Vec<f64>,
    j: f64,
    gradient: Vec<f64>,
}

#[derive(Debug, Deserialize)]
struct LeftOutCase {
    blocks: Vec<NamedBlock>,
    theta: Vec<f64>,
    kappa: f64,
    residuals: Vec<f64>,
    variances: Vec<f64>,
    alpha: Vec<f64>,
    r_squared: f64,
    z_squared: f64,
}

#[derive(Debug, Deserialize)]
struct FrozenSystem {
    #[serde(flatten)]
    rows: GivenRows,
    x_test: Table,
    x_reference: Vec<f64>,
    cases: Vec<FrozenCase>,
}

#[derive(Debug, Deserialize)]
struct FrozenCase {
    family: String,
    blocks: Vec<NamedBlock>,
    theta: Vec<f64>,
    alpha: Vec<f64>,
    policy: Table,
    covariance: Vec<Table>,
    prior_covariance: Vec<Table>,
    potential: Option<Vec<f64>>,
    potential_difference: Option<Vec<f64>>,
    potential_difference_variance: Option<Vec<f64>>,
    rotational_part: Option<Table>,
}

/// Compares (S3) to (S5) of every block.
pub(super) fn check_kernels(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let cases: Vec<KernelCase> = read_json(file)?;
    let mut agreements = vec![Agreement::new("covariances", 1e-13)];
    for case in &cases {
        let pairs = || (0..case.z.len()).flat_map(|i| (0..case.z2.len()).map(move |j| (i, j)));
        for reference in &case.blocks {
            let block = block(&reference.block)?;
            let [z, n] = [&case.z, &case.n].map(|rows| |i: usize| view(&rows[i]));
            let [z2, n2] = [&case.z2, &case.n2].map(|rows| |i: usize| view(&rows[i]));
            let flat = |table: &Table| table.concat();
            let slopes = pairs().map(|(i, j)| block.slope_slope(z(i), n(i), z2(j), n2(j)));
            agreements[0].compare(slopes, &flat(&reference.slope_slope));
            let policies = pairs().flat_map(|(i, j)| block.policy_slope(z(i), z2(j), n2(j)).data.as_vec().clone());
            agreements[0].compare(policies, &reference.policy_slope.concat().concat());
            if let Some(expected) = &reference.potential_slope {
                let ours = pairs().map(|(i, j)| block.potential_slope(z(i), z2(j), n2(j)).unwrap_or(f64::NAN));
                // At equal states it is 0; the reference contains rounding errors there.
                let expected: Vec<f64> =
                    flat(expected).iter().map(|&e| if e.abs() < 1e-15 { 0.0 } else { e }).collect();
                agreements[0].compare(ours, &expected);
            }
            if let Some(expected) = &reference.potential_potential {
                let ours = pairs().map(|(i, j)| block.potential_potential(z(i), z2(j)).unwrap_or(f64::NAN));
                agreements[0].compare(ours, &flat(expected));
            }
        }
    }
    Ok(agreements)
}

/// Compares (S8) and (S9).
pub(super) fn check_evidence(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let given: Given<EvidenceCase> = read_json(file)?;
    let mut agreements =
        vec![Agreement::new("scaling", 1e-13), Agreement::new("evidence", 1e-10), Agreement::new("its gradient", 1e-8)];
    let data = given.rows.data(&mut agreements[0])?;
    for case in &given.cases {
        let evidence = data.evidence(&blocks(&case.blocks)?, &case.theta).context("no Cholesky factor")?;
        agreements[1].compare([evidence.value], &[case.j]);
        agreements[2].compare(evidence.gradient.iter().copied(), &case.gradient);
    }
    Ok(agreements)
}

/// Compares (S10) and (S11), with noise raised by κ.
pub(super) fn check_left_out(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let given: Given<LeftOutCase> = read_json(file)?;
    let mut agreements = vec![Agreement::new("scaling", 1e-13), Agreement::new("left-out trajectories", 1e-7)];
    let data = given.rows.data(&mut agreements[0])?;
    for case in &given.cases {
        let model = data.condition(&blocks(&case.blocks)?, &case.theta, case.kappa);
        let (model, LeftOutPredictions { residuals, variances, r_squared, z_squared }) =
            model.context("no Cholesky factor")?;
        agreements[1].compare(residuals.iter().copied(), &case.residuals);
        agreements[1].compare(variances, &case.variances);
        agreements[1].compare(model.weights().iter().copied(), &case.alpha);
        agreements[1].compare([r_squared, z_squared], &[case.r_squared, case.z_squared]);
    }
    Ok(agreements)
}

/// Compares (S7), (S13) and (S14).
pub(super) fn check_frozen(file: &Path) -> anyhow::Result<Vec<Agreement>> {
    let systems: Vec<FrozenSystem> = read_json(file)?;
    let mut agreements = vec![
        Agreement::new("scaling", 1e-13),
        Agreement::new("policies and potentials", 1e-8),
        Agreement::new("those of the family rough", 1e-7),
        Agreement::new("covariances", 1e-6),
    ];
    for system in &systems {
        let data = system.rows.data(&mut agreements[0])?;
        for case in &system.cases {
            let model = data.condition(&blocks(&case.blocks)?, &case.theta, 1.0);
            let (model, _) = model.context("no Cholesky factor")?;
            let means = if case.family == "rough" { 2 } else { 1 };
            agreements[means].compare(model.weights().iter().copied(), &case.alpha);
            case.compare_means(system, &model, &mut agreements[means]);
            case.compare_covariances(system, &model, &mut agreements[3]);
        }
    }
    Ok(agreements)
}

impl FrozenCase {
    fn compare_means(&self, system: &FrozenSystem, model: &SlopeModel, agreement: &mut Agreement) {
        let at = || system.x_test.iter().map(|x| view(x));
        let actions = at().flat_map(|x| model.policy().action(x).data.as_vec().clone());
        agreement.compare(actions, &self.policy.concat());
        if let Some(expected) = &self.potential {
            let potential = |x| model.potential().map_or(f64::NAN, |potential| potential.value(x));
            agreement.compare(at().map(potential), expected);
        }
        if let Some(expected) = &self.potential_difference {
            agreement.compare(Self::differences(system, model).map(|(value, _)| value), expected);
        }
        if let Some(expected) = &self.rotational_part {
            let rotation = model.rotational_part();
            agreement.compare(at().flat_map(|x| rotation.action(x).data.as_vec().clone()), &expected.concat());
        }
    }

    fn compare_covariances(&self, system: &FrozenSystem, model: &SlopeModel, agreement: &mut Agreement) {
        let at = || system.x_test.iter().map(|x| view(x));
        let numbers = |matrix: DMatrix<f64>| matrix.data.as_vec().clone();
        agreement.compare(at().flat_map(|x| numbers(model.covariance(x))), &self.covariance.concat().concat());
        agreement
            .compare(at().flat_map(|x| numbers(model.prior_covariance(x))), &self.prior_covariance.concat().concat());
        if let Some(expected) = &self.potential_difference_variance {
            agreement.compare(Self::differences(system, model).map(|(_, variance)| variance), expected);
        }
    }

    fn differences<'a>(system: &'a FrozenSystem, model: &'a SlopeModel) -> impl Iterator<Item = (f64, f64)> + 'a {
        let from = view(&system.x_reference);
        let difference = move |x: &Vec<f64>| model.potential_difference(view(x), from).unwrap_or((f64::NAN, f64::NAN));
        system.x_test.iter().map(difference)
    }
}

impl GivenRows {
    fn data(&self, scaling: &mut Agreement) -> anyhow::Result<SlopeData> {
        let rows = rows(&self.x, &self.u, &self.trajectory)?;
        let data = SlopeData::new(&rows, self.d_weights.clone())?;
        let (mean, scale) = data.scaling();
        scaling.compare(mean.iter().copied(), &self.mean);
        scaling.compare([scale, data.unit()], &[self.scale, self.r_bar]);
        Ok(data)
    }
}

/// Rows with certain velocities, each a sample of a trajectory.
pub(super) fn rows(x: &[Vec<f64>], u: &[Vec<f64>], trajectory: &[usize]) -> anyhow::Result<Rows> {
    let columns = |rows: &[Vec<f64>]| DMatrix::from_fn(rows.first().map_or(0, Vec::len), rows.len(), |k, i| rows[i][k]);
    let index = |(sample, &trajectory): (usize, &usize)| SampleIndex { trajectory, sample };
    Ok(Rows::new(columns(x), columns(u), trajectory.iter().enumerate().map(index).collect())?)
}

fn blocks(named: &[NamedBlock]) -> anyhow::Result<Vec<Block>> {
    named.iter().map(block).collect()
}

fn block(named: &NamedBlock) -> anyhow::Result<Block> {
    Ok(match named.block.as_str() {
        "Linear" | "lin" => Block::Linear,
        "Quadratic" | "quad" => Block::Quadratic,
        "SquaredExponential" | "se" => Block::Potential(Shape::SquaredExponential, named.scale),
        "Matern52" | "m5" => Block::Potential(Shape::Matern52, named.scale),
        "Matern32" | "m3" => Block::Potential(Shape::Matern32, named.scale),
        "Skew" | "skew" => Block::Skew,
        "DivergenceFree" | "df" => Block::DivergenceFree(named.scale),
        other => bail!("there is no block {other}"),
    })
}

/// A block from its short name.
pub(super) fn short(name: &str, scale: f64) -> anyhow::Result<Block> {
    block(&NamedBlock { block: name.to_owned(), scale })
}

pub(super) fn view(numbers: &[f64]) -> DVectorView<'_, f64> {
    DVectorView::from_slice(numbers, numbers.len())
}
