//! Queries to an output, and the fields that take part in them.

use lanes::Lanes;

use super::field_table::FieldTable;
use crate::Kernel;

/// Data shared by all queries of a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scale {
    pub(super) kernel: Kernel,
    /// Squared distance beyond which activations are below the cutoff.
    pub(super) squared_radius: f64,
    /// 1 / `norm_in`, because a division costs as much as ten multiplications.
    pub(super) per_norm_in: Vec<f64>,
}

/// A query to one output.
#[derive(Debug, Clone, Copy)]
pub(super) struct Query<'a> {
    pub(super) table: &'a FieldTable,
    pub(super) scale: &'a Scale,
    pub(super) x: &'a [f64],
    pub(super) norm_out: f64,
}

/// A block with activated fields: squared distances, activations, 2 dw/dq, local predictions.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub(super) struct Active {
    pub(super) q: Lanes,
    pub(super) w: Lanes,
    pub(super) dw: Lanes,
    pub(super) y: Lanes,
    pub(super) block: usize,
}
