//! The fields of an output, eight side by side, as predictions need them.

use lanes::{LANES, Lanes};

use super::local_model::LocalModel;

/// Rows of a block before those of the dimensions: 0 for each field and infinity for each lane without; the activation
/// above which a field takes part, infinite for those that are not trustworthy; offset; noise variance, and 1 where it is
/// known.
pub(super) const FAR: usize = 0;
pub(super) const CUTOFF: usize = 1;
pub(super) const OFFSET: usize = 2;
pub(super) const NOISE: usize = 3;
pub(super) const NOISE_KNOWN: usize = 4;
const HEAD: usize = 5;

/// Rows of a dimension: centre, slope.
pub(super) const AXIS: usize = 2;

/// All fields of an output, in blocks of eight.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FieldTable {
    n_in: usize,
    /// Rows of a metric: the diagonal of D, or its upper triangle row after row.
    metric: usize,
    /// For each block its head, its dimensions, its metric.
    rows: Vec<Lanes>,
    /// What only confidence asks for: for each block the mean, then as many rows a direction as there are inputs.
    loadings: Vec<Lanes>,
    /// Where each block's loadings begin, and where the last one's end.
    starts: Vec<usize>,
}

/// One block.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block<'a> {
    pub(super) head: &'a [Lanes; HEAD],
    pub(super) axes: &'a [[Lanes; AXIS]],
    pub(super) metric: &'a [Lanes],
}

impl FieldTable {
    /// Fields of `n_in` inputs, of which the trustworthy take part above `cutoff`.
    pub(super) fn new(n_in: usize, models: &[LocalModel], cutoff: f64) -> Self {
        let full = models.iter().any(|model| model.metric.len() != n_in);
        let metric = if full { n_in * (n_in + 1) / 2 } else { n_in };
        let mut table = FieldTable { n_in, metric, rows: Vec::new(), loadings: Vec::new(), starts: vec![0] };
        for fields in models.chunks(LANES) {
            table.push(fields, cutoff);
        }
        table
    }

    fn push(&mut self, fields: &[LocalModel], cutoff: f64) {
        let (n, start, from) = (self.n_in, self.rows.len(), self.loadings.len());
        let directions = fields.iter().filter_map(|model| Some(model.affine.as_ref()?.loadings.len() / n)).max();
        self.rows.resize(start + self.size(), [0.0; LANES]);
        self.loadings.resize(from + n * (1 + directions.unwrap_or(0)), [0.0; LANES]);
        let (rows, loadings) = (&mut self.rows[start..], &mut self.loadings[from..]);
        (rows[FAR], rows[CUTOFF]) = ([f64::INFINITY; LANES], [f64::INFINITY; LANES]);
        for (lane, model) in fields.iter().enumerate() {
            rows[FAR][lane] = 0.0;
            let (axes, metric) = rows[HEAD..].split_at_mut(AXIS * n);
            for (axis, &centre) in axes.iter_mut().step_by(AXIS).zip(&model.centre) {
                axis[lane] = centre;
            }
            for (k, row) in metric.iter_mut().enumerate() {
                row[lane] = model.metric[if self.metric == n { k } else { place_in_triangle(n, k) }];
            }
            let Some(affine) = &model.affine else { continue };
            for (axis, &slope) in axes[1..].iter_mut().step_by(AXIS).zip(&affine.slope) {
                axis[lane] = slope;
            }
            rows[CUTOFF][lane] = cutoff;
            rows[OFFSET][lane] = affine.offset;
            rows[NOISE][lane] = affine.noise.unwrap_or(0.0);
            rows[NOISE_KNOWN][lane] = if affine.noise.is_some() { 1.0 } else { 0.0 };
            for (row, &value) in loadings.iter_mut().zip(affine.mean.iter().chain(&affine.loadings)) {
                row[lane] = value;
            }
        }
        self.starts.push(self.loadings.len());
    }

    fn size(&self) -> usize {
        HEAD + AXIS * self.n_in + self.metric
    }

    pub(super) fn n_in(&self) -> usize {
        self.n_in
    }

    /// Whether fields may turn.
    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.metric != self.n_in
    }

    #[inline(always)]
    pub(super) fn n_blocks(&self) -> usize {
        self.starts.len() - 1
    }

    #[inline(always)]
    pub(super) fn block(&self, b: usize) -> Block<'_> {
        let size = self.size();
        self.named(&self.rows[b * size..][..size])
    }

    /// All blocks in order.
    #[inline(always)]
    pub(super) fn blocks(&self) -> impl Iterator<Item = Block<'_>> {
        self.rows.chunks_exact(self.size()).map(|rows| self.named(rows))
    }

    #[inline(always)]
    fn named<'a>(&self, rows: &'a [Lanes]) -> Block<'a> {
        let (head, rest) = rows.split_first_chunk().expect("a block has its head");
        let (axes, metric) = rest.split_at(AXIS * self.n_in);
        Block { head, axes: axes.as_chunks().0, metric }
    }

    /// Mean of a block's fields, and their loadings, direction after direction.
    #[inline(always)]
    pub(super) fn loadings(&self, b: usize) -> (&[Lanes], &[Lanes]) {
        self.loadings[self.starts[b]..self.starts[b + 1]].split_at(self.n_in)
    }
}

/// Where element `k` of the upper triangle, row after row, stands in an (n, n) matrix.
fn place_in_triangle(n: usize, mut k: usize) -> usize {
    let mut row = 0;
    while k >= n - row {
        k -= n - row;
        row += 1;
    }
    row * n + row + k
}
