use super::error::ExportError;
use super::onnx_graph::{Graph, Output};
use super::protobuf::Message;
use super::tables::{LearnerTables, Tables};
use super::{onnx_gp, onnx_lwpr};
use crate::{Model, Verdict};

/// The version of the operators, and the format version that introduced them.
const OPERATORS: u64 = 17;
const FORMAT: u64 = 8;

/// A model as ONNX: operators of version 17 on doubles.
///
/// Its input is `x`, (B, n), states in the units of the recording, and with a context also `c`, (B, p). Its outputs are `u`, (B, n),
/// actions per second; `phi`, (B), potentials, unless the policy has none; and `support`, (B), whether a state is within the data. Outside
/// the data, `u` is 0 and `phi` is NaN, as in [`CSource`](crate::CSource).
///
/// # Errors
/// [`ExportError`].
pub fn to_onnx(model: &Model) -> Result<Vec<u8>, ExportError> {
    let tables = Tables::of(model)?;
    let (n, all) = (tables.dim, tables.scale.len());
    let graph = Graph::default();
    let inputs = if all > n { graph.beside("x", "c") } else { "x".to_owned() };
    let scale = graph.constant(&[all], tables.scale.iter().copied());
    let scaled = graph.node("Mul", &[&inputs, &scale]);
    let learner = match &tables.learner {
        LearnerTables::Lwpr(lwpr) => onnx_lwpr::write(&graph, lwpr, &scaled),
        LearnerTables::Slope(slope, radius) => onnx_gp::write_slope(&graph, slope, *radius, (&scaled, n)),
        LearnerTables::Direct(direct, radius) => onnx_gp::write_direct(&graph, direct, *radius, &scaled),
    };
    let support = within(&graph, &inputs, &tables.bounds, &learner.support);
    let scale = if all > n { graph.constant(&[n], tables.scale.iter().take(n).copied()) } else { scale };
    let action = graph.node("Div", &[&learner.action, &scale]);
    let action = graph.node("Where", &[&graph.unsqueezed(&support, 1), &action, &graph.number(0.0)]);
    graph.output(&action, "u");
    let mut outputs = vec![("u", Output::Vectors(n))];
    if let Some(potential) = &learner.potential {
        let scaled = graph.times(potential, tables.per_unit);
        let potential = graph.node("Where", &[&support, &scaled, &graph.number(f64::NAN)]);
        graph.output(&potential, "phi");
        outputs.push(("phi", Output::Numbers));
    }
    graph.output(&support, "support");
    outputs.push(("support", Output::Truths));
    Ok(described(model, &graph.finished((n, all - n), &outputs)))
}

/// Support limited to the bounds.
fn within(graph: &Graph, inputs: &str, bounds: &[[f64; 2]], support: &str) -> String {
    let low = graph.constant(&[bounds.len()], bounds.iter().map(|[low, _]| *low));
    let high = graph.constant(&[bounds.len()], bounds.iter().map(|[_, high]| *high));
    // Distance beyond the bounds, summed over channels; 0 within them.
    let sides = [[&*low, inputs], [inputs, &high]].map(|difference| graph.node("Sub", &difference));
    let [below, above] = sides.map(|side| graph.node("Relu", &[&side]));
    let beyond = graph.sum(&graph.node("Add", &[&below, &above]), 1);
    let within = graph.node("LessOrEqual", &[&beyond, &graph.number(0.0)]);
    graph.node("And", &[support, &within])
}

/// The model file that contains a graph.
fn described(model: &Model, graph: &Message) -> Vec<u8> {
    let entry = |key: &str, value: &str| Message::default().text(1, key).text(2, value);
    let verdict = match model.trust.verdict {
        Verdict::Good => "good",
        Verdict::Doubtful => "doubtful",
        Verdict::DoNotUse => "do not use",
    };
    let described = Message::default()
        .integer(1, FORMAT)
        .text(2, "policy-align")
        .text(3, env!("CARGO_PKG_VERSION"))
        .message(7, graph)
        .message(8, &Message::default().text(1, "").integer(2, OPERATORS))
        .message(14, &entry("state", &model.channels().join(",")))
        .message(14, &entry("time_step", &model.time_step.to_string()))
        .message(14, &entry("trust", verdict));
    let context = model.context_names().join(",");
    let described = if context.is_empty() { described } else { described.message(14, &entry("context", &context)) };
    described.into_bytes()
}
