use std::fmt;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector, DVectorView, Point3};

use super::link_point::LinkPoint;

/// One constraint on a roll-out.
#[derive(Debug, Clone)]
pub(crate) struct Part {
    pub(crate) kind: Kind,
    /// Seconds: it holds from here (inclusive) …
    pub(crate) from: f64,
    /// … to here (exclusive).
    pub(crate) until: f64,
}

/// A(x, t), (k, n), or why it has no value there.
pub(crate) type Rows = dyn Fn(DVectorView<'_, f64>, f64) -> Result<DMatrix<f64>, String> + Send + Sync;

/// The kind of constraint.
#[derive(Clone)]
pub(crate) enum Kind {
    /// The state keeps its value along each row of A, (k, n).
    Normal(DMatrix<f64>),
    /// It does not move along rows that change with state and time.
    Function(Arc<Rows>),
    /// A link's origin keeps its height over a plane through where it is; rows of normals, (k, 3).
    Plane(LinkPoint, DMatrix<f64>),
    /// The state does not come nearer than `radius` to `centre`.
    Ball { centre: DVector<f64>, radius: f64 },
    /// Nor does a link's origin.
    LinkBall { link: LinkPoint, centre: Point3<f64>, radius: f64 },
}

/// A part evaluated at a state.
pub(crate) enum Said {
    /// Rows of A u = 0, in units of the state.
    Rows(DMatrix<f64>),
    /// Distance from the ball, its radius, and the gradient of the distance, (n).
    Distance { clearance: f64, radius: f64, gradient: DVector<f64> },
}

impl fmt::Debug for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Normal(rows) => f.debug_tuple("Normal").field(rows).finish(),
            Kind::Function(_) => f.write_str("Function"),
            Kind::Plane(link, normals) => f.debug_tuple("Plane").field(link).field(normals).finish(),
            Kind::Ball { centre, radius } => f.debug_tuple("Ball").field(centre).field(radius).finish(),
            Kind::LinkBall { link, centre, radius } => {
                f.debug_tuple("LinkBall").field(link).field(centre).field(radius).finish()
            }
        }
    }
}

impl Kind {
    pub(crate) fn at(&self, state: DVectorView<'_, f64>, time: f64) -> Result<Said, String> {
        Ok(match self {
            Kind::Normal(rows) => Said::Rows(rows.clone()),
            Kind::Function(rows) => Said::Rows(fitting(rows(state, time)?, state.len())?),
            Kind::Plane(link, normals) => Said::Rows(normals * link.at(state)?.1),
            Kind::Ball { centre, radius } => {
                let apart = state - centre;
                let distance = apart.norm();
                Said::Distance { clearance: distance - radius, radius: *radius, gradient: apart / distance.max(1e-300) }
            }
            Kind::LinkBall { link, centre, radius } => {
                let (origin, jacobian) = link.at(state)?;
                let apart = origin - centre;
                let distance = apart.norm();
                let gradient = jacobian.tr_mul(&apart) / distance.max(1e-300);
                Said::Distance { clearance: distance - radius, radius: *radius, gradient }
            }
        })
    }

    /// The quantity that must not change while it holds, or for balls must not fall below 0.
    pub(crate) fn kept(&self, state: DVectorView<'_, f64>, time: f64) -> Result<(DVector<f64>, bool), String> {
        let unit_rows = |rows: &DMatrix<f64>| {
            let mut rows = rows.clone();
            rows.row_iter_mut().for_each(|mut row| row /= row.norm());
            rows
        };
        Ok(match self {
            Kind::Normal(rows) => (unit_rows(rows) * state, false),
            // Rows that change forbid directions; there need not be anything that they keep.
            Kind::Function(_) => (DVector::zeros(0), false),
            Kind::Plane(link, normals) => (unit_rows(normals) * link.at(state)?.0.coords, false),
            Kind::Ball { .. } | Kind::LinkBall { .. } => match self.at(state, time)? {
                Said::Distance { clearance, .. } => (DVector::from_element(1, clearance), true),
                Said::Rows(_) => (DVector::zeros(0), true),
            },
        })
    }
}

/// Rows of as many finite numbers as the state has.
pub(crate) fn fitting(rows: DMatrix<f64>, n: usize) -> Result<DMatrix<f64>, String> {
    if rows.ncols() != n {
        return Err(format!("its rows have {} numbers, the state {n}", rows.ncols()));
    }
    if rows.iter().any(|number| !number.is_finite()) {
        return Err("it has a number that is not finite".to_owned());
    }
    Ok(rows)
}
