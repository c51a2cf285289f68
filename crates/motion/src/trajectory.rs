use std::sync::Arc;

use nalgebra::{DMatrix, DVector, DVectorView};

use crate::{Labels, MotionError, Series, Times, scaled};

/// One observed movement: states x₁..x_N, evenly spaced in time or each with a stamp, and the velocities u₁..u_N if they were
/// recorded.
///
/// The values are checked: at least two samples, at least one dimension, finite numbers, ascending stamps. Clones share the numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    states: Arc<DMatrix<f64>>,
    velocities: Option<Arc<DMatrix<f64>>>,
    times: Arc<Times>,
    context: DVector<f64>,
    labels: Option<Labels>,
}

impl Trajectory {
    /// A movement without recorded velocities: `states` (n, N), one column a sample, `time_step` seconds
    /// apart.
    ///
    /// # Errors
    /// [`MotionError::TimeStep`], [`MotionError::NoDimension`], [`MotionError::TooShort`] or
    /// [`MotionError::NotFinite`].
    pub fn new(states: DMatrix<f64>, time_step: f64) -> Result<Self, MotionError> {
        if !(time_step.is_finite() && time_step > 0.0) {
            return Err(MotionError::TimeStep { time_step });
        }
        if states.nrows() == 0 {
            return Err(MotionError::NoDimension);
        }
        if states.ncols() < 2 {
            return Err(MotionError::TooShort { samples: states.ncols() });
        }
        require_finite(&states, Series::States)?;
        let times = Arc::new(Times::Even { step: time_step, len: states.ncols() });
        let states = Arc::new(states);
        Ok(Trajectory { states, velocities: None, times, context: DVector::zeros(0), labels: None })
    }

    /// A movement through `states` (n, N), one column a sample, at `times` (N) in seconds, strictly ascending.
    ///
    /// # Errors
    /// As [`Trajectory::new`] and [`Trajectory::with_times`].
    pub fn stamped(times: Vec<f64>, states: DMatrix<f64>) -> Result<Self, MotionError> {
        // If the stamps are far from 0, the difference of two has lost digits.
        let step = match times[..] {
            [first, second, ..] if are_even(&times, second - first) => second - first,
            [first, .., last] => (last - first) / (times.len() - 1) as f64,
            _ => 1.0,
        };
        // An invalid step results from stamps that do not ascend, which `with_times` reports.
        let step = if step.is_finite() && step > 0.0 { step } else { 1.0 };
        Trajectory::new(states, step)?.with_times(times)
    }

    /// The same movement with its recorded velocities or commands (n, N), in units of the state per second.
    ///
    /// # Errors
    /// [`MotionError::VelocityShape`] or [`MotionError::NotFinite`].
    pub fn with_velocities(self, velocities: DMatrix<f64>) -> Result<Self, MotionError> {
        if velocities.shape() != self.states.shape() {
            return Err(MotionError::VelocityShape { states: self.states.shape(), velocities: velocities.shape() });
        }
        require_finite(&velocities, Series::Velocities)?;
        Ok(Trajectory { velocities: Some(Arc::new(velocities)), ..self })
    }

    /// The same movement with its context c, (p): quantities besides the state that influenced it and were constant, such as a goal,
    /// the position of an object, or a load.
    ///
    /// # Errors
    /// [`MotionError::ContextNotFinite`].
    pub fn with_context(self, context: DVector<f64>) -> Result<Self, MotionError> {
        match context.iter().position(|value| !value.is_finite()) {
            None => Ok(Trajectory { context, ..self }),
            Some(number) => Err(MotionError::ContextNotFinite { number, value: context[number] }),
        }
    }

    /// The same movement with the names of its constraints, which show where constraints switch; `None` if unknown.
    #[must_use]
    pub fn with_labels(self, labels: Option<Labels>) -> Self {
        Trajectory { labels, ..self }
    }

    /// The same movement with every dimension of the state multiplied by its factor, (n).
    ///
    /// # Errors
    /// [`MotionError::NotFinite`] if a product is not.
    ///
    /// # Panics
    /// If the number of factors differs from the dimension.
    pub fn scaled(&self, factors: &DVector<f64>) -> Result<Self, MotionError> {
        let anew = self.with_states(scaled(&self.states, factors))?;
        match &self.velocities {
            Some(velocities) => anew.with_velocities(scaled(velocities, factors)),
            None => Ok(anew),
        }
    }

    /// A movement through other states, (n, N), at the same times, in the same context and under the same constraints, without
    /// velocities.
    ///
    /// # Errors
    /// As [`Trajectory::new`] and [`Trajectory::with_times`].
    pub fn with_states(&self, states: DMatrix<f64>) -> Result<Self, MotionError> {
        let anew = Trajectory::new(states, self.time_step())?.with_context(self.context.clone())?;
        let anew = anew.with_labels(self.labels.clone());
        match self.times() {
            Some(times) => anew.with_times(times.to_vec()),
            None => Ok(anew),
        }
    }

    /// The same movement with a time stamp for every sample, (N), in seconds, strictly ascending. Stamps that are even up to
    /// rounding leave the movement unchanged.
    ///
    /// # Errors
    /// [`MotionError::StampCount`] or [`MotionError::StampOrder`].
    pub fn with_times(self, times: Vec<f64>) -> Result<Self, MotionError> {
        if times.len() != self.n_samples() {
            return Err(MotionError::StampCount { times: times.len(), samples: self.n_samples() });
        }
        let in_order = |sample: usize| times[sample].is_finite() && (sample == 0 || times[sample - 1] < times[sample]);
        if let Some(sample) = (0..times.len()).find(|&sample| !in_order(sample)) {
            return Err(MotionError::StampOrder { sample, time: times[sample] });
        }
        let step = self.time_step();
        let times = if are_even(&times, step) { Times::Even { step, len: times.len() } } else { Times::Stamped(times) };
        Ok(Trajectory { times: Arc::new(times), ..self })
    }

    /// The states, (n, N).
    pub fn states(&self) -> &DMatrix<f64> {
        &self.states
    }

    /// The recorded velocities, (n, N), in units of the state per second.
    pub fn velocities(&self) -> Option<&DMatrix<f64>> {
        self.velocities.as_deref()
    }

    /// States and velocities, (n, N) each; they are copied only if a clone of the movement shares them.
    pub fn into_matrices(self) -> (DMatrix<f64>, Option<DMatrix<f64>>) {
        (Arc::unwrap_or_clone(self.states), self.velocities.map(Arc::unwrap_or_clone))
    }

    /// The context c, (p); of length 0 without one.
    pub fn context(&self) -> &DVector<f64> {
        &self.context
    }

    /// Names of the constraints on the movement, if known.
    pub fn labels(&self) -> Option<&Labels> {
        self.labels.as_ref()
    }

    /// Velocities of the steps, (x_{i+1} − x_i) / δt_i, (n, N − 1), in units of the state per second.
    pub fn step_velocities(&self) -> DMatrix<f64> {
        let steps = self.n_samples() - 1;
        let mut velocities = self.states.columns(1, steps) - self.states.columns(0, steps);
        for (sample, mut velocity) in velocities.column_iter_mut().enumerate() {
            velocity /= self.seconds(sample, sample + 1);
        }
        velocities
    }

    /// Seconds between two samples; the median if they are unevenly spaced, in O(N).
    pub fn time_step(&self) -> f64 {
        self.times.median_step().expect("a movement has two samples")
    }

    /// Time stamps of the samples, (N), in seconds; `None` if they are evenly spaced.
    pub fn times(&self) -> Option<&[f64]> {
        self.times.uneven()
    }

    /// Seconds from sample `from` to sample `to`, which must not be before it.
    pub fn seconds(&self, from: usize, to: usize) -> f64 {
        self.times.seconds(from, to)
    }

    /// Seconds from the first to the last sample.
    pub fn duration(&self) -> f64 {
        self.times.duration()
    }

    /// State x_i, (n).
    pub fn state(&self, sample: usize) -> DVectorView<'_, f64> {
        self.states.column(sample)
    }

    /// State x_i with its context c, (n + p).
    pub fn state_in_context(&self, sample: usize) -> DVector<f64> {
        let both = self.state(sample);
        DVector::from_iterator(both.len() + self.context.len(), both.iter().chain(&self.context).copied())
    }

    /// Dimension n of the state.
    pub fn dim(&self) -> usize {
        self.states.nrows()
    }

    /// Number of samples N.
    pub fn n_samples(&self) -> usize {
        self.states.ncols()
    }
}

/// Whether stamps are one step apart, up to rounding.
fn are_even(times: &[f64], step: f64) -> bool {
    let rounding = 4.0 * f64::EPSILON * times[0].abs().max(times[times.len() - 1].abs());
    times.iter().enumerate().all(|(sample, time)| (time - times[0] - step * sample as f64).abs() <= rounding)
}

fn require_finite(values: &DMatrix<f64>, series: Series) -> Result<(), MotionError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(MotionError::NotFinite {
            series,
            sample: at / values.nrows(),
            dimension: at % values.nrows(),
            value: values[at],
        }),
    }
}
