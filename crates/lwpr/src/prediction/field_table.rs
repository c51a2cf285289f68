//! The fields of an output, eight side by side, in the form that predictions read.

use lanes::{LANES, Lanes};

use super::local_model::LocalModel;
use crate::field::rows::Rows;

/// Rows of a block before those of the dimensions: 0 for each field and infinity for each empty lane; the activation
/// above which a field takes part, infinite for fields that are not trustworthy; offset; noise variance, and 1 if it is
/// known.
pub(super) const FAR: usize = 0;
pub(super) const CUTOFF: usize = 1;
pub(super) const OFFSET: usize = 2;
pub(super) const NOISE: usize = 3;
pub(super) const NOISE_KNOWN: usize = 4;
const HEAD: usize = 5;

/// Rows per dimension: centre, slope.
pub(super) const AXIS: usize = 2;

/// All fields of an output, in blocks of eight.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FieldTable {
    shape: BlockShape,
    /// For each block, its head, its dimensions, its metric.
    rows: Rows,
    /// Data for the confidence only: for each block the mean, then for each direction as many rows as there are inputs.
    loadings: Rows,
    /// Position of each block's loadings, and the end of the last one's.
    starts: Vec<usize>,
}

/// Numbers of rows in the parts of a block. Passed to functions that read blocks, so that it can be a constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BlockShape {
    pub(super) n_in: usize,
    /// The diagonal of D, or its upper triangle row by row.
    metric: usize,
}

impl BlockShape {
    #[inline(always)]
    pub(super) const fn new(n_in: usize, full: bool) -> Self {
        BlockShape { n_in, metric: if full { n_in * (n_in + 1) / 2 } else { n_in } }
    }

    /// Whether the metric is full.
    #[inline(always)]
    pub(super) const fn is_full(self) -> bool {
        self.metric != self.n_in
    }

    #[inline(always)]
    const fn size(self) -> usize {
        HEAD + AXIS * self.n_in + self.metric
    }

    #[inline(always)]
    fn named(self, rows: &[Lanes]) -> Block<'_> {
        let (head, rest) = rows.split_first_chunk().expect("a block has its head");
        let (axes, metric) = rest.split_at(AXIS * self.n_in);
        Block { head, axes: axes.as_chunks().0, metric }
    }
}

/// One block.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block<'a> {
    pub(super) head: &'a [Lanes; HEAD],
    pub(super) axes: &'a [[Lanes; AXIS]],
    pub(super) metric: &'a [Lanes],
}

impl FieldTable {
    /// Fields with `n_in` inputs; the trustworthy ones take part above `cutoff`.
    pub(super) fn new(n_in: usize, models: &[LocalModel], cutoff: f64) -> Self {
        let shape = BlockShape::new(n_in, models.iter().any(|model| model.metric.len() != n_in));
        let mut rows = vec![[0.0; LANES]; models.len().div_ceil(LANES) * shape.size()];
        let (mut loadings, mut starts) = (Vec::new(), vec![0]);
        for (fields, rows) in models.chunks(LANES).zip(rows.chunks_exact_mut(shape.size())) {
            fill_block(shape, rows, fields, cutoff);
            push_loadings(n_in, &mut loadings, fields);
            starts.push(loadings.len());
        }
        let (rows, loadings) = (Rows::from(rows.as_flattened()), Rows::from(loadings.as_flattened()));
        FieldTable { shape, rows, loadings, starts }
    }

    pub(super) fn shape(&self) -> BlockShape {
        self.shape
    }

    #[inline(always)]
    pub(super) fn n_blocks(&self) -> usize {
        self.starts.len() - 1
    }

    /// Block `b`; `shape` is that of the table.
    #[inline(always)]
    pub(super) fn block(&self, shape: BlockShape, b: usize) -> Block<'_> {
        shape.named(&self.rows.as_chunks().0[b * shape.size()..][..shape.size()])
    }

    /// All blocks in order; `shape` is that of the table.
    #[inline(always)]
    pub(super) fn blocks(&self, shape: BlockShape) -> impl Iterator<Item = Block<'_>> {
        self.rows.as_chunks().0.chunks_exact(shape.size()).map(move |rows| shape.named(rows))
    }

    /// Mean of a block's fields, and their loadings, direction by direction.
    #[inline(always)]
    pub(super) fn loadings(&self, b: usize) -> (&[Lanes], &[Lanes]) {
        self.loadings.as_chunks().0[self.starts[b]..self.starts[b + 1]].split_at(self.shape.n_in)
    }
}

/// Writes the rows of a block, which are initially zero.
fn fill_block(shape: BlockShape, rows: &mut [Lanes], fields: &[LocalModel], cutoff: f64) {
    let n = shape.n_in;
    (rows[FAR], rows[CUTOFF]) = ([f64::INFINITY; LANES], [f64::INFINITY; LANES]);
    for (lane, model) in fields.iter().enumerate() {
        rows[FAR][lane] = 0.0;
        let (axes, metric) = rows[HEAD..].split_at_mut(AXIS * n);
        for (axis, &centre) in axes.iter_mut().step_by(AXIS).zip(&model.centre) {
            axis[lane] = centre;
        }
        for (k, row) in metric.iter_mut().enumerate() {
            row[lane] = model.metric[if shape.is_full() { place_in_triangle(n, k) } else { k }];
        }
        let Some(affine) = &model.affine else { continue };
        for (axis, &slope) in axes[1..].iter_mut().step_by(AXIS).zip(&affine.slope) {
            axis[lane] = slope;
        }
        rows[CUTOFF][lane] = cutoff;
        rows[OFFSET][lane] = affine.offset;
        rows[NOISE][lane] = affine.noise.unwrap_or(0.0);
        rows[NOISE_KNOWN][lane] = if affine.noise.is_some() { 1.0 } else { 0.0 };
    }
}

/// Appends the confidence data of a block.
fn push_loadings(n_in: usize, loadings: &mut Vec<Lanes>, fields: &[LocalModel]) {
    let directions = fields.iter().filter_map(|model| Some(model.affine.as_ref()?.loadings.len() / n_in)).max();
    let start = loadings.len();
    loadings.resize(start + n_in * (1 + directions.unwrap_or(0)), [0.0; LANES]);
    for (lane, model) in fields.iter().enumerate() {
        let Some(affine) = &model.affine else { continue };
        for (row, &value) in loadings[start..].iter_mut().zip(affine.mean.iter().chain(&affine.loadings)) {
            row[lane] = value;
        }
    }
}

/// Position of element `k` of the upper triangle, row by row, in an (n, n) matrix.
fn place_in_triangle(n: usize, mut k: usize) -> usize {
    let mut row = 0;
    while k >= n - row {
        k -= n - row;
        row += 1;
    }
    row * n + row + k
}
