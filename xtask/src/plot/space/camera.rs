use nalgebra::{Matrix3, RowVector3};

/// From where a scene is looked at, far away: parallel lines stay parallel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Camera {
    /// Where the viewer stands, turned about z from x, degrees.
    pub(crate) azimuth: f64,
    /// How far above the plane z = 0 the viewer is, degrees.
    pub(crate) elevation: f64,
}

impl Camera {
    /// Looking along −x: y to the right, z up.
    pub(crate) const FRONT: Camera = Camera { azimuth: 0.0, elevation: 0.0 };
    /// Looking along −y, x to the left, z up.
    pub(crate) const LEFT: Camera = Camera { azimuth: 90.0, elevation: 0.0 };
    /// Looking along y: x to the right, z up.
    pub(crate) const RIGHT: Camera = Camera { azimuth: -90.0, elevation: 0.0 };

    /// Rows: what is to the right, up, and towards the viewer; orthonormal.
    pub(super) fn axes(&self) -> Matrix3<f64> {
        let (s, c) = self.azimuth.to_radians().sin_cos();
        let (rise, run) = self.elevation.to_radians().sin_cos();
        Matrix3::from_rows(&[
            RowVector3::new(-s, c, 0.0),
            RowVector3::new(-rise * c, -rise * s, run),
            RowVector3::new(run * c, run * s, rise),
        ])
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn axes_are_orthonormal_and_right_handed(azimuth in -400.0..400.0, elevation in -90.0..=90.0) {
            let axes = Camera { azimuth, elevation }.axes();
            prop_assert!((axes * axes.transpose() - Matrix3::identity()).norm() < 1e-14);
            prop_assert!((axes.determinant() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn what_is_higher_is_never_drawn_lower(azimuth in -400.0..400.0, elevation in -90.0..=90.0) {
            let seen = Camera { azimuth, elevation }.axes() * Vector3::z();
            prop_assert!(seen.x.abs() < 1e-15 && seen.y > -1e-15);
        }
    }

    #[test]
    fn from_the_front_left_is_right() {
        let seen = |camera: Camera, point: Vector3<f64>| camera.axes() * point;
        assert!((seen(Camera::FRONT, Vector3::y()) - Vector3::x()).norm() < 1e-15);
        assert!((seen(Camera::FRONT, Vector3::x()) - Vector3::z()).norm() < 1e-15);
        assert!((seen(Camera::LEFT, Vector3::x()) + Vector3::x()).norm() < 1e-15);
        assert!((seen(Camera::RIGHT, Vector3::x()) - Vector3::x()).norm() < 1e-15);
    }
}
