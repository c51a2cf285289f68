//! A movement of a policy under a constraint that may switch on the way.

use nalgebra::{DMatrix, DVector};

/// A(x) u = b with k rows of A.
pub(crate) enum Constraint {
    /// Orthonormal columns (n, k) that span the rows of A, and A⁺b (n).
    Fixed { basis: DMatrix<f64>, push: DVector<f64> },
    /// A(x) = A(0) + Σ_i x_i D_i, (k, n) each, and b in the orthonormal coordinates of its rows, (k).
    Turning { at_origin: DMatrix<f64>, drifts: Vec<DMatrix<f64>>, press: DVector<f64> },
}

impl Constraint {
    /// No constraint, in n dimensions.
    pub(crate) fn none(dim: usize) -> Self {
        Constraint::Fixed { basis: DMatrix::zeros(dim, 0), push: DVector::zeros(dim) }
    }

    /// The velocity Nπ + A⁺b.
    pub(crate) fn velocity(&self, x: &DVector<f64>, policy: &DVector<f64>) -> DVector<f64> {
        let projected = |basis: &DMatrix<f64>, push: &DVector<f64>| policy - basis * basis.tr_mul(policy) + push;
        match self {
            Constraint::Fixed { basis, push } => projected(basis, push),
            Constraint::Turning { at_origin, drifts, press } => {
                let mut a = at_origin.clone();
                for (x, drift) in x.iter().zip(drifts) {
                    a += drift * *x;
                }
                let basis = a.transpose().qr().q();
                projected(&basis, &(&basis * press))
            }
        }
    }
}

/// The integration method from one sample to the next.
#[derive(Clone, Copy)]
pub(crate) enum Integration {
    /// One Euler step.
    Euler,
    /// This number of fourth-order Runge-Kutta steps.
    RungeKutta(usize),
}

/// A movement of `policy` from sample to sample, `time_step` apart.
pub(crate) struct Movement<'a> {
    pub(crate) policy: &'a dyn Fn(&DVector<f64>) -> DVector<f64>,
    pub(crate) integration: Integration,
    pub(crate) time_step: f64,
    pub(crate) constraint: Constraint,
    pub(crate) state: DVector<f64>,
}

impl Movement<'_> {
    /// Returns the present state and velocity, then advances to the next sample.
    pub(crate) fn sample(&mut self) -> (DVector<f64>, DVector<f64>) {
        let flow = |x: &DVector<f64>| self.constraint.velocity(x, &(self.policy)(x));
        let (x, u) = (self.state.clone(), flow(&self.state));
        match self.integration {
            Integration::Euler => self.state += &u * self.time_step,
            Integration::RungeKutta(steps) => {
                let h = self.time_step / steps as f64;
                for _ in 0..steps {
                    let x = &self.state;
                    let a = flow(x);
                    let b = flow(&(x + &a * (0.5 * h)));
                    let c = flow(&(x + &b * (0.5 * h)));
                    let d = flow(&(x + &c * h));
                    self.state += (a + b * 2.0 + c * 2.0 + d) * (h / 6.0);
                }
            }
        }
        (x, u)
    }
}
