//! Arrays of any format: descriptions and contents.

use crate::raw::remark;
use crate::rows::stamps::Stamp;
use crate::{ReadError, TimeUnit};
use motion::Finding;

/// Description of an array, read before its numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ArraySpec {
    pub(crate) name: String,
    /// In C order: the last index runs fastest.
    pub(crate) shape: Vec<usize>,
    pub(crate) kind: Kind,
}

/// Contents of an array.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Kind {
    /// Numbers, with the format's name for their type: "float32".
    Number(&'static str),
    /// Characters.
    Text,
    /// Python objects.
    Pickled,
    /// Another type, by its name: "complex128".
    Other(String),
}

/// The contents of an array; the last index runs fastest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Data {
    Numbers(Vec<f64>),
    /// Integers. Stamps need them exactly.
    Whole(Vec<i64>),
    /// Dates.
    Dates(Vec<i64>, TimeUnit),
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

    /// A finding about integers and short floating-point numbers, whose rounding acts as noise.
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

    /// The contents as f64; `None` for text.
    pub(crate) fn numbers(self) -> Option<Vec<f64>> {
        match self {
            Data::Numbers(numbers) => Some(numbers),
            Data::Whole(whole) => Some(whole.into_iter().map(|value| value as f64).collect()),
            Data::Dates(..) | Data::Text(_) => None,
        }
    }

    pub(crate) fn stamp(&self, at: usize) -> (Stamp, Option<TimeUnit>) {
        match self {
            Data::Numbers(numbers) => (Stamp::number(numbers[at]), None),
            Data::Whole(whole) => (Stamp::whole(whole[at]), None),
            Data::Dates(dates, unit) => (Stamp::whole(dates[at]), Some(*unit)),
            Data::Text(texts) => Stamp::text(&texts[at]).unwrap_or((Stamp::MISSING, None)),
        }
    }

    /// The value at an index as a label; integers have no decimal point.
    pub(crate) fn label(&self, at: usize) -> String {
        match self {
            Data::Numbers(numbers) => format!("{}", numbers[at]),
            Data::Whole(whole) | Data::Dates(whole, _) => format!("{}", whole[at]),
            Data::Text(texts) => texts[at].clone(),
        }
    }

    /// Reorders values from Fortran order, where the first index runs fastest, to C order, where the last one does.
    pub(crate) fn in_c_order(self, shape: &[usize]) -> Self {
        match self {
            Data::Numbers(numbers) => Data::Numbers(transposed(&numbers, shape)),
            Data::Whole(whole) => Data::Whole(transposed(&whole, shape)),
            Data::Dates(dates, unit) => Data::Dates(transposed(&dates, shape), unit),
            Data::Text(texts) => Data::Text(transposed(&texts, shape)),
        }
    }
}

/// Reorders values from Fortran order (the first index of `shape` runs fastest) to C order (the last one does).
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
        // a[i][j][k] = 100 i + 10 j + k of shape (2, 3, 2); the first index runs fastest.
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
