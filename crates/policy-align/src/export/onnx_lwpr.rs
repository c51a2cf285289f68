use lwpr::{Kernel, LocalPrediction};

use super::lwpr_tables::LwprTables;
use super::onnx_graph::{Graph, LearnerOutputs};

/// f = mean + norm_out Σ w y / Σ w and its gradient at scaled states (B, n).
pub(super) fn write<'a>(graph: &Graph, lwpr: &LwprTables<'a>, scaled: &str) -> LearnerOutputs {
    let (n, m) = (lwpr.norm_in.len(), lwpr.fields.len());
    let each = |of: fn(&LocalPrediction<'a>) -> &'a [f64]| lwpr.fields.iter().flat_map(of).copied().collect::<Vec<_>>();
    let norm = graph.constant(&[n], lwpr.norm_in.iter().copied());
    let centres = graph.constant(&[1, m, n], each(|field| field.centre));
    let slopes = graph.constant(&[m, n], each(|field| field.slope));
    let offsets = graph.constant(&[m], lwpr.fields.iter().map(|field| field.offset));
    let z = graph.node("Div", &[scaled, &norm]);
    let apart = graph.node("Sub", &[&graph.unsqueezed(&z, 1), &centres]);
    let turned = if lwpr.is_full() {
        let metric = graph.constant(&[m, n, n], each(|field| field.metric));
        graph.sum(&graph.node("Mul", &[&metric, &graph.unsqueezed(&apart, 2)]), 3)
    } else {
        graph.node("Mul", &[&apart, &graph.constant(&[m, n], each(|field| field.metric))])
    };
    let q = graph.sum(&graph.node("Mul", &[&apart, &turned]), 2);
    let factors = weight(graph, lwpr.kernel, &q);
    let (cutoff, zero) = (graph.number(lwpr.cutoff), graph.number(0.0));
    let takes_part = graph.node("Greater", &[&factors[0], &cutoff]);
    let [weight, by_q] = factors.map(|factor| graph.node("Where", &[&takes_part, &factor, &zero]));
    let local = graph.node("Add", &[&graph.sum(&graph.node("Mul", &[&apart, &slopes]), 2), &offsets]);
    let total = graph.sum(&weight, 1);
    let support = graph.node("Greater", &[&total, &zero]);
    // If no field takes part, the quotient is 0 / 1.
    let divisor = graph.node("Where", &[&support, &total, &graph.number(1.0)]);
    let value = graph.node("Div", &[&graph.sum(&graph.node("Mul", &[&weight, &local]), 1), &divisor]);
    let off = graph.node("Sub", &[&local, &graph.unsqueezed(&value, 1)]);
    let off = graph.unsqueezed(&graph.node("Mul", &[&off, &by_q]), 2);
    let bent = graph.sum(&graph.node("Mul", &[&off, &turned]), 1);
    let gradient = graph.node("Add", &[&graph.product(&weight, &slopes), &bent]);
    let gradient = graph.node("Div", &[&gradient, &graph.unsqueezed(&divisor, 1)]);
    let gradient = graph.node("Div", &[&gradient, &norm]);
    let potential = graph.node("Add", &[&graph.times(&value, lwpr.norm_out), &graph.number(lwpr.mean)]);
    LearnerOutputs { action: graph.times(&gradient, -lwpr.norm_out), potential: Some(potential), support }
}

/// The weight w as a function of q, and twice its derivative.
fn weight(graph: &Graph, kernel: Kernel, q: &str) -> [String; 2] {
    match kernel {
        Kernel::Gaussian => {
            let weight = graph.node("Exp", &[&graph.times(q, -0.5)]);
            let by_q = graph.node("Neg", &[&weight]);
            [weight, by_q]
        }
        Kernel::BiSquare => {
            let (one, fallen) = (graph.number(1.0), graph.times(q, -0.25));
            let edge = graph.node("Relu", &[&graph.node("Add", &[&fallen, &one])]);
            [graph.node("Mul", &[&edge, &edge]), graph.node("Neg", &[&edge])]
        }
    }
}
