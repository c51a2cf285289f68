//! Orthonormal polynomials on the times of a window, and their slopes.

/// Polynomials of degree 0, 1, … that are orthonormal on given times: Q and Q' in (S15).
#[derive(Debug, Clone)]
pub(crate) struct OrthonormalPolynomials {
    degrees: usize,
    /// Q_ik at `i * degrees + k`.
    values: Vec<f64>,
    /// Q'_ik, per unit of τ, likewise.
    slopes: Vec<f64>,
}

impl OrthonormalPolynomials {
    /// Polynomials on times τ in [−1, 1], by two passes of modified Gram–Schmidt on 1, τ, τ², …; as many degrees as
    /// requested, but at most one per time.
    pub(crate) fn on(tau: &[f64], degrees: usize) -> Self {
        let degrees = degrees.min(tau.len());
        let (mut values, mut slopes) =
            (Vec::<Vec<f64>>::with_capacity(degrees), Vec::<Vec<f64>>::with_capacity(degrees));
        // τ^k and its slope k·τ^(k−1) for the current k.
        let (mut power, mut power_slope) = (vec![1.0; tau.len()], vec![0.0; tau.len()]);
        for k in 0..degrees {
            let (mut value, mut slope) = (power.clone(), power_slope.clone());
            for _ in 0..2 {
                for (earlier, earlier_slope) in values.iter().zip(&slopes) {
                    let along = dot(earlier, &value);
                    subtract(&mut value, along, earlier);
                    subtract(&mut slope, along, earlier_slope);
                }
            }
            let norm = dot(&value, &value).sqrt();
            value.iter_mut().chain(&mut slope).for_each(|entry| *entry /= norm);
            values.push(value);
            slopes.push(slope);
            for ((power, slope), t) in power.iter_mut().zip(&mut power_slope).zip(tau) {
                *slope = (k + 1) as f64 * *power;
                *power *= t;
            }
        }
        OrthonormalPolynomials { degrees, values: by_sample(&values, tau.len()), slopes: by_sample(&slopes, tau.len()) }
    }

    /// Polynomials on ascending times in seconds, scaled by half their span about its middle.
    pub(crate) fn at(times: &[f64], degrees: usize) -> Self {
        let (begin, end) = (times[0], times[times.len() - 1]);
        let (middle, half) = (f64::midpoint(begin, end), (end - begin) / 2.0);
        let tau: Vec<f64> = times.iter().map(|t| (t - middle) / half).collect();
        Self::on(&tau, degrees)
    }

    /// Polynomials on `samples` evenly spaced times.
    pub(crate) fn even(samples: usize, degrees: usize) -> Self {
        let last = samples as f64 - 1.0;
        let tau: Vec<f64> = (0..samples).map(|i| (2.0 * i as f64 - last) / last).collect();
        Self::on(&tau, degrees)
    }

    /// Q at sample i, one entry per degree.
    pub(crate) fn values(&self, i: usize) -> &[f64] {
        &self.values[i * self.degrees..][..self.degrees]
    }

    /// Q' at sample i, one entry per degree, per unit of τ.
    pub(crate) fn slopes(&self, i: usize) -> &[f64] {
        &self.slopes[i * self.degrees..][..self.degrees]
    }

    /// c_kj = Σ_i Q_ik y_ij, at `k * dim + j`; `rows` holds y_ij at `i * dim + j` for the window's samples.
    pub(crate) fn project(&self, rows: &[f64], dim: usize, coefficients: &mut Vec<f64>) {
        coefficients.clear();
        coefficients.resize(self.degrees * dim, 0.0);
        for (values, y) in self.values.chunks_exact(self.degrees).zip(rows.chunks_exact(dim)) {
            for (value, sums) in values.iter().zip(coefficients.chunks_exact_mut(dim)) {
                for (sum, y) in sums.iter_mut().zip(y) {
                    *sum += value * y;
                }
            }
        }
    }
}

/// Transposes columns, one per degree, to one row per sample.
fn by_sample(columns: &[Vec<f64>], samples: usize) -> Vec<f64> {
    (0..samples).flat_map(|i| columns.iter().map(move |column| column[i])).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn subtract(from: &mut [f64], factor: f64, what: &[f64]) {
    for (from, what) in from.iter_mut().zip(what) {
        *from -= factor * what;
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    fn times() -> impl Strategy<Value = Vec<f64>> {
        vec(0.1..2.0f64, 1..30).prop_map(|gaps| {
            let total: f64 = gaps.iter().sum();
            let mut at = -1.0;
            let mut times = vec![-1.0];
            for gap in gaps {
                at += 2.0 * gap / total;
                times.push(at);
            }
            times
        })
    }

    proptest! {
        #[test]
        fn columns_are_orthonormal(tau in times(), degrees in 1..7usize) {
            let q = OrthonormalPolynomials::on(&tau, degrees);
            for k in 0..q.degrees {
                for l in 0..=k {
                    let product: f64 = (0..tau.len()).map(|i| q.values(i)[k] * q.values(i)[l]).sum();
                    prop_assert!((product - f64::from(u8::from(k == l))).abs() < 1e-13, "{k} {l}: {product}");
                }
            }
        }

        /// A polynomial of the highest degree and its slope are reproduced.
        #[test]
        fn a_polynomial_and_its_slope_are_reproduced(tau in times(), factors in vec(-2.0..2.0f64, 1..7)) {
            let q = OrthonormalPolynomials::on(&tau, factors.len());
            prop_assume!(q.degrees == factors.len());
            let value = |t: f64| factors.iter().rev().fold(0.0, |sum, factor| sum * t + factor);
            let y: Vec<f64> = tau.iter().map(|&t| value(t)).collect();
            let mut coefficients = Vec::new();
            q.project(&y, 1, &mut coefficients);
            for (i, &t) in tau.iter().enumerate() {
                let slope: f64 = (1..factors.len()).map(|k| k as f64 * factors[k] * t.powi(i32::try_from(k).unwrap() - 1)).sum();
                prop_assert!((dot(q.values(i), &coefficients) - y[i]).abs() < 1e-11);
                prop_assert!((dot(q.slopes(i), &coefficients) - slope).abs() < 1e-8);
            }
        }
    }
}
