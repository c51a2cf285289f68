use thiserror::Error;

/// Reasons why a constraint cannot be used. All numbers count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ConstraintError {
    /// An entry of A is NaN or infinite.
    #[error(
        "constraint matrix, row {row}, column {column}: {value} is not a finite number; fix the computation of A(x, t)"
    )]
    NotFinite {
        /// Row of the entry: index of the constraint.
        row: usize,
        /// Column of the entry: dimension of the state.
        column: usize,
        /// The entry itself.
        value: f64,
    },
    /// The dimension of a state differs from the constraint's.
    #[error("the state has {found} coordinates, the constraint is for {expected}; give one for each dimension")]
    State {
        /// Coordinates of the state.
        found: usize,
        /// Dimension n of the constraint.
        expected: usize,
    },
    /// A coordinate of the state is NaN or infinite.
    #[error("coordinate {coordinate} of the state is {value}, not a finite number; fix the computation of the state")]
    StateNotFinite {
        /// The first faulty coordinate.
        coordinate: usize,
        /// Its value.
        value: f64,
    },
    /// The Jacobian of a point cannot be computed.
    #[error("the point has no Jacobian at this state: {reason}")]
    Jacobian {
        /// The error message of the function that computes it.
        reason: String,
    },
    /// The number of columns of A differs from the dimension of the state.
    #[error("the constraint matrix has {found} columns, the state {expected} dimensions; A is (k, n)")]
    Columns {
        /// Columns of A.
        found: usize,
        /// Dimension n of the state.
        expected: usize,
    },
    /// The rank tolerance is out of range.
    #[error(
        "rank tolerance {tolerance}: it is the sine of an angle and must lie between {} and 1; 1e-12 is usual",
        f64::EPSILON
    )]
    Tolerance {
        /// The given tolerance.
        tolerance: f64,
    },
    /// No direction was given in which a point may not move.
    #[error("the point has no normal; give at least one row of 2 or 3 coordinates, or use `Unconstrained`")]
    NoNormal,
    /// A normal of a point is zero, or not finite.
    #[error("normal {row} is {normal:?}; a direction is finite and not zero")]
    Normal {
        /// The first faulty row.
        row: usize,
        /// Its coordinates.
        normal: Vec<f64>,
    },
    /// A switching constraint has no phases.
    #[error("there is no constraint to switch between; give at least one, or use `Unconstrained`")]
    NoPhase,
    /// The start times of a switching constraint are not finite or not ascending.
    #[error("phase {phase} starts at {start} s: start times must be finite and each later than the one before")]
    StartTime {
        /// The first faulty phase.
        phase: usize,
        /// Its start time, in seconds.
        start: f64,
    },
    /// Two phases of a switching constraint differ in dimension.
    #[error("phase {phase} constrains {found} dimensions, phase 0 {expected}; all must share one state space")]
    PhaseDimension {
        /// The first phase that differs.
        phase: usize,
        /// Its number of dimensions.
        found: usize,
        /// The number of dimensions of phase 0.
        expected: usize,
    },
    /// A barrier was given no point.
    #[error("a barrier acts on at least one point; a state of n points has 3n coordinates")]
    NoPoint,
    /// The influence distance of a barrier is not a positive, finite length.
    #[error("a barrier's influence distance is {influence} m; it must be positive and finite")]
    Influence {
        /// The given distance, in metres.
        influence: f64,
    },
    /// A plate's position or orientation is invalid.
    #[error(
        "plate {plate}: the normal and the direction along it must be of length 1 and perpendicular, the distance finite"
    )]
    PlateInSpace {
        /// Index of the plate.
        plate: usize,
    },
    /// A plate's edges are in the wrong order, equal, or NaN.
    #[error("plate {plate}: its edges are at {from} m and {to} m; the first must be below the second")]
    PlateEdges {
        /// Index of the plate.
        plate: usize,
        /// The first edge, in metres.
        from: f64,
        /// The second edge, in metres.
        to: f64,
    },
}
