use constraints::PfaffianConstraint;
use motion::{Policy, Potential, Trajectory};
use nalgebra::{DVector, DVectorView};
use serde::Serialize;

use crate::instant::{Actor, Instant, System, observed};
use crate::{DemoGenError, Part, Recording};

/// Parameters of the simulation of a movement: x ← x + δt N(x,t) π(x), from time 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RollOut {
    /// Time δt between two samples, in seconds. Default 1.
    pub time_step: f64,
    /// Number of samples N, including the start. Default 40.
    pub n_samples: usize,
    /// Number of Euler steps from one sample to the next. Default 1, the paper's plain Euler; more steps approximate the
    /// flow of the policy in continuous time better.
    pub sub_steps: usize,
}

impl Default for RollOut {
    fn default() -> Self {
        RollOut { time_step: 1.0, n_samples: 40, sub_steps: 1 }
    }
}

impl RollOut {
    /// The movement of the policy π = −∇φ from `start` (n): N states, and at each of them, the last included, the velocity
    /// `u_i = N(x_i, t_i) π(x_i)`, with `t_i = i δt`.
    ///
    /// # Errors
    /// [`DemoGenError::TimeStep`], [`DemoGenError::TooFewSamples`], [`DemoGenError::NoSubStep`],
    /// [`DemoGenError::Dimensions`], [`DemoGenError::Constraint`], or [`DemoGenError::Diverged`] with the first sample
    /// that is not finite.
    pub fn record<P, C>(
        &self,
        potential: &P,
        constraint: &C,
        start: DVectorView<'_, f64>,
    ) -> Result<Recording, DemoGenError>
    where
        P: Potential + ?Sized,
        C: PfaffianConstraint + ?Sized,
    {
        self.recording(&System::constrained(Actor::OfPotential(&potential), &constraint), start)
    }

    /// The movement of any policy from `start` (n), like that of a potential by [`RollOut::record`]: N states with their
    /// velocities `N(x_i, t_i) π(x_i)`.
    ///
    /// ```
    /// use constraints::LinearConstraint;
    /// use demo_gen::RollOut;
    /// use motion::Policy;
    /// use nalgebra::{DVectorView, DVectorViewMut, dmatrix, dvector};
    ///
    /// /// Round and round: the policy of no potential.
    /// struct Whirl;
    ///
    /// impl Policy for Whirl {
    ///     fn dim(&self) -> usize {
    ///         2
    ///     }
    ///
    ///     fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
    ///         (action[0], action[1]) = (-state[1], state[0]);
    ///     }
    /// }
    ///
    /// let rail = LinearConstraint::new(dmatrix![1.0, 0.0])?;
    /// let movement = RollOut::default().follow(&Whirl, &rail, dvector![2.0, 1.0].as_view())?;
    /// assert_eq!(movement.state(3).into_owned(), dvector![2.0, 7.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`RollOut::record`].
    pub fn follow<P, C>(
        &self,
        policy: &P,
        constraint: &C,
        start: DVectorView<'_, f64>,
    ) -> Result<Trajectory, DemoGenError>
    where
        P: Policy + ?Sized,
        C: PfaffianConstraint + ?Sized,
    {
        let system = System::constrained(Actor::OfPolicy(&policy), &constraint);
        observed(&self.instants(&system, start)?, self.time_step)
    }

    /// The movement of a system, with its truth.
    pub(crate) fn recording(
        &self,
        system: &System<'_>,
        start: DVectorView<'_, f64>,
    ) -> Result<Recording, DemoGenError> {
        Recording::of(self.instants(system, start)?, self.time_step)
    }

    /// All samples of a movement.
    fn instants(&self, system: &System<'_>, start: DVectorView<'_, f64>) -> Result<Vec<Instant>, DemoGenError> {
        self.check()?;
        let (expected, of_constraint) = system.dims();
        for (part, found) in [(Part::Start, start.len()), (Part::Constraint, of_constraint)] {
            if found != expected {
                return Err(DemoGenError::Dimensions { part, found, expected });
            }
        }
        let mut instants = vec![system.instant(start.into_owned(), 0.0, 0)?];
        for sample in 1..self.n_samples {
            let state = self.advance(system, &instants[sample - 1], sample - 1)?;
            instants.push(system.instant(state, self.time_step * sample as f64, sample)?);
        }
        Ok(instants)
    }

    /// The state one time step after `sample`.
    fn advance(&self, system: &System<'_>, from: &Instant, sample: usize) -> Result<DVector<f64>, DemoGenError> {
        let step = self.time_step / self.sub_steps as f64;
        let mut state = &from.state + step * &from.velocity;
        for sub_step in 1..self.sub_steps {
            let time = self.time_step * sample as f64 + step * sub_step as f64;
            let between = system.instant(state, time, sample)?;
            state = between.state + step * between.velocity;
        }
        Ok(state)
    }

    pub(crate) fn check(&self) -> Result<(), DemoGenError> {
        let RollOut { time_step, n_samples, sub_steps } = *self;
        if !(time_step.is_finite() && time_step > 0.0) {
            return Err(DemoGenError::TimeStep { time_step });
        }
        if n_samples < 2 {
            return Err(DemoGenError::TooFewSamples { n_samples });
        }
        if sub_steps == 0 {
            return Err(DemoGenError::NoSubStep);
        }
        Ok(())
    }
}
