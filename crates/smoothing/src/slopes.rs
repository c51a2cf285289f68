//! Velocities as slopes of polynomials through a few samples.

use motion::Trajectory;
use nalgebra::DMatrix;

/// A neighbouring polynomial is free of a switch if its squared bend is below this share of that of the polynomial centred at the
/// sample. Its curvature errors are at most six times larger.
const JUMP: f64 = 0.01;

/// The slope at every sample, in positions per second, of the polynomial through the `points` samples nearest to it, at least two
/// and at most all of the movement; (n, N).
///
/// Exact for polynomials of a degree below that number, at any times. Nothing is smoothed. The time is O(N (p² + n p)) for p
/// points.
pub fn slopes(movement: &Trajectory, points: usize) -> DMatrix<f64> {
    InterpolatingPolynomials::new(movement, points).slopes(|nearest, _| nearest)
}

/// As [`slopes`], (n, N), in positions per second. If the velocity jumps among those samples, the polynomial passes through as
/// many samples before or after the jump instead.
pub fn slopes_between_switches(movement: &Trajectory, points: usize) -> DMatrix<f64> {
    let polynomials = InterpolatingPolynomials::new(movement, points);
    let (points, last) = (polynomials.points, movement.n_samples() - polynomials.points);
    // Squared highest divided difference of the samples from each on: large where the velocity jumps.
    let bends = polynomials.squared_bends();
    polynomials.slopes(|nearest, sample| {
        let beside = nearest.saturating_sub(points / 2)..=(nearest + points / 2).min(last);
        let beside = beside.filter(|first| (*first..*first + points).contains(&sample));
        let smooth = beside.min_by(|a, b| bends[*a].total_cmp(&bends[*b]));
        smooth.filter(|&first| bends[first] < JUMP * bends[nearest]).unwrap_or(nearest)
    })
}

/// Polynomials through `points` consecutive samples.
struct InterpolatingPolynomials<'a> {
    movement: &'a Trajectory,
    points: usize,
}

impl InterpolatingPolynomials<'_> {
    fn new(movement: &Trajectory, points: usize) -> InterpolatingPolynomials<'_> {
        InterpolatingPolynomials { movement, points: points.clamp(2, movement.n_samples()) }
    }

    /// x_i as n numbers.
    fn state(&self, sample: usize) -> &[f64] {
        let dim = self.movement.dim();
        &self.movement.states().as_slice()[sample * dim..(sample + 1) * dim]
    }

    /// Seconds from sample `first` to each of the samples.
    fn times(&self, first: usize, times: &mut [f64]) {
        for (k, time) in times.iter_mut().enumerate() {
            *time = self.movement.seconds(first, first + k);
        }
    }

    /// Squared bend of the polynomial through the samples from each on, measured by the highest divided difference.
    fn squared_bends(&self) -> Vec<f64> {
        let (mut times, mut weights) = (vec![0.0; self.points], vec![0.0; self.points]);
        let bend = |first: usize| {
            self.times(first, &mut times);
            for (k, weight) in weights.iter_mut().enumerate() {
                let apart = |j: usize| times[k] - times[j];
                *weight = (0..self.points).filter(|&j| j != k).map(apart).product::<f64>().recip();
            }
            let of_axis = |axis: usize| {
                let apart = |k: usize| (self.state(first + k)[axis] - self.state(first)[axis]) * weights[k];
                (1..self.points).map(apart).sum::<f64>()
            };
            (0..self.movement.dim()).map(of_axis).map(|bend| bend * bend).sum()
        };
        (0..=self.movement.n_samples() - self.points).map(bend).collect()
    }

    /// `choice` returns the first sample of the polynomial, given the first of the nearest samples and the sample itself.
    fn slopes(&self, choice: impl Fn(usize, usize) -> usize) -> DMatrix<f64> {
        let (dim, count) = (self.movement.dim(), self.movement.n_samples());
        let mut slopes = DMatrix::zeros(dim, count);
        let mut times = vec![0.0; self.points];
        for (sample, slope) in slopes.as_mut_slice().chunks_exact_mut(dim).enumerate() {
            let nearest = sample.saturating_sub(self.points / 2).min(count - self.points);
            let first = choice(nearest, sample);
            self.times(first, &mut times);
            let own = sample - first;
            let now = times[own];
            // Weights of the Lagrange polynomials, differentiated at one of their points.
            for k in (0..self.points).filter(|&k| k != own) {
                let others = times.iter().enumerate().filter(|&(j, _)| j != k && j != own);
                let share = |(_, time): (usize, &f64)| (now - time) / (times[k] - time);
                let weight = others.map(share).product::<f64>() / (times[k] - now);
                for ((slope, other), here) in slope.iter_mut().zip(self.state(first + k)).zip(self.state(sample)) {
                    *slope += (other - here) * weight;
                }
            }
        }
        slopes
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Times of samples with these steps.
    fn times(steps: &[f64]) -> Vec<f64> {
        (0..=steps.len()).map(|count| steps[..count].iter().sum()).collect()
    }

    proptest! {
        /// Where two cubic movements meet, slopes equal those of either one; elsewhere they are exact.
        #[test]
        fn slopes_about_a_switch_are_exact(
            before in prop::array::uniform3(-2.0..2.0f64),
            after in prop::array::uniform3(-2.0..2.0f64),
            jump in 0.1..2.0f64,
            steps in prop::collection::vec(0.05..0.3f64, 8..20),
            switch in 4usize..16,
        ) {
            let (times, switch) = (times(&steps), switch.min(steps.len() - 4));
            let after = [before[0] + jump, after[1], after[2]];
            let at = |sample: usize| {
                let (t, [a, b, c]) = (times[sample] - times[switch], if sample < switch { before } else { after });
                (a * t + b * t * t + c * t.powi(3), a + 2.0 * b * t + 3.0 * c * t * t)
            };
            let states = DMatrix::from_fn(2, times.len(), |axis, i| at(i).0 * (axis as f64 + 1.0));
            let movement = Trajectory::new(states, 1.0).and_then(|of| of.with_times(times.clone())).expect("a movement");
            for (sample, found) in slopes_between_switches(&movement, 5).column_iter().enumerate() {
                let near = |slope: f64| (found[0] - slope).abs() < 1e-7 && (found[1] - 2.0 * slope).abs() < 1e-7;
                let either = sample == switch && near(before[0]);
                prop_assert!(near(at(sample).1) || either, "{found} {} at {sample}, switch {switch}", at(sample).1);
            }
        }

        /// Slopes of polynomials are exact at any times through all points, and with fewer samples for lower degrees.
        #[test]
        fn slopes_of_polynomials_are_exact(
            coefficients in prop::array::uniform5(-2.0..2.0f64),
            steps in prop::collection::vec(0.05..0.3f64, 1..20),
            points in 2usize..6,
            switches in any::<bool>(),
        ) {
            let times = times(&steps);
            let degree = times.len().min(points) - 1;
            let value = |t: f64| (0..=degree).map(|k| coefficients[k] * t.powf(k as f64)).sum::<f64>();
            let slope = |t: f64| (1..=degree).map(|k| k as f64 * coefficients[k] * t.powf(k as f64 - 1.0)).sum::<f64>();
            let states = DMatrix::from_fn(2, times.len(), |axis, i| value(times[i]) * (axis as f64 + 1.0));
            let movement = Trajectory::new(states, 1.0).and_then(|of| of.with_times(times.clone())).expect("a movement");
            let found = if switches { slopes_between_switches(&movement, points) } else { slopes(&movement, points) };
            for (sample, found) in found.column_iter().enumerate() {
                for axis in 0..2 {
                    let expected = slope(times[sample]) * (axis as f64 + 1.0);
                    prop_assert!((found[axis] - expected).abs() < 1e-7 * (1.0 + expected.abs()), "{found} {expected}");
                }
            }
        }
    }
}
