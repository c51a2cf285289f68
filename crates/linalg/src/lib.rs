//! Linear algebra of f64 by libraries: nalgebra's matrices, algorithms of faer and approx-chol. It uses one thread, so that the
//! bits do not depend on the number of threads.
//!
//! | | |
//! |---|---|
//! | [`Factor`] | Cholesky: K = LLᵀ, and results computed from L |
//! | [`qr_triangle`] | R of A = QR |
//! | [`singular_values`] | A = U diag(s) Vᵀ |
//! | [`symmetric_eigen`], [`symmetric_eigenvalues`] | A = V diag(λ) Vᵀ |
//! | [`LaplacianFactor`] | approximate Cholesky of a sparse graph Laplacian, as a preconditioner |
//! | [`transposed_product`], [`transposed_product_of_rows`], [`gram`], [`subtract_gram`], [`subtract_outer`] | products |
//!
//! Both libraries are generic and are compiled where they are used. Here that happens once; learners and their tests only link the
//! result.
//!
//! Functions panic if shapes do not match.

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

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
