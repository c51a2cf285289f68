//! Identities of factors and decompositions, and the same by nalgebra. They are one program beside the library, which would
//! otherwise be compiled twice.
#![allow(missing_docs, clippy::unwrap_used)]

mod drawn;
mod eigen;
mod factor;
mod laplacian;
mod product;
mod qr;
mod svd;
