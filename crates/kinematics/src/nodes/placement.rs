use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Translation3, Vector3};

/// A vector with a fourth number that means nothing: four fill a vector register.
pub(crate) type Padded = [f64; 4];

/// Where a frame is: the columns of its rotation, and its origin, in root axes and metres.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Placement {
    pub(crate) axes: [Padded; 3],
    pub(crate) origin: Padded,
}

impl Placement {
    pub(crate) const IDENTITY: Placement =
        Placement { axes: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]], origin: [0.0; 4] };

    /// `Σ axes[i] · part[i]`: a vector given in this frame's axes, in root axes.
    #[inline(always)]
    pub(crate) fn direction(&self, part: Padded) -> Padded {
        let [x, y, z] = self.axes;
        std::array::from_fn(|i| x[i] * part[0] + y[i] * part[1] + z[i] * part[2])
    }

    /// Moves the origin by a vector given in this frame's axes.
    #[inline(always)]
    pub(crate) fn translated(mut self, by: Padded) -> Self {
        let step = self.direction(by);
        self.origin = std::array::from_fn(|i| self.origin[i] + step[i]);
        self
    }

    /// Turns the frame on the spot by a rotation given by its columns.
    #[inline(always)]
    pub(crate) fn rotated(mut self, by: &[Padded; 3]) -> Self {
        self.axes = [self.direction(by[0]), self.direction(by[1]), self.direction(by[2])];
        self
    }

    /// Turns the frame on the spot about one of its own axes: only the two other columns change, `first` towards
    /// `second`.
    #[inline(always)]
    pub(crate) fn turned(mut self, first: usize, second: usize, sine: f64, cosine: f64) -> Self {
        let (a, b) = (self.axes[first], self.axes[second]);
        self.axes[first] = std::array::from_fn(|i| cosine * a[i] + sine * b[i]);
        self.axes[second] = std::array::from_fn(|i| cosine * b[i] - sine * a[i]);
        self
    }

    pub(crate) fn position(&self) -> Point3<f64> {
        let [x, y, z, _] = self.origin;
        Point3::new(x, y, z)
    }

    pub(crate) fn isometry(&self) -> IsometryMatrix3<f64> {
        let [x, y, z] = self.axes.map(|axis| Vector3::new(axis[0], axis[1], axis[2]));
        let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, z]));
        IsometryMatrix3::from_parts(Translation3::from(self.position()), rotation)
    }
}

/// A vector with its padding.
pub(crate) fn padded(vector: &Vector3<f64>) -> Padded {
    [vector.x, vector.y, vector.z, 0.0]
}

#[inline(always)]
pub(crate) fn cross(a: Padded, b: Padded) -> Padded {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0.0]
}
