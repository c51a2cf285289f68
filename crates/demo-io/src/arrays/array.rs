//! Arrays of any format: what they are, and their numbers.

use crate::ReadError;
use crate::raw::remark;
use crate::rows::stamps::{Stamp, TicksPerSecond};
use motion::Finding;

/// What a file says of an array before its numbers are read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ArraySpec {
    pub(crate) name: String,
    /// The last index runs fastest.
    pub(crate) shape: Vec<usize>,
    pub(crate) kind: Kind,
}

/// What an array holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Kind {
    /// Numbers, with the format's name for them: "float32".
    Number(&'static str),
    /// Letters.
    Text,
    /// Python objects.
    Pickled,
    /// Something else, by its name: "complex128".
    Other(String),
}

/// The content of an array, the last index running fastest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Data {
    Numbers(Vec<f64>),
    /// Whole numbers, which stamps need exactly.
    Whole(Vec<i64>),
    /// Dates.
    Dates(Vec<i64>, TicksPerSecond),
    Text(Vec<String>),
}

/// Reads the numbers of an array by its index.
pub(crate) type Load<'a> = dyn FnMut(usize) -> Result<Data, ReadError> + 'a;

impl ArraySpec {
    pub(crate) fn is_number(&self) -> bool {
        matches!(self.kind, Kind::Number(_))
    }

    /// `robot0_joint_pos (60, 7)`.
    pub(crate) fn with_shape(&self) -> String {
        format!("{} ({})", self.name, shape_text(&self.shape))
    }

    /// Whole numbers and short ones are noise that the user should know of.
    pub(crate) fn coarse(&self, file: &str) -> Option<Finding> {
        let Kind::Number(kind) = self.kind else { return None };
        let (name, next) = (&self.name, "save float32 or float64");
        match kind {
            "float16" => Some(remark(format!("'{name}' of {file} holds float16, 3 digits"), next)),
            _ if kind.contains("int") || kind == "bool" => {
                Some(remark(format!("'{name}' of {file} holds {kind}; rounding is noise of 0.29 counts"), next))
            }
            _ => None,
        }
    }
}

pub(crate) fn shape_text(shape: &[usize]) -> String {
    shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

impl Data {
    pub(crate) fn len(&self) -> usize {
        match self {
            Data::Numbers(numbers) => numbers.len(),
            Data::Whole(whole) | Data::Dates(whole, _) => whole.len(),
            Data::Text(texts) => texts.len(),
        }
    }

    /// As f64; text is none.
    pub(crate) fn numbers(self) -> Option<Vec<f64>> {
        match self {
            Data::Numbers(numbers) => Some(numbers),
            Data::Whole(whole) => Some(whole.into_iter().map(|value| value as f64).collect()),
            Data::Dates(..) | Data::Text(_) => None,
        }
    }

    pub(crate) fn stamp(&self, at: usize) -> (Stamp, Option<TicksPerSecond>) {
        match self {
            Data::Numbers(numbers) => (Stamp::number(numbers[at]), None),
            Data::Whole(whole) => (Stamp::whole(whole[at]), None),
            Data::Dates(ticks, unit) => (Stamp::whole(ticks[at]), Some(*unit)),
            Data::Text(texts) => Stamp::text(&texts[at]).unwrap_or((Stamp::MISSING, None)),
        }
    }

    /// As a label: whole numbers without a point.
    pub(crate) fn label(&self, at: usize) -> String {
        match self {
            Data::Numbers(numbers) => format!("{}", numbers[at]),
            Data::Whole(whole) | Data::Dates(whole, _) => format!("{}", whole[at]),
            Data::Text(texts) => texts[at].clone(),
        }
    }

    /// The last index slowest instead of fastest: what Fortran order needs to become C order.
    pub(crate) fn in_c_order(self, shape: &[usize]) -> Self {
        match self {
            Data::Numbers(numbers) => Data::Numbers(transposed(&numbers, shape)),
            Data::Whole(whole) => Data::Whole(transposed(&whole, shape)),
            Data::Dates(ticks, unit) => Data::Dates(transposed(&ticks, shape), unit),
            Data::Text(texts) => Data::Text(transposed(&texts, shape)),
        }
    }
}

/// Values in the order in which the last index of `shape` runs fastest, from the order in which the first does.
pub(crate) fn transposed<T: Clone>(values: &[T], shape: &[usize]) -> Vec<T> {
    let mut strides = Vec::with_capacity(shape.len());
    let mut stride = 1;
    for &length in shape {
        strides.push(stride);
        stride *= length;
    }
    let mut index = vec![0; shape.len()];
    let mut at = 0;
    let mut out = Vec::with_capacity(values.len());
    for _ in 0..values.len() {
        out.push(values[at].clone());
        for axis in (0..shape.len()).rev() {
            index[axis] += 1;
            at += strides[axis];
            if index[axis] < shape[axis] {
                break;
            }
            at -= strides[axis] * shape[axis];
            index[axis] = 0;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fortran_order_is_undone() {
        // a[i][j][k] = 100 i + 10 j + k of shape (2, 3, 2), the first index fastest.
        let mut fortran = Vec::new();
        for k in 0..2 {
            for j in 0..3 {
                for i in 0..2 {
                    fortran.push(100 * i + 10 * j + k);
                }
            }
        }
        assert_eq!(transposed(&fortran, &[2, 3, 2]), [0, 1, 10, 11, 20, 21, 100, 101, 110, 111, 120, 121]);
    }
}
