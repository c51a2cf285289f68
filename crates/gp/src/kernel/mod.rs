//! Priors: families of blocks, their covariances and the factors of the covariances.

pub(crate) mod block;
pub(crate) mod chunks;
pub(crate) mod covariance;
pub(crate) mod direct_block;
pub(crate) mod falling;
pub(crate) mod family;
pub(crate) mod lazy_factor;
pub(crate) mod panel;
pub(crate) mod row_table;
pub(crate) mod shape;
pub(crate) mod slope_covariance;
pub(crate) mod term;
pub(crate) mod triangle;
pub(crate) mod whitening;
