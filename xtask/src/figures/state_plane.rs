//! The plane of a toy system's states.

use plot::{Layer, Plane};

/// Both states from −`extent` to `extent`, on a picture of this size, pixels.
pub(super) fn state_plane(title: &str, extent: f64, layers: Vec<Layer>, size: (f64, f64)) -> Plane {
    let range = [-extent, extent];
    Plane {
        title: title.to_owned(),
        x_label: "x₁".to_owned(),
        y_label: "x₂".to_owned(),
        x: range,
        y: range,
        layers,
        size,
    }
}
