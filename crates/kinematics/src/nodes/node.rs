use lanes::Number;
use nalgebra::{IsometryMatrix3, Rotation3, Unit, Vector3};

use super::placement::{Padded, Placement, padded};

/// A link, and the joint that carries it: `placement = parent · origin · motion(value)`.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    /// Index of the parent node, smaller than the node's own; the root is its own parent.
    pub(crate) parent: usize,
    /// Index of the joint's value among the couplings; `None` if the motion is fixed.
    pub(crate) coupling: Option<usize>,
    pub(crate) motion: Motion,
    translation: Option<Padded>,
    rotation: Option<[Padded; 3]>,
}

/// How a joint moves its link. Rotations about coordinate axes are separate cases, because they leave one column unchanged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Motion {
    Fixed,
    RotationX,
    RotationY,
    RotationZ,
    /// A rotation about a unit axis.
    Rotation(Padded),
    /// A displacement along a unit axis.
    Translation(Padded),
}

/// Value, sine and cosine of one moving joint.
#[derive(Clone, Copy)]
pub(crate) struct Position<T> {
    pub(crate) value: T,
    pub(crate) sine: T,
    pub(crate) cosine: T,
}

impl<T: Number> Position<T> {
    /// The same numbers in every lane.
    #[inline(always)]
    pub(crate) fn of(token: T::Token, value: f64, sine: f64, cosine: f64) -> Self {
        Position { value: T::splat(token, value), sine: T::splat(token, sine), cosine: T::splat(token, cosine) }
    }

    /// A joint at zero.
    #[inline(always)]
    pub(crate) fn zero(token: T::Token) -> Self {
        Self::of(token, 0.0, 0.0, 1.0)
    }
}

impl Motion {
    /// A rotation about an axis, and the sign by which its angle is multiplied: a rotation about −z is the reverse of one
    /// about z.
    pub(crate) fn rotation(axis: Unit<Vector3<f64>>) -> (Self, f64) {
        match (axis.x, axis.y, axis.z) {
            (x, 0.0, 0.0) => (Motion::RotationX, x),
            (0.0, y, 0.0) => (Motion::RotationY, y),
            (0.0, 0.0, z) => (Motion::RotationZ, z),
            _ => (Motion::Rotation(padded(&axis)), 1.0),
        }
    }
}

impl Node {
    pub(crate) fn new(parent: usize, coupling: Option<usize>, motion: Motion, origin: &IsometryMatrix3<f64>) -> Self {
        let translation = origin.translation.vector;
        let rotation = origin.rotation;
        Node {
            parent,
            coupling,
            motion,
            translation: (translation != Vector3::zeros()).then(|| padded(&translation)),
            rotation: (rotation != Rotation3::identity())
                .then(|| [0, 1, 2].map(|column| padded(&rotation.matrix().column(column).into_owned()))),
        }
    }

    /// The link's placement if its parent link is at `parent`.
    #[inline(always)]
    pub(crate) fn placed<T: Number, const W: usize>(
        &self,
        parent: Placement<T, W>,
        joint: Position<T>,
    ) -> Placement<T, W> {
        let mut placement = parent;
        if let Some(translation) = self.translation {
            placement = placement.translated(translation);
        }
        if let Some(rotation) = &self.rotation {
            placement = placement.rotated(rotation);
        }
        let Position { value, sine, cosine } = joint;
        match self.motion {
            Motion::Fixed => placement,
            Motion::RotationX => placement.turned(1, 2, sine, cosine),
            Motion::RotationY => placement.turned(2, 0, sine, cosine),
            Motion::RotationZ => placement.turned(0, 1, sine, cosine),
            Motion::Rotation(axis) => placement.rotated(&about(axis, sine, cosine)),
            Motion::Translation(axis) => placement.translated([value * axis[0], value * axis[1], value * axis[2]]),
        }
    }

    /// The joint's axis in root axes if its link is at `placement`; a motion does not change its own axis.
    #[inline(always)]
    pub(crate) fn axis<T: Number, const W: usize>(&self, placement: &Placement<T, W>) -> [T; W] {
        match self.motion {
            Motion::Fixed => [placement.origin[0].like(0.0); W],
            Motion::RotationX => placement.axes[0],
            Motion::RotationY => placement.axes[1],
            Motion::RotationZ => placement.axes[2],
            Motion::Rotation(axis) | Motion::Translation(axis) => placement.direction(axis),
        }
    }
}

/// The columns of the rotation about a unit axis (Rodrigues).
#[inline(always)]
fn about<T: Number>([x, y, z, _]: Padded, sine: T, cosine: T) -> [[T; 3]; 3] {
    let rest = cosine.like(1.0) - cosine;
    let (xy, yz, zx) = (rest * x * y, rest * y * z, rest * z * x);
    [
        [cosine + rest * x * x, xy + sine * z, zx - sine * y],
        [xy - sine * z, cosine + rest * y * y, yz + sine * x],
        [zx + sine * y, yz - sine * x, cosine + rest * z * z],
    ]
}
