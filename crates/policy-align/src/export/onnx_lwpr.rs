use lwpr::{Kernel, LocalPrediction};

use super::lwpr_tables::LwprTables;
use super::onnx_graph::{Asked, Graph};

/// f = mean + norm_out Σ w y / Σ w and its gradient at scaled states (B, n).
pub(super) fn write<'a>(graph: &mut Graph, lwpr: &LwprTables<'a>, scaled: &str) -> Asked {
    let (n, m) = (lwpr.norm_in.len(), lwpr.fields.len());
    let each = |of: fn(&LocalPrediction<'a>) -> &'a [f64]| lwpr.fields.iter().flat_map(of).copied().collect::<Vec<_>>();
    let norm = graph.constant(&[n], lwpr.norm_in.iter().copied());
    let centres = graph.constant(&[1, m, n], each(|field| field.centre));
    let slopes = graph.constant(&[m, n], each(|field| field.slope));
    let offsets = graph.constant(&[m], lwpr.fields.iter().map(|field| field.offset));
    let z = graph.node("Div", &[scaled, &norm]);
    let z = graph.unsqueezed(&z, 1);
    let apart = graph.node("Sub", &[&z, &centres]);
    let turned = if lwpr.is_full() {
        let metric = graph.constant(&[m, n, n], each(|field| field.metric));
        let rows = graph.unsqueezed(&apart, 2);
        let products = graph.node("Mul", &[&metric, &rows]);
        graph.sum(&products, 3)
    } else {
        let metric = graph.constant(&[m, n], each(|field| field.metric));
        graph.node("Mul", &[&apart, &metric])
    };
    let squares = graph.node("Mul", &[&apart, &turned]);
    let q = graph.sum(&squares, 2);
    let (weight, by_q) = weight(graph, lwpr.kernel, &q);
    let (cutoff, zero) = (graph.number(lwpr.cutoff), graph.number(0.0));
    let takes_part = graph.node("Greater", &[&weight, &cutoff]);
    let weight = graph.node("Where", &[&takes_part, &weight, &zero]);
    let by_q = graph.node("Where", &[&takes_part, &by_q, &zero]);
    let local = graph.node("Mul", &[&apart, &slopes]);
    let local = graph.sum(&local, 2);
    let local = graph.node("Add", &[&local, &offsets]);
    let total = graph.sum(&weight, 1);
    let support = graph.node("Greater", &[&total, &zero]);
    // Where nothing takes part, 0 / 1.
    let one = graph.number(1.0);
    let divisor = graph.node("Where", &[&support, &total, &one]);
    let weighted = graph.node("Mul", &[&weight, &local]);
    let value = graph.sum(&weighted, 1);
    let value = graph.node("Div", &[&value, &divisor]);
    let column = graph.unsqueezed(&value, 1);
    let off = graph.node("Sub", &[&local, &column]);
    let off = graph.node("Mul", &[&off, &by_q]);
    let off = graph.unsqueezed(&off, 2);
    let bent = graph.node("Mul", &[&off, &turned]);
    let bent = graph.sum(&bent, 1);
    let straight = graph.product(&weight, &slopes);
    let gradient = graph.node("Add", &[&straight, &bent]);
    let divisor = graph.unsqueezed(&divisor, 1);
    let gradient = graph.node("Div", &[&gradient, &divisor]);
    let gradient = graph.node("Div", &[&gradient, &norm]);
    let potential = graph.times(&value, lwpr.norm_out);
    let mean = graph.number(lwpr.mean);
    let potential = graph.node("Add", &[&potential, &mean]);
    Asked { action: graph.times(&gradient, -lwpr.norm_out), potential: Some(potential), support }
}

/// w of q, and twice its derivative.
fn weight(graph: &mut Graph, kernel: Kernel, q: &str) -> (String, String) {
    match kernel {
        Kernel::Gaussian => {
            let exponent = graph.times(q, -0.5);
            let weight = graph.node("Exp", &[&exponent]);
            let by_q = graph.node("Neg", &[&weight]);
            (weight, by_q)
        }
        Kernel::BiSquare => {
            let (one, fallen) = (graph.number(1.0), graph.times(q, -0.25));
            let edge = graph.node("Add", &[&fallen, &one]);
            let edge = graph.node("Relu", &[&edge]);
            let weight = graph.node("Mul", &[&edge, &edge]);
            let by_q = graph.node("Neg", &[&edge]);
            (weight, by_q)
        }
    }
}
