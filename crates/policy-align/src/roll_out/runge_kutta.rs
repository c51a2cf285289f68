use nalgebra::DVector;

/// Shortest step, as a share of the interval. At the onset of a constraint the solution has a kink, which no step resolves.
const SHORTEST: f64 = 1e-6;

/// Reasons why a solution was not followed to its end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Unfollowed<E> {
    /// The field has no value somewhere.
    Field(E),
    /// The field is not finite at a state that was reached after `elapsed` seconds.
    NotFinite { state: DVector<f64>, elapsed: f64 },
    /// The step limit was reached after `elapsed` seconds.
    Steps { limit: usize, elapsed: f64 },
}

impl<E> From<E> for Unfollowed<E> {
    fn from(error: E) -> Self {
        Unfollowed::Field(error)
    }
}

/// The method of Bogacki and Shampine: order 3, with an embedded method of order 2 for step-size control.
#[derive(Debug)]
pub(crate) struct RungeKutta {
    /// Largest error of a step in each dimension, (n).
    tolerance: DVector<f64>,
    /// The step to try next, in seconds.
    step: f64,
    /// Longer intervals, in seconds, use the shortest step of an interval of this length.
    longest: f64,
    /// Largest number of steps, including rejected ones, and the number left.
    limit: usize,
    left: usize,
}

impl RungeKutta {
    pub(crate) fn new(tolerance: DVector<f64>, longest: f64, limit: usize) -> Self {
        RungeKutta { tolerance, step: f64::INFINITY, longest, limit, left: limit }
    }

    /// Follows ẋ = `field`(x, t) from t = 0 for `duration` seconds.
    pub(crate) fn follow<E>(
        &mut self,
        field: impl Fn(&DVector<f64>, f64) -> Result<DVector<f64>, E>,
        mut x: DVector<f64>,
        duration: f64,
    ) -> Result<DVector<f64>, Unfollowed<E>> {
        let shortest = SHORTEST * duration.min(self.longest);
        let mut left = duration;
        let mut k1 = field(&x, 0.0)?;
        if !finite(&k1) {
            return Err(Unfollowed::NotFinite { state: x, elapsed: 0.0 });
        }
        while left > 0.0 {
            let h = self.step.min(left).max(shortest.min(left));
            let time = duration - left;
            // If a step no longer reduces the remaining time, no number of steps suffices.
            let Some(less) = self.left.checked_sub(1).filter(|_| left - h < left) else {
                return Err(Unfollowed::Steps { limit: self.limit, elapsed: time });
            };
            self.left = less;
            let k2 = field(&(&x + &k1 * (0.5 * h)), time + 0.5 * h)?;
            let k3 = field(&(&x + &k2 * (0.75 * h)), time + 0.75 * h)?;
            let next = &x + (&k1 * (2.0 / 9.0) + &k2 * (1.0 / 3.0) + &k3 * (4.0 / 9.0)) * h;
            let k4 = field(&next, time + h)?;
            let error = (&k1 * (-5.0 / 72.0) + &k2 * (1.0 / 12.0) + &k3 * (1.0 / 9.0) + &k4 * (-0.125)) * h;
            let error = error.component_div(&self.tolerance).amax();
            // A non-finite value may result from a step that is too long; a shorter one is tried.
            let lost = !(finite(&next) && finite(&k4));
            if lost && h <= shortest {
                return Err(Unfollowed::NotFinite { state: x, elapsed: time });
            }
            let error = if lost || error.is_nan() { f64::INFINITY } else { error };
            if !lost && (error <= 1.0 || h <= shortest) {
                left = if h >= left { 0.0 } else { left - h };
                (x, k1) = (next, k4);
            }
            self.step = h * (0.9 * error.cbrt().recip()).clamp(0.2, 5.0);
        }
        Ok(x)
    }
}

fn finite(vector: &DVector<f64>) -> bool {
    vector.iter().all(|entry| entry.is_finite())
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use nalgebra::dvector;

    use super::*;

    #[test]
    fn a_circle_is_followed_within_the_tolerance() {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let turn = |x: &DVector<f64>, _: f64| Ok::<_, Infallible>(dvector![-x[1], x[0]]);
            let mut method = RungeKutta::new(DVector::repeat(2, tolerance), 2.0, 10_000);
            let end = method.follow(turn, dvector![1.0, 0.0], 2.0).unwrap();
            let error = (end - dvector![2.0_f64.cos(), 2.0_f64.sin()]).norm();
            assert!(error < 100.0 * tolerance && error > 0.0, "{error} {tolerance}");
        }
    }

    #[test]
    fn time_is_that_of_each_stage() {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let growing = |x: &DVector<f64>, t: f64| Ok::<_, Infallible>(x * t.cos());
            let end = RungeKutta::new(dvector![tolerance], 3.0, 10_000).follow(growing, dvector![1.0], 3.0).unwrap();
            let error = (end[0] - 3.0_f64.sin().exp()).abs();
            assert!(error < 100.0 * tolerance, "{error} {tolerance}");
        }
    }

    #[test]
    fn an_edge_is_passed() {
        let field = |x: &DVector<f64>, _: f64| Ok::<_, Infallible>(dvector![if x[0] < 0.5 { 1.0 } else { 0.0 }]);
        let tolerance = 1e-4;
        let end = RungeKutta::new(dvector![tolerance], 3.0, 10_000).follow(field, dvector![0.0], 2.0).unwrap();
        // A step over a kink has an error proportional to its length: several tolerances, not one.
        assert!((end[0] - 0.5).abs() < 20.0 * tolerance, "{end}");
    }

    #[test]
    fn integration_stops_at_non_finite_velocities() {
        let field = |x: &DVector<f64>, _: f64| Ok::<_, Infallible>(dvector![if x[0] < 0.5 { 1.0 } else { f64::NAN }]);
        let follow = |start: f64| RungeKutta::new(dvector![1e-4], 2.0, 10_000).follow(field, dvector![start], 2.0);
        let Err(Unfollowed::NotFinite { state, elapsed }) = follow(0.0) else { panic!("it stops at the edge") };
        assert!((state[0] - 0.5).abs() < 1e-3 && (elapsed - 0.5).abs() < 1e-3, "{state} {elapsed}");
        assert!(matches!(follow(1.0), Err(Unfollowed::NotFinite { elapsed: 0.0, .. })));
        // Trial steps that overflow are too long and are retried.
        let steep = |x: &DVector<f64>, _: f64| Ok::<_, Infallible>(x.map(|x| -x.sinh()));
        let end = RungeKutta::new(dvector![1e-4], 1.0, 10_000).follow(steep, dvector![10.0], 1.0).unwrap();
        let exact = 2.0 * (5.0_f64.tanh() * (-1.0_f64).exp()).atanh();
        assert!((end[0] - exact).abs() < 1e-3, "{end} {exact}");
    }

    #[test]
    fn steps_are_counted_over_all_ways() {
        let shaking = |_: &DVector<f64>, t: f64| Ok::<_, Infallible>(dvector![1e9 * (1e9 * t).cos()]);
        let mut method = RungeKutta::new(dvector![1e-4], 1e3, 1000);
        let halt = method.follow(shaking, dvector![0.0], 1e3).unwrap_err();
        let Unfollowed::Steps { limit: 1000, elapsed } = halt else { panic!("{halt:?}") };
        assert!(elapsed < 1e3);
        assert_eq!(method.follow(shaking, dvector![0.0], 1.0), Err(Unfollowed::Steps { limit: 1000, elapsed: 0.0 }));
    }
}
