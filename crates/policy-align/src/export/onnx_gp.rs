use gp::{DirectFormula, Fall, ScaledStates, Shape, SlopeFormula, Term};
use nalgebra::DMatrix;

use super::onnx_graph::{Graph, LearnerOutputs};

/// Scaled coordinates z, (B, n), their differences from the learnt states, (B, M, n), and the squared distances,
/// (B, M).
fn differences(graph: &Graph, scaled: &ScaledStates<'_>, state: &str) -> [String; 3] {
    let (n, m) = scaled.z.shape();
    let mean = graph.constant(&[n], scaled.mean.iter().copied());
    let spread = graph.number(scaled.spread);
    let z = graph.node("Div", &[&graph.node("Sub", &[state, &mean]), &spread]);
    let learnt = graph.constant(&[1, m, n], scaled.z.iter().copied());
    let apart = graph.node("Sub", &[&graph.unsqueezed(&z, 1), &learnt]);
    let squared = graph.sum(&graph.node("Mul", &[&apart, &apart]), 2);
    [z, apart, squared]
}

fn support(graph: &Graph, squared_radius: f64, squared: &str) -> String {
    graph.node("LessOrEqual", &[&graph.least(squared, 1), &graph.number(squared_radius)])
}

/// The transpose, (M, n), of a matrix (n, M).
fn rows(graph: &Graph, matrix: &DMatrix<f64>) -> String {
    graph.constant(&[matrix.ncols(), matrix.nrows()], matrix.iter().copied())
}

/// π = speed (Σ g v − h (vᵀa) a + c + Q z), and φ.
pub(super) fn write_slope(
    graph: &Graph,
    slope: &SlopeFormula<'_>,
    squared_radius: f64,
    (inputs, moving_dim): (&str, usize),
) -> LearnerOutputs {
    let [z, apart, squared] = differences(graph, &slope.scaled, inputs);
    let (n, m) = slope.scaled.z.shape();
    // Differences of the state alone, without its context.
    let (apart, moving) = if n > moving_dim {
        let learnt = slope.scaled.z.rows(0, moving_dim).into_owned();
        let learnt = graph.constant(&[1, m, moving_dim], learnt.iter().copied());
        let apart = graph.node("Sub", &[&graph.unsqueezed(&graph.first_columns(&z, moving_dim), 1), &learnt]);
        let squared = graph.sum(&graph.node("Mul", &[&apart, &apart]), 2);
        (apart, squared)
    } else {
        (apart, squared.clone())
    };
    let directions = rows(graph, &slope.directions);
    let along = graph.sum(&graph.node("Mul", &[&apart, &directions]), 2);
    let [g, h] = slopes(graph, slope, moving_dim, (&squared, &moving));
    let straight = graph.product(&g, &directions);
    let bent = graph.unsqueezed(&graph.node("Mul", &[&h, &along]), 2);
    let bent = graph.sum(&graph.node("Mul", &[&bent, &apart]), 1);
    let constant = graph.constant(&[n], slope.constant.iter().copied());
    // The columns of Q are the rows of its transpose, which multiplies from the right.
    let sloped = graph.product(&z, &rows(graph, &slope.matrix));
    let trend = graph.node("Add", &[&sloped, &constant]);
    let along_state = if n > moving_dim { graph.first_columns(&trend, moving_dim) } else { trend };
    let action = graph.node("Add", &[&graph.node("Sub", &[&straight, &bent]), &along_state]);
    let potential = slope.has_potential.then(|| {
        let falling = graph.sum(&graph.node("Mul", &[&g, &along]), 1);
        let half = graph.node("Add", &[&graph.times(&sloped, 0.5), &constant]);
        let trend = graph.sum(&graph.node("Mul", &[&z, &half]), 1);
        graph.times(&graph.node("Add", &[&falling, &trend]), -slope.scaled.speed * slope.scaled.spread)
    });
    let support = support(graph, squared_radius, &squared);
    LearnerOutputs { action: graph.times(&action, slope.scaled.speed), potential, support }
}

/// û = unit Σ k(z, z') A.
pub(super) fn write_direct(
    graph: &Graph,
    direct: &DirectFormula<'_>,
    squared_radius: f64,
    state: &str,
) -> LearnerOutputs {
    let [z, _, squared] = differences(graph, &direct.scaled, state);
    let (n, m) = direct.scaled.z.shape();
    let learnt = graph.constant(&[n, m], direct.scaled.z.transpose().iter().copied());
    let product = graph.product(&z, &learnt);
    let [constant, linear, quadratic] = direct.trend.map(|factor| graph.number(factor));
    let trend = graph.node("Add", &[&graph.node("Mul", &[&product, &quadratic]), &linear]);
    let trend = graph.node("Mul", &[&trend, &product]);
    let mut sum = graph.node("Add", &[&trend, &constant]);
    for &term in &direct.terms {
        sum = graph.node("Add", &[&sum, &covariance(graph, term, &squared)]);
    }
    let action = graph.product(&sum, &rows(graph, direct.weights));
    let support = support(graph, squared_radius, &squared);
    LearnerOutputs { action: graph.times(&action, direct.scaled.speed), potential: None, support }
}

/// g and h of (S3), summed over the terms, (B, M) each.
fn slopes(graph: &Graph, slope: &SlopeFormula<'_>, dim: usize, (squared, moving): (&str, &str)) -> [String; 2] {
    // Without terms, zeros of the right shape.
    let mut sums = [graph.times(squared, 0.0), graph.times(squared, 0.0)];
    for &term in &slope.terms {
        let terms = slope_term(graph, term, dim, (squared, moving));
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum = graph.node("Add", &[sum, &term]);
        }
    }
    sums
}

/// amplitude · e^(factor · tensor).
fn exponential(graph: &Graph, amplitude: f64, factor: f64, tensor: &str) -> String {
    graph.times(&graph.node("Exp", &[&graph.times(tensor, factor)]), amplitude)
}

/// √(factor · s).
fn root(graph: &Graph, factor: f64, squared: &str) -> String {
    graph.node("Sqrt", &[&graph.times(squared, factor)])
}

fn slope_term(graph: &Graph, term: Term, dim: usize, (squared, moving): (&str, &str)) -> [String; 2] {
    let Term { fall, length, amplitude } = term;
    let per_square = 1.0 / (length * length);
    match fall {
        Fall::Shape(Shape::SquaredExponential) => {
            let g = exponential(graph, amplitude, -0.5 * per_square, squared);
            let h = graph.times(&g, per_square);
            [g, h]
        }
        Fall::Shape(Shape::Matern52) => {
            let r = root(graph, 5.0 * per_square, squared);
            let e = exponential(graph, amplitude, -1.0, &r);
            let factor = graph.node("Add", &[&r, &graph.number(1.0)]);
            [graph.node("Mul", &[&factor, &e]), graph.times(&e, 5.0 * per_square)]
        }
        Fall::Shape(Shape::Matern32) => {
            let rate = 3.0_f64.sqrt() / length;
            let distance = graph.node("Sqrt", &[squared]);
            let g = exponential(graph, amplitude, -rate, &distance);
            let distance = graph.node("Max", &[&distance, &graph.number(1e-12)]);
            let h = graph.node("Div", &[&graph.times(&g, rate), &distance]);
            [g, h]
        }
        Fall::DivergenceFree => {
            let others = dim as f64 - 1.0;
            let e = exponential(graph, amplitude / others.max(1.0), -0.5 * per_square, squared);
            let (ratio, others) = (graph.times(moving, per_square), graph.number(others));
            let factor = graph.node("Sub", &[&others, &ratio]);
            [graph.node("Mul", &[&factor, &e]), graph.times(&e, -per_square)]
        }
    }
}

fn covariance(graph: &Graph, term: Term, squared: &str) -> String {
    let Term { fall, length, amplitude } = term;
    let per_square = 1.0 / (length * length);
    let polynomial = match fall {
        Fall::Shape(Shape::SquaredExponential) | Fall::DivergenceFree => {
            return exponential(graph, amplitude, -0.5 * per_square, squared);
        }
        Fall::Shape(Shape::Matern52) => Some(1.0 / 3.0),
        Fall::Shape(Shape::Matern32) => None,
    };
    let r = root(graph, if polynomial.is_some() { 5.0 } else { 3.0 } * per_square, squared);
    let e = exponential(graph, amplitude, -1.0, &r);
    let mut factor = graph.node("Add", &[&r, &graph.number(1.0)]);
    if let Some(third) = polynomial {
        factor = graph.node("Add", &[&factor, &graph.times(&graph.node("Mul", &[&r, &r]), third)]);
    }
    graph.node("Mul", &[&factor, &e])
}
