//! Rows side by side, so that one row is combined with many in vector registers.

use nalgebra::DMatrix;

/// Number of rows in a chunk, which fits on the stack.
pub(crate) const CHUNK: usize = 64;

/// One number for each row of a chunk.
pub(crate) type Chunk = [f64; CHUNK];

/// The columns of a matrix (n, M) in chunks: for each chunk and each dimension, one number per column. The last chunk
/// is padded with zeros.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chunks {
    numbers: Vec<Chunk>,
    dim: usize,
}

impl Chunks {
    pub(crate) fn new(columns: &DMatrix<f64>) -> Self {
        let (dim, count) = columns.shape();
        let mut numbers = vec![[0.0; CHUNK]; count.div_ceil(CHUNK) * dim];
        for (column, state) in columns.column_iter().enumerate() {
            for (k, &value) in state.iter().enumerate() {
                numbers[column / CHUNK * dim + k][column % CHUNK] = value;
            }
        }
        Chunks { numbers, dim }
    }

    pub(crate) fn len(&self) -> usize {
        self.numbers.len() / self.dim
    }

    /// One chunk: for each dimension, one number per row.
    pub(crate) fn get(&self, chunk: usize) -> &[Chunk] {
        &self.numbers[chunk * self.dim..(chunk + 1) * self.dim]
    }
}
