use nalgebra::{DMatrix, DVectorView, Point3, UnitVector3, Vector3};

use crate::{ConstraintError, PfaffianConstraint};

/// Largest cosine between perpendicular directions, and largest deviation of a unit vector's length from 1.
const DIRECTION_TOLERANCE: f64 = 1e-9;

/// A thin flat plate: a strip of the plane `normal`·p = `distance` between two parallel edges, infinite along them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// Normal of the plate. It blocks motion in this direction, forwards and backwards.
    pub normal: UnitVector3<f64>,
    /// Signed distance of the plane from the origin, in metres.
    pub distance: f64,
    /// Direction in the plate from one edge to the other; perpendicular to `normal`.
    pub along: UnitVector3<f64>,
    /// Positions of the two edges, `along`·p in metres. Either may be infinite.
    pub edges: [f64; 2],
}

impl Plate {
    /// Whether a point is nearer to the plane than `influence` and strictly between the edges.
    pub fn blocks(&self, point: &Point3<f64>, influence: f64) -> bool {
        let from_plane = self.normal.dot(&point.coords) - self.distance;
        let across = self.along.dot(&point.coords);
        from_plane.abs() < influence && self.edges[0] < across && across < self.edges[1]
    }

    fn check(&self, plate: usize) -> Result<(), ConstraintError> {
        let Plate { normal, distance, along, edges: [from, to] } = *self;
        let unit = |direction: Vector3<f64>| (direction.norm() - 1.0).abs() <= DIRECTION_TOLERANCE;
        let square = normal.dot(&along).abs() <= DIRECTION_TOLERANCE;
        if !(unit(*normal) && unit(*along) && square && distance.is_finite()) {
            return Err(ConstraintError::PlateInSpace { plate });
        }
        if from < to { Ok(()) } else { Err(ConstraintError::PlateEdges { plate, from, to }) }
    }
}

/// Plates that points cannot pass: while a plate blocks a point, the point may not move along the plate's normal, `nᵀ ṗ = 0`.
/// If no point is blocked, there is no constraint, so that the rank switches with the state.
///
/// The state consists of the stacked positions of all points, (3·points), in metres; A has one row for each point and plate
/// that blocks it, in the order of the points. A wall with a gap is two plates:
///
/// ```
/// use constraints::{Barrier, PfaffianConstraint, Plate};
/// use nalgebra::{Vector3, dvector};
///
/// let beside = |edges| Plate { normal: Vector3::x_axis(), distance: 0.4, along: Vector3::y_axis(), edges };
/// let plates = vec![beside([f64::NEG_INFINITY, -0.1]), beside([0.1, f64::INFINITY])];
/// let two_hands = Barrier::new(plates, 0.05, 2)?;
///
/// // The left hand is in front of a plate, the right hand in front of the gap.
/// let hands = dvector![0.38, 0.3, 0.7, 0.38, -0.05, 0.7];
/// let free = two_hands.null_space_projector(hands.as_view(), 0.0)?.project(dvector![1.0, 2.0, 3.0, 4.0, 5.0, 6.0].as_view());
/// assert_eq!(free, dvector![0.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
/// # Ok::<(), constraints::ConstraintError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Barrier {
    plates: Vec<Plate>,
    influence: f64,
    n_points: usize,
}

impl Barrier {
    /// `plates` that act on each of `n_points` points within the distance `influence`, in metres.
    ///
    /// # Errors
    /// [`ConstraintError::NoPoint`], [`ConstraintError::Influence`], [`ConstraintError::PlateInSpace`] or
    /// [`ConstraintError::PlateEdges`].
    pub fn new(plates: Vec<Plate>, influence: f64, n_points: usize) -> Result<Self, ConstraintError> {
        if n_points == 0 {
            return Err(ConstraintError::NoPoint);
        }
        if !(influence.is_finite() && influence > 0.0) {
            return Err(ConstraintError::Influence { influence });
        }
        plates.iter().enumerate().try_for_each(|(at, plate)| plate.check(at))?;
        Ok(Barrier { plates, influence, n_points })
    }

    /// The plates.
    pub fn plates(&self) -> &[Plate] {
        &self.plates
    }

    /// The influence distance: distance from its plane up to which a plate blocks, in metres.
    pub fn influence(&self) -> f64 {
        self.influence
    }
}

impl PfaffianConstraint for Barrier {
    fn dim(&self) -> usize {
        3 * self.n_points
    }

    fn matrix(&self, state: DVectorView<'_, f64>, _time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        if state.len() != self.dim() {
            return Err(ConstraintError::State { found: state.len(), expected: self.dim() });
        }
        // Comparisons with NaN would make the point unconstrained.
        if let Some(coordinate) = state.iter().position(|value| !value.is_finite()) {
            return Err(ConstraintError::StateNotFinite { coordinate, value: state[coordinate] });
        }
        let position = |point: usize| Point3::new(state[3 * point], state[3 * point + 1], state[3 * point + 2]);
        let blocked: Vec<(usize, Vector3<f64>)> = (0..self.n_points)
            .flat_map(|point| self.plates.iter().map(move |plate| (point, plate)))
            .filter(|&(point, plate)| plate.blocks(&position(point), self.influence))
            .map(|(point, plate)| (point, *plate.normal))
            .collect();
        let mut matrix = DMatrix::zeros(blocked.len(), self.dim());
        for (row, (point, normal)) in blocked.into_iter().enumerate() {
            matrix.fixed_view_mut::<1, 3>(row, 3 * point).tr_copy_from(&normal);
        }
        Ok(matrix)
    }
}
