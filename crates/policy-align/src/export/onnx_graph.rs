use std::cell::{Cell, RefCell};

use super::protobuf::Message;

/// Types of ONNX tensors.
const INT64: u64 = 7;
const BOOL: u64 = 9;
const DOUBLE: u64 = 11;

/// Name of a tensor.
pub(super) type Tensor = String;

/// A graph of ONNX operators on doubles, built node by node. Names are numbered, so that the same model gives the same
/// bytes.
#[derive(Debug, Default)]
pub(super) struct Graph {
    nodes: RefCell<Message>,
    constants: RefCell<Message>,
    made: Cell<usize>,
}

/// Type of an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Output {
    /// (B, n) doubles.
    Vectors(usize),
    /// (B) doubles.
    Numbers,
    /// (B) booleans.
    Truths,
}

/// Tensors that a learner's graph computes from scaled states.
pub(super) struct LearnerOutputs {
    /// Actions per second, (B, n).
    pub(super) action: String,
    /// Potentials in the learner's units, (B).
    pub(super) potential: Option<String>,
    /// Support, (B).
    pub(super) support: String,
}

impl Graph {
    fn name(&self, what: &str) -> Tensor {
        self.made.set(self.made.get() + 1);
        format!("{what}_{}", self.made.get())
    }

    /// A constant tensor of this shape from doubles in row-major order.
    pub(super) fn constant(&self, shape: &[usize], values: impl IntoIterator<Item = f64>) -> Tensor {
        let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
        self.tensor(shape, DOUBLE, &bytes)
    }

    /// A constant scalar.
    pub(super) fn number(&self, value: f64) -> Tensor {
        self.constant(&[], [value])
    }

    fn axis(&self, axis: u64) -> Tensor {
        self.tensor(&[1], INT64, &axis.to_le_bytes())
    }

    fn tensor(&self, shape: &[usize], kind: u64, bytes: &[u8]) -> Tensor {
        let name = self.name("c");
        let shaped = shape.iter().fold(Message::default(), |message, &length| message.integer(1, length as u64));
        let tensor = shaped.integer(2, kind).text(8, &name).bytes(9, bytes);
        self.constants.replace_with(|constants| std::mem::take(constants).message(5, &tensor));
        name
    }

    /// Adds a node without attributes.
    pub(super) fn node(&self, operator: &str, inputs: &[&str]) -> Tensor {
        let name = self.name("t");
        self.add(operator, inputs, &name, &[]);
        name
    }

    /// Names a tensor as an output.
    pub(super) fn output(&self, tensor: &str, name: &str) {
        self.add("Identity", &[tensor], name, &[]);
    }

    fn add(&self, operator: &str, inputs: &[&str], output: &str, attributes: &[Message]) {
        let node = inputs.iter().fold(Message::default(), |node, input| node.text(1, input));
        let node = node.text(2, output).text(4, operator);
        let node = attributes.iter().fold(node, |node, attribute| node.message(5, attribute));
        self.nodes.replace_with(|nodes| std::mem::take(nodes).message(1, &node));
    }

    /// Sum along an axis, which is removed.
    pub(super) fn sum(&self, tensor: &str, axis: u64) -> Tensor {
        let (axis, name) = (self.axis(axis), self.name("t"));
        self.add("ReduceSum", &[tensor, &axis], &name, &[integer("keepdims", 0)]);
        name
    }

    /// Minimum along an axis, which is removed.
    pub(super) fn least(&self, tensor: &str, axis: u64) -> Tensor {
        let name = self.name("t");
        let axes = Message::default().text(1, "axes").integer(8, axis).integer(20, 7);
        self.add("ReduceMin", &[tensor], &name, &[axes, integer("keepdims", 0)]);
        name
    }

    /// The tensor with a new axis of length 1.
    pub(super) fn unsqueezed(&self, tensor: &str, axis: u64) -> Tensor {
        self.node("Unsqueeze", &[tensor, &self.axis(axis)])
    }

    /// Rows (B, M) times a matrix (M, n). This avoids `MatMul`, which onnxruntime fuses with adjacent constants that it
    /// rounds to single precision.
    pub(super) fn product(&self, rows: &str, matrix: &str) -> Tensor {
        self.sum(&self.node("Mul", &[&self.unsqueezed(rows, 2), matrix]), 1)
    }

    /// A tensor times a number.
    pub(super) fn times(&self, tensor: &str, factor: f64) -> Tensor {
        self.node("Mul", &[tensor, &self.number(factor)])
    }

    /// Matrices (B, n) and (B, p) joined side by side.
    pub(super) fn beside(&self, left: &str, right: &str) -> Tensor {
        let name = self.name("t");
        self.add("Concat", &[left, right], &name, &[integer("axis", 1)]);
        name
    }

    /// The first `count` columns of a matrix.
    pub(super) fn first_columns(&self, tensor: &str, count: usize) -> Tensor {
        let [from, to, axis] = [0, count as u64, 1].map(|number| self.axis(number));
        self.node("Slice", &[tensor, &from, &to, &axis])
    }

    /// Completes the graph with its inputs: `x`, (B, n), and `c`, (B, p), if there is a context.
    pub(super) fn finished(self, (n, p): (usize, usize), outputs: &[(&str, Output)]) -> Message {
        let graph = self.nodes.into_inner().text(2, "policy").joined(&self.constants.into_inner());
        let graph = graph.message(11, &value("x", DOUBLE, Some(n)));
        let graph = if p > 0 { graph.message(11, &value("c", DOUBLE, Some(p))) } else { graph };
        outputs.iter().fold(graph, |graph, (name, output)| {
            let value = match output {
                Output::Vectors(n) => value(name, DOUBLE, Some(*n)),
                Output::Numbers => value(name, DOUBLE, None),
                Output::Truths => value(name, BOOL, None),
            };
            graph.message(12, &value)
        })
    }
}

/// An integer attribute.
fn integer(name: &str, value: u64) -> Message {
    Message::default().text(1, name).integer(3, value).integer(20, 2)
}

/// An input or output: its first axis counts states.
fn value(name: &str, kind: u64, n: Option<usize>) -> Message {
    let dimension = |dimension: Message| Message::default().message(1, &dimension);
    let shape = dimension(Message::default().text(2, "states"));
    let shape = n.map_or(shape.clone(), |n| shape.message(1, &Message::default().integer(1, n as u64)));
    let tensor = Message::default().integer(1, kind).message(2, &shape);
    Message::default().text(1, name).message(2, &Message::default().message(1, &tensor))
}
