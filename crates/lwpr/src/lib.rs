//! Locally weighted projection regression (LWPR): learns a smooth function online, one sample at a time.
//!
//! A model is a set of *receptive fields*: Gaussian kernels in the input space, each with a local linear model. A
//! prediction is the mean of the local models, weighted by the activations of their fields. A sample that activates no
//! field creates a new one; all others learn from it by incremental least squares along a few projections of the input,
//! and adapt their distance metrics by gradient descent on a leave-one-out error. The model stores the fields and no
//! samples. The algorithm is Vijayakumar, D'Souza and Schaal, "Incremental online learning in high dimensions", Neural
//! Computation 17 (2005).
//!
//! ```
//! use lwpr::LwprParams;
//! use nalgebra::{DMatrix, DVector};
//!
//! let xs = DMatrix::from_fn(1, 500, |_, i| (i * 211 % 500) as f64 / 250.0 - 1.0); // Samples are columns.
//! let ys = xs.map(|x| (3.0 * x).sin());
//!
//! let mut model = LwprParams { init_d: 50.0, ..LwprParams::default() }.build(1, 1)?;
//! model.fit_in_order(xs.as_view(), ys.as_view(), 10)?; // A batch …
//! model.update(xs.column(7), ys.column(7))?; // … or one sample at a time.
//!
//! let predictor = model.predictor(0.001); // An immutable snapshot, quick and to be shared between threads.
//! let p = predictor.predict(DVector::from_element(1, 0.5).as_view()).expect("trained here");
//! assert!((p.value[0] - 1.5_f64.sin()).abs() < 0.02);
//! assert!((p.gradient[(0, 0)] - 3.0 * 1.5_f64.cos()).abs() < 0.5);
//! assert!(predictor.predict(DVector::from_element(1, 40.0).as_view()).is_none()); // Nothing was learnt there.
//! # Ok::<(), lwpr::LwprError>(())
//! ```
//!
//! # What to choose
//!
//! - `norm_in`, `norm_out`: the spread of each dimension. All other settings refer to data divided by these.
//! - `init_d`: the most important one. Fields are about 2/√`init_d` wide. Start with a few tens in 2 dimensions, less
//!   in more, and double it while a validation error decreases. If it is too small, one field covers everything; if it
//!   is too large, there are so many fields that each has only a few samples.
//! - [`Metric::Diagonal`] is nearly always right. [`Metric::Full`] rotates fields along valleys, at O(n³) per sample
//!   and field.
//! - [`MetricAdaptation::Gradient`] adapts the fields' shapes; [`Meta`](MetricAdaptation::Meta) also adapts their
//!   learning rates, which then may start low (`init_alpha` of a few); [`Fixed`](MetricAdaptation::Fixed) suits data
//!   that are dense and even.
//! - Samples in random order learn better than along trajectories: [`Lwpr::fit_batch`] shuffles every pass.
//!
//! Between updates the model itself can predict ([`Lwpr::predict_into`], [`Lwpr::value_and_gradient_into`]), without a
//! snapshot. [`Training::fit`] learns outputs whose mean and size are not known in advance.
//!
//! Training on a batch gives the same model as on its samples one by one, bit for bit, at any number of threads, but
//! faster.
//!
//! # When it fails
//!
//! - **Time and memory grow with the number of fields.** In few dimensions this number converges, and a sample costs
//!   the same among 10⁶ as among 10³. In many dimensions with noise the number keeps growing: with 22 inputs the total
//!   time grows as n^2.1 beyond 10⁴ samples (`docs/performance.md`). A smaller `init_d` or `w_gen`, or
//!   `max_receptive_fields`, limits it.
//! - **Outside all fields** there is no prediction: [`Predictor::predict`] returns `None` below its cutoff.
//! - **Gradients** are those of a weighted mean of local lines; they are less accurate than values where there are few
//!   fields.
//! - [`LwprError`]: parameters out of range, wrong dimensions, or numbers that are not finite.

// Code under `pulp::Arch::dispatch` is compiled for the actual processor only if it is inlined.
#![allow(clippy::inline_always)]
// Several rows are indexed in parallel, and lanes are numbered.
#![allow(clippy::needless_range_loop)]

mod error;
mod field;
mod learning;
mod model;
mod prediction;
mod settings;
mod standardised;

pub use error::{LwprError, Side};
pub use field::receptive_field::ReceptiveField;
pub use model::Lwpr;
pub use prediction::{LocalPrediction, Prediction, Predictor};
pub use settings::kernel::Kernel;
pub use settings::params::{LwprParams, Metric, MetricAdaptation, Pruning};
pub use standardised::{StandardisedModel, Training};

/// The program of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
