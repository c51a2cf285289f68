use nalgebra::DVector;

/// Shortest step, as a share of the way: where a constraint takes hold a solution has an edge, which no step resolves.
const SHORTEST: f64 = 1e-6;

/// The method of Bogacki and Shampine: order 3, with an error of order 2 that chooses the step.
#[derive(Debug)]
pub(crate) struct RungeKutta {
    /// Largest error of a step in each dimension, (n).
    tolerance: DVector<f64>,
    /// The step to try next, in seconds.
    step: f64,
}

impl RungeKutta {
    pub(crate) fn new(tolerance: DVector<f64>) -> Self {
        RungeKutta { tolerance, step: f64::INFINITY }
    }

    /// Follows ẋ = `field`(x, t) from t = 0 for `duration` seconds.
    pub(crate) fn follow<E>(
        &mut self,
        field: impl Fn(&DVector<f64>, f64) -> Result<DVector<f64>, E>,
        mut x: DVector<f64>,
        duration: f64,
    ) -> Result<DVector<f64>, E> {
        let mut left = duration;
        let mut k1 = field(&x, 0.0)?;
        while left > 0.0 {
            let h = self.step.min(left).max((SHORTEST * duration).min(left));
            let time = duration - left;
            let k2 = field(&(&x + &k1 * (0.5 * h)), time + 0.5 * h)?;
            let k3 = field(&(&x + &k2 * (0.75 * h)), time + 0.75 * h)?;
            let next = &x + (&k1 * (2.0 / 9.0) + &k2 * (1.0 / 3.0) + &k3 * (4.0 / 9.0)) * h;
            let k4 = field(&next, time + h)?;
            let error = (&k1 * (-5.0 / 72.0) + &k2 * (1.0 / 12.0) + &k3 * (1.0 / 9.0) + &k4 * (-0.125)) * h;
            let error = error.component_div(&self.tolerance).amax();
            if error <= 1.0 || h <= SHORTEST * duration {
                left = if h >= left { 0.0 } else { left - h };
                (x, k1) = (next, k4);
            }
            self.step = h * (0.9 * error.cbrt().recip()).clamp(0.2, 5.0);
        }
        Ok(x)
    }
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
            let mut method = RungeKutta::new(DVector::repeat(2, tolerance));
            let end = method.follow(turn, dvector![1.0, 0.0], 2.0).unwrap();
            let error = (end - dvector![2.0_f64.cos(), 2.0_f64.sin()]).norm();
            assert!(error < 100.0 * tolerance && error > 0.0, "{error} {tolerance}");
        }
    }

    #[test]
    fn time_is_that_of_each_stage() {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let growing = |x: &DVector<f64>, t: f64| Ok::<_, Infallible>(x * t.cos());
            let end = RungeKutta::new(dvector![tolerance]).follow(growing, dvector![1.0], 3.0).unwrap();
            let error = (end[0] - 3.0_f64.sin().exp()).abs();
            assert!(error < 100.0 * tolerance, "{error} {tolerance}");
        }
    }

    #[test]
    fn an_edge_is_passed() {
        let field = |x: &DVector<f64>, _: f64| Ok::<_, Infallible>(dvector![if x[0] < 0.5 { 1.0 } else { 0.0 }]);
        let tolerance = 1e-4;
        let end = RungeKutta::new(dvector![tolerance]).follow(field, dvector![0.0], 2.0).unwrap();
        // A step over an edge is as wrong as it is long: some steps' tolerances, not one.
        assert!((end[0] - 0.5).abs() < 20.0 * tolerance, "{end}");
    }
}
