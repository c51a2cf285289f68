//! Linear algebra of f64 by libraries: nalgebra's matrices, algorithms of faer and approx-chol, one thread, so that the bits do not
//! depend on the number of threads.
//!
//! | | |
//! |---|---|
//! | [`Factor`] | Cholesky: K = LLᵀ, and what follows from L |
//! | [`qr_triangle`] | R of A = QR |
//! | [`singular_values`] | A = U diag(s) Vᵀ |
//! | [`symmetric_eigen`], [`symmetric_eigenvalues`] | A = V diag(λ) Vᵀ |
//! | [`LaplacianFactor`] | approximate Cholesky of a sparse graph Laplacian, to precondition with |
//! | [`transposed_product`], [`transposed_product_of_rows`], [`gram`], [`subtract_gram`], [`subtract_outer`] | products |
//!
//! Both libraries are generic and are compiled where they are used. Here that happens once; learners and their tests only link it.
//!
//! Functions panic if shapes do not fit.

mod eigen;
mod factor;
mod laplacian;
mod product;
mod qr;
mod svd;
mod view;

pub use eigen::{symmetric_eigen, symmetric_eigenvalues};
pub use factor::Factor;
pub use laplacian::LaplacianFactor;
pub use product::{gram, subtract_gram, subtract_outer, transposed_product, transposed_product_of_rows};
pub use qr::qr_triangle;
pub use svd::{Svd, singular_values};

/// The program of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
