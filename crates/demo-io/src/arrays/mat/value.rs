use crate::arrays::array::Data;

/// A MATLAB variable.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Numbers {
        /// The first index runs fastest.
        shape: Vec<usize>,
        kind: &'static str,
        data: Data,
    },
    Text(String),
    Cell(Vec<Value>),
    /// All fields of the first element, then all of the second.
    Struct {
        fields: Vec<String>,
        values: Vec<Value>,
    },
    /// Another type, by its name: "complex numbers".
    Other(String),
}

impl Value {
    /// The value of `[]`.
    pub(super) fn empty() -> Self {
        Value::Numbers { shape: vec![0, 0], kind: "float64", data: Data::Numbers(Vec::new()) }
    }
}
