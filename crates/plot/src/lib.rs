//! Pictures: rows of panels, written as SVG and PNG.
//!
//! - [`Plane`]: things in the plane, with the same scale on both axes.
//! - [`Curves`]: curves with bands, on linear or logarithmic axes, labelled at their ends.
//! - [`Canvas`]: lines, arrows and words without axes.
//! - [`Relief`]: a scalar field or dots in perspective.
//! - `Space`: 3-D scenes with hidden surfaces; requires the feature `space`.
//!
//! Sizes of panels, widths of lines and radii of dots are in pixels; everything else is in the units of the data.
//! Colours are in HTML notation, `#rrggbb`, for white paper. In an SVG, greys change for a reader who prefers dark
//! pages. The same panels give the same bytes.
//!
//! ```
//! use plot::{Dash, Layer, Picture, Plane, Stroke};
//!
//! let points = (0..=20).map(|i| f64::from(i) / 10.0).map(|t| (t - 1.0, (t - 1.0) * (t - 1.0))).collect();
//! let stroke = Stroke { color: "#0072b2", width: 1.5, dash: Dash::Solid };
//! let plane = Plane {
//!     title: "A parabola".to_owned(),
//!     x_label: "x (m)".to_owned(),
//!     y_label: "y (m)".to_owned(),
//!     x: [-1.0, 1.0],
//!     y: [0.0, 1.0],
//!     layers: vec![Layer::Path { points, stroke, label: Some("demonstrated".to_owned()) }],
//!     size: Plane::SQUARE,
//! };
//! let picture = Picture::rows(&[&[&plane]]);
//! assert!(picture.svg().starts_with("<svg"));
//! assert!(picture.png()?.starts_with(b"\x89PNG"));
//! # Ok::<(), plot::PlotError>(())
//! ```
//!
//! This crate is the only one that uses the plotting library.

mod axis;
mod colour_scale;
mod curves;
mod decimals;
mod drawing;
mod error;
mod field;
mod levels;
mod names;
mod panel;
mod picture;
mod plane;
mod relief;
mod sign;
#[cfg(feature = "space")]
mod space;
mod ticks;

pub use axis::Axis;
pub use curves::{Curve, Curves, Note};
pub use drawing::canvas::{Canvas, Thing};
pub use drawing::style::{Dash, Mark, Stroke};
pub use error::PlotError;
pub use field::Field;
pub use panel::{Panel, Sketch};
pub use picture::Picture;
pub use plane::{Layer, Plane};
pub use relief::Relief;
pub use sign::{Filling, Sign};
#[cfg(feature = "space")]
pub use space::{Camera, Frame, Item, Paint, Space};

/// Compiles the README's program.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
