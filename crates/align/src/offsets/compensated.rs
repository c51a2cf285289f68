/// A compensated sum (Neumaier), which keeps what rounding drops, as if added in twice the
/// precision.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CompensatedSum {
    sum: f64,
    dropped: f64,
}

impl CompensatedSum {
    pub(crate) fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        let taken = sum - self.sum;
        self.dropped += (self.sum - (sum - taken)) + (term - taken);
        self.sum = sum;
    }

    /// Adds another sum with its compensation.
    pub(crate) fn add_sum(&mut self, other: Self) {
        self.add(other.sum);
        self.dropped += other.dropped;
    }

    /// The sum; infinite after an overflow.
    pub(crate) fn value(&self) -> f64 {
        if self.sum.is_finite() { self.sum + self.dropped } else { self.sum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compensated_sum_recovers_lost_digits() {
        let sum = |terms: &[f64]| {
            let mut sum = CompensatedSum::default();
            for &term in terms {
                sum.add(term);
            }
            sum.value()
        };
        assert_eq!(sum(&[1.0, 1e-20, -1.0]), 1e-20);
        assert_eq!(sum(&[1.0, 1e20, -1e20, -0.5]), 0.5);
        assert_eq!(sum(&[1.0, f64::MAX, f64::MAX, 1.0]), f64::INFINITY);
        let (mut one, mut other) = (CompensatedSum::default(), CompensatedSum::default());
        for (of_one, of_other) in [(1.0, 1e-18), (1e-20, -1.0)] {
            one.add(of_one);
            other.add(of_other);
        }
        one.add_sum(other);
        assert_eq!(one.value(), 1e-18 + 1e-20);
    }
}
