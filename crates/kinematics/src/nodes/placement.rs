use std::ops::Mul;

use lanes::{Lanes, Number, Register};
use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Translation3, Vector3};
use pulp::Simd;

/// A vector with a fourth, unused number, so that it fills a vector register.
pub(crate) type Padded = [f64; 4];

/// The placement of a frame: the columns of its rotation, and its origin, in root axes and metres. For one configuration,
/// vectors are [`Padded`], or one register of four; for several, each of a vector's three components is a number for each
/// configuration.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Placement<T = f64, const W: usize = 4> {
    pub(crate) axes: [[T; W]; 3],
    pub(crate) origin: [T; W],
}

/// Placements of one frame in as many configurations as there are lanes.
pub(crate) type PlacementGroup = Placement<Lanes, 3>;

impl Placement {
    pub(crate) const IDENTITY: Placement =
        Placement { axes: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]], origin: [0.0; 4] };
}

impl<T: Number, const W: usize> Placement<T, W> {
    /// The root's placement.
    #[inline(always)]
    pub(crate) fn identity(token: T::Token) -> Self {
        let (zero, one) = (T::splat(token, 0.0), T::splat(token, 1.0));
        let mut axes = [[zero; W]; 3];
        for (i, axis) in axes.iter_mut().enumerate() {
            axis[i] = one;
        }
        Placement { axes, origin: [zero; W] }
    }

    /// `Σ axes[i] · part[i]`: a vector given in this frame's axes, in root axes.
    #[inline(always)]
    pub(crate) fn direction<F: Copy, const P: usize>(&self, part: [F; P]) -> [T; W]
    where
        T: Mul<F, Output = T>,
    {
        let [mut x, y, z] = self.axes;
        for i in 0..W {
            x[i] = x[i] * part[0] + y[i] * part[1] + z[i] * part[2];
        }
        x
    }

    /// Moves the origin by a vector given in this frame's axes.
    #[inline(always)]
    pub(crate) fn translated<F: Copy, const P: usize>(mut self, by: [F; P]) -> Self
    where
        T: Mul<F, Output = T>,
    {
        let step = self.direction(by);
        for (part, step) in self.origin.iter_mut().zip(step) {
            *part += step;
        }
        self
    }

    /// Rotates the frame about its origin by a rotation given by its columns.
    #[inline(always)]
    pub(crate) fn rotated<F: Copy, const P: usize>(mut self, by: &[[F; P]; 3]) -> Self
    where
        T: Mul<F, Output = T>,
    {
        self.axes = [self.direction(by[0]), self.direction(by[1]), self.direction(by[2])];
        self
    }

    /// Rotates the frame about one of its own axes: only the two other columns change, `first` towards `second`.
    #[inline(always)]
    pub(crate) fn turned(mut self, first: usize, second: usize, sine: T, cosine: T) -> Self {
        let (a, b) = (self.axes[first], self.axes[second]);
        for i in 0..W {
            self.axes[first][i] = cosine * a[i] + sine * b[i];
            self.axes[second][i] = cosine * b[i] - sine * a[i];
        }
        self
    }
}

impl Placement {
    pub(crate) fn position(&self) -> Point3<f64> {
        let [x, y, z, _] = self.origin;
        Point3::new(x, y, z)
    }

    /// Each vector in a register, if a register holds four numbers.
    #[inline(always)]
    pub(crate) fn in_registers<S: Simd>(&self, simd: S) -> Placement<Register<S>, 1> {
        let zero = [Register::splat(simd, 0.0)];
        let mut placement = Placement { axes: [zero; 3], origin: zero };
        for column in 0..3 {
            placement.axes[column][0] = Register::of(simd, Register::<S>::elements(&self.axes[column])[0]);
        }
        placement.origin[0] = Register::of(simd, Register::<S>::elements(&self.origin)[0]);
        placement
    }

    pub(crate) fn isometry(&self) -> IsometryMatrix3<f64> {
        let [x, y, z] = self.axes.map(|axis| Vector3::new(axis[0], axis[1], axis[2]));
        let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, z]));
        IsometryMatrix3::from_parts(Translation3::from(self.position()), rotation)
    }
}

impl<S: Simd> Placement<Register<S>, 1> {
    /// The inverse of [`Placement::in_registers`].
    #[inline(always)]
    pub(crate) fn in_memory(self) -> Placement {
        let mut placement = Placement::IDENTITY;
        for column in 0..3 {
            Register::<S>::elements_mut(&mut placement.axes[column])[0] = self.axes[column][0].raw();
        }
        Register::<S>::elements_mut(&mut placement.origin)[0] = self.origin[0].raw();
        placement
    }
}

impl PlacementGroup {
    pub(crate) const IDENTITIES: PlacementGroup = {
        let (zero, one) = ([0.0; lanes::LANES], [1.0; lanes::LANES]);
        Placement { axes: [[one, zero, zero], [zero, one, zero], [zero, zero, one]], origin: [zero; 3] }
    };

    /// The lanes of register number `part`.
    #[inline(always)]
    pub(crate) fn load<S: Simd>(&self, simd: S, part: usize) -> Placement<Register<S>, 3> {
        let mut placement = Placement::identity(simd);
        for i in 0..3 {
            for column in 0..3 {
                placement.axes[column][i] = Register::load(simd, &self.axes[column][i], part);
            }
            placement.origin[i] = Register::load(simd, &self.origin[i], part);
        }
        placement
    }

    /// Stores the lanes of register number `part`.
    #[inline(always)]
    pub(crate) fn store<S: Simd>(&mut self, placement: &Placement<Register<S>, 3>, part: usize) {
        for i in 0..3 {
            for column in 0..3 {
                placement.axes[column][i].store(&mut self.axes[column][i], part);
            }
            placement.origin[i].store(&mut self.origin[i], part);
        }
    }

    /// The placement for one of the configurations.
    #[inline]
    pub(crate) fn lane(&self, lane: usize) -> Placement {
        let vector = |of: &[Lanes; 3]| [of[0][lane], of[1][lane], of[2][lane], 0.0];
        let [x, y, z] = &self.axes;
        Placement { axes: [vector(x), vector(y), vector(z)], origin: vector(&self.origin) }
    }
}

/// A vector with its padding.
pub(crate) fn padded(vector: &Vector3<f64>) -> Padded {
    [vector.x, vector.y, vector.z, 0.0]
}

/// A vector of three parts, padded with zeros.
#[inline(always)]
pub(crate) fn vector<T: Number, const W: usize>(parts: [T; 3]) -> [T; W] {
    let mut vector = [parts[0].like(0.0); W];
    vector[..3].copy_from_slice(&parts);
    vector
}

#[inline(always)]
pub(crate) fn cross<T: Number, const W: usize>(a: [T; W], b: [T; W]) -> [T; W] {
    vector([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}
