use prepare::numbers::counted;
use std::fmt;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector, DVectorView, Point3};

use super::link_point::LinkPoint;

/// One constraint on a roll-out.
#[derive(Debug, Clone)]
pub(crate) struct Part {
    pub(crate) kind: Kind,
    /// Start of the constraint in seconds, inclusive.
    pub(crate) from: f64,
    /// End of the constraint in seconds, exclusive.
    pub(crate) until: f64,
}

/// A(x, t), (k, n), or the reason why it has no value there.
type MatrixFunction = dyn Fn(DVectorView<'_, f64>, f64) -> Result<DMatrix<f64>, String> + Send + Sync;

/// The kind of constraint.
#[derive(Debug, Clone)]
pub(crate) enum Kind {
    /// The state keeps its value along each row of A, (k, n).
    Normal(DMatrix<f64>),
    /// The state does not move along rows that depend on state and time.
    Function(Function),
    /// A link's origin keeps its height over a plane through its initial position; the rows are
    /// normals, (k, 3).
    Plane(LinkPoint, DMatrix<f64>),
    /// The state stays at least `radius` from `centre`.
    Ball { centre: DVector<f64>, radius: f64 },
    /// A link's origin stays at least `radius` from `centre`.
    LinkBall { link: LinkPoint, centre: Point3<f64>, radius: f64 },
}

/// A part evaluated at a state.
pub(crate) enum Evaluated {
    /// Rows of A u = 0, in units of the state.
    Rows(DMatrix<f64>),
    /// Distance from the ball, its radius, and the gradient of the distance, (n).
    Distance { clearance: f64, radius: f64, gradient: DVector<f64> },
}

impl Evaluated {
    /// A distance from a ball's centre; `scaled`, (n), is its gradient times the distance.
    fn distance(distance: f64, radius: f64, scaled: DVector<f64>) -> Self {
        Evaluated::Distance { clearance: distance - radius, radius, gradient: scaled / distance.max(1e-300) }
    }
}

/// Shared [`MatrixFunction`].
#[derive(Clone)]
pub(crate) struct Function(pub(crate) Arc<MatrixFunction>);

impl fmt::Debug for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("A(x, t)")
    }
}

impl Kind {
    pub(crate) fn at(&self, state: DVectorView<'_, f64>, time: f64) -> Result<Evaluated, String> {
        Ok(match self {
            Kind::Normal(rows) => Evaluated::Rows(rows.clone()),
            Kind::Function(Function(rows)) => Evaluated::Rows(fitting(rows(state, time)?, state.len())?),
            Kind::Plane(link, normals) => Evaluated::Rows(normals * link.at(state)?.1),
            Kind::Ball { centre, radius } => {
                let apart = state - centre;
                Evaluated::distance(apart.norm(), *radius, apart)
            }
            Kind::LinkBall { link, centre, radius } => {
                let (origin, jacobian) = link.at(state)?;
                let apart = origin - centre;
                Evaluated::distance(apart.norm(), *radius, jacobian.tr_mul(&apart))
            }
        })
    }

    /// The quantity that must stay constant while the constraint holds or, if the flag is true (for
    /// balls), must not fall below 0.
    pub(crate) fn kept(&self, state: DVectorView<'_, f64>, time: f64) -> Result<(DVector<f64>, bool), String> {
        let unit_rows = |rows: &DMatrix<f64>| {
            let mut rows = rows.clone();
            rows.row_iter_mut().for_each(|mut row| row /= row.norm());
            rows
        };
        Ok(match self {
            Kind::Normal(rows) => (unit_rows(rows) * state, false),
            // Varying rows forbid directions; they need not keep any quantity constant.
            Kind::Function(_) => (DVector::zeros(0), false),
            Kind::Plane(link, normals) => (unit_rows(normals) * link.at(state)?.0.coords, false),
            Kind::Ball { .. } | Kind::LinkBall { .. } => match self.at(state, time)? {
                Evaluated::Distance { clearance, .. } => (DVector::from_element(1, clearance), true),
                Evaluated::Rows(_) => (DVector::zeros(0), true),
            },
        })
    }
}

/// Checks that the rows are finite and as long as the state.
pub(crate) fn fitting(rows: DMatrix<f64>, n: usize) -> Result<DMatrix<f64>, String> {
    if rows.ncols() != n {
        return Err(format!("its rows have {}, the state {n}", counted(rows.ncols(), "number")));
    }
    if rows.iter().any(|number| !number.is_finite()) {
        return Err("it has a number that is not finite".to_owned());
    }
    Ok(rows)
}
