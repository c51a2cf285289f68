//! Identities of factors and decompositions, and comparisons with nalgebra. They form one test program, because several
//! would compile the library several times.
#![allow(missing_docs, clippy::unwrap_used)]

mod drawn;
mod eigen;
mod factor;
mod laplacian;
mod product;
mod qr;
mod svd;
