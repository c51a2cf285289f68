use nalgebra::{Matrix3, RowVector3};

/// The direction from which a scene is viewed. The projection is orthographic: parallel lines stay parallel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Azimuth of the viewer, about z from x, degrees.
    pub azimuth: f64,
    /// Elevation of the viewer above the plane z = 0, degrees.
    pub elevation: f64,
}

impl Camera {
    /// View along x: y to the left, z up.
    pub const BEHIND: Camera = Camera { azimuth: 180.0, elevation: 0.0 };
    /// View down: y to the left, x up.
    pub const ABOVE: Camera = Camera { azimuth: 180.0, elevation: 90.0 };

    /// Rows: directions to the right, up, and towards the viewer; orthonormal.
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
        fn higher_points_are_never_drawn_lower(azimuth in -400.0..400.0, elevation in -90.0..=90.0) {
            let seen = Camera { azimuth, elevation }.axes() * Vector3::z();
            prop_assert!(seen.x.abs() < 1e-15 && seen.y > -1e-15);
        }
    }

    #[test]
    fn named_views_have_the_expected_axes() {
        let seen = |azimuth, elevation, point: Vector3<f64>| Camera { azimuth, elevation }.axes() * point;
        let near = |a: Vector3<f64>, b: Vector3<f64>| (a - b).norm() < 1e-15;
        let Camera { azimuth, elevation } = Camera::BEHIND;
        assert!(near(seen(azimuth, elevation, Vector3::y()), -Vector3::x()));
        assert!(near(seen(azimuth, elevation, Vector3::z()), Vector3::y()));
        assert!(near(seen(azimuth, elevation, Vector3::x()), -Vector3::z()));
        let Camera { azimuth, elevation } = Camera::ABOVE;
        assert!(near(seen(azimuth, elevation, Vector3::y()), -Vector3::x()));
        assert!(near(seen(azimuth, elevation, Vector3::x()), Vector3::y()));
        // Viewed along −x, y is to the right.
        assert!(near(seen(0.0, 0.0, Vector3::y()), Vector3::x()));
    }
}
