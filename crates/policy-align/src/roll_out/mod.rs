//! Rolls out a learnt policy from a start, under constraints that need not have occurred in the data.

mod constraint_file;
mod constraint_part;
mod constraint_set;
mod error;
mod holding;
mod joint_limits;
pub(crate) mod link_point;
mod runge_kutta;
mod starts;

pub use constraint_file::ConstraintFileError;
pub use constraint_set::ConstraintSet;
pub use error::RollOutError;
pub use joint_limits::JointLimits;
pub use starts::spread_starts;

use std::collections::BTreeSet;

use motion::{LearntPolicy as _, Policy as _};
use nalgebra::{DMatrix, DVector};

use crate::{Model, ModelPolicy, StateChannel};
use constraint_set::{Fault, Watch};
use error::LONGEST;
use holding::Holding;
use runge_kutta::{RungeKutta, Unfollowed};

/// Largest error of a step, as a share of the channels' spreads.
const TOLERANCE: f64 = 1e-4;
/// It is also at most this share of the smallest ball's radius …
const OF_RADIUS: f64 = 5e-4;
/// … but at least this share of the spreads, so that a ball with a tiny radius does not make every step tiny.
const FINEST: f64 = 1e-7;
/// Largest number of integration steps, including rejected ones: the larger of a fixed number and a number per sample and per
/// change of constraints.
const STEPS: usize = 200_000;
const STEPS_EACH: usize = 10;
/// The state is at rest if it is slower than this share of the demonstrated median speed …
const AT_REST: f64 = 0.01;
/// … at all samples within this many of the model's time steps, whatever the step of the roll-out; these are ten samples with the
/// default step.
const RESTING: f64 = 8.5;
/// Default duration, in durations of the longest episode.
const TIMES_AS_LONG: f64 = 3.0;

/// Integrates a policy under constraints, u = N(x, t) π(x) (3), with adaptive steps.
#[derive(Debug, Clone, Default)]
pub struct RollOut {
    /// The constraints and their times.
    pub constraints: ConstraintSet,
    /// Joint limits that end the roll-out.
    pub limits: Option<JointLimits>,
    /// Largest duration in seconds; by default three times that of the longest episode.
    pub seconds: Option<f64>,
    /// Seconds between two samples of the result; by default the model's time step.
    pub step: Option<f64>,
}

/// The path of a roll-out.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Seconds from the start, (N).
    pub times: Vec<f64>,
    /// States in the units of the recording, one column per sample, (n, N).
    pub states: DMatrix<f64>,
    /// The projected action, in units of the state per second, (n, N).
    pub velocities: DMatrix<f64>,
    /// The reason for its end.
    pub stop: Stop,
    /// The largest violation of a constraint, in its unit, and the number of that constraint, counted from 1; `None` without a
    /// violation.
    pub broken_by: Option<(f64, usize)>,
}

/// Reasons for the end of a roll-out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stop {
    /// Slower than 1 % of the demonstrated median speed for ten of the model's time steps, and no remaining constraint can change.
    AtRest,
    /// The next state would have been outside the demonstrated region.
    LeftTheData,
    /// The next state would have been beyond the limit of this joint.
    Limit(String),
    /// The duration is over.
    Time,
}

impl RollOut {
    /// Follows a model's policy from a start (n), in the units of the recording. The path ends with the last supported state within
    /// limits.
    ///
    /// # Errors
    /// [`RollOutError`].
    pub fn follow(&self, model: &Model, start: &DVector<f64>) -> Result<Path, RollOutError> {
        let open = model.open_context();
        if !open.is_empty() {
            return Err(RollOutError::Context { names: StateChannel::names(open) });
        }
        let policy = model.policy();
        self.check_start(model, &policy, start)?;
        let step = positive("step", self.step.unwrap_or(model.time_step))?;
        let seconds = positive("seconds", self.seconds.unwrap_or(TIMES_AS_LONG * model.data.longest))?;
        let samples = (seconds / step).ceil();
        if samples > LONGEST as f64 {
            return Err(RollOutError::TooLong { samples });
        }
        let (constraints, switches) = (&self.constraints, self.switches(seconds));
        let run = Run { policy: &policy, constraints, scale: model.scales(), switches, seconds };
        let steps = STEPS.max(STEPS_EACH * (samples as usize + run.switches.len()));
        let tolerance = tolerance(model, self.constraints.least_radius());
        self.followed(&run, model, start, (step, RungeKutta::new(tolerance, model.data.longest, steps)))
    }

    fn followed(
        &self,
        run: &Run<'_>,
        model: &Model,
        start: &DVector<f64>,
        (step, mut method): (f64, RungeKutta),
    ) -> Result<Path, RollOutError> {
        let mut holding = Holding::new(&self.constraints.parts, |part, time| part.until <= time);
        let changes = self.constraints.changes();
        let mut watch = Watch::new(&self.constraints);
        let (mut times, mut states) = (vec![0.0], vec![start.clone()]);
        let mut velocities = vec![run.velocity(holding.at(0.0), start, 0.0)?];
        watch.update(start.as_view(), 0.0).map_err(fault(0.0))?;
        // Time since which the state has been at rest.
        let mut resting = None;
        let stop = loop {
            let (time, state) = (times[times.len() - 1], &states[states.len() - 1]);
            if time >= run.seconds {
                break Stop::Time;
            }
            // Multiples of the step instead of sums, so that rounding errors do not accumulate.
            let next_time = (times.len() as f64 * step).min(run.seconds);
            let next = run.advance(&mut method, &mut holding, state.clone(), (time, next_time))?;
            if !run.policy.is_supported(next.as_view()) {
                break Stop::LeftTheData;
            }
            if let Some(joint) = self.limits.as_ref().and_then(|limits| limits.beyond(next.as_view())) {
                break Stop::Limit(joint.to_owned());
            }
            let velocity = run.velocity(holding.at(next_time), &next, next_time)?;
            watch.update(next.as_view(), next_time).map_err(fault(next_time))?;
            let slow = velocity.component_mul(&run.scale).norm() < AT_REST * model.data.speed;
            resting = slow.then(|| resting.unwrap_or(next_time));
            times.push(next_time);
            states.push(next);
            velocities.push(velocity);
            // The state may move again when a constraint ends, or if a constraint changes.
            let stays = !changes && run.switches.last().is_none_or(|&last| last <= next_time);
            if resting.is_some_and(|since| next_time - since >= RESTING * model.time_step) && stays {
                break Stop::AtRest;
            }
        };
        Ok(Path {
            times,
            states: DMatrix::from_columns(&states),
            velocities: DMatrix::from_columns(&velocities),
            stop,
            broken_by: (!self.constraints.is_empty()).then_some((watch.broken_by, watch.worst)),
        })
    }

    fn check_start(&self, model: &Model, policy: &ModelPolicy<'_>, start: &DVector<f64>) -> Result<(), RollOutError> {
        let (found, expected) = (start.len(), model.state.len());
        if found != expected {
            return Err(RollOutError::Start { found, expected, names: model.channels() });
        }
        if let Some(at) = start.iter().position(|x| !x.is_finite()) {
            return Err(RollOutError::StartNotFinite { channel: model.state[at].name.clone() });
        }
        let of_context = model.context.iter().zip(&model.chosen_context).zip(model.bounds().into_iter().skip(expected));
        for ((channel, &value), range) in of_context {
            if !(range[0]..=range[1]).contains(&value) {
                return Err(RollOutError::ContextUnsupported { name: channel.name.clone(), value, range });
            }
        }
        if !policy.is_supported(start.as_view()) {
            let (support, least) = (policy.support(start.as_view()), policy.least_support());
            let ranges =
                model.state.iter().map(|channel| (channel.name.clone(), [channel.low, channel.high])).collect();
            return Err(RollOutError::Unsupported { support, least, ranges });
        }
        if let Some(joint) = self.limits.as_ref().and_then(|limits| limits.beyond(start.as_view())) {
            return Err(RollOutError::StartBeyondLimit { joint: joint.to_owned() });
        }
        let mut watch = Watch::new(&self.constraints);
        watch.update(start.as_view(), 0.0).map_err(fault(0.0))?;
        if watch.broken_by > 0.0 {
            return Err(RollOutError::StartBreaks { constraint: watch.worst, by: watch.broken_by });
        }
        Ok(())
    }

    /// Times within the roll-out at which constraints begin or end, ascending and unique.
    fn switches(&self, seconds: f64) -> Vec<f64> {
        let mut switches: Vec<f64> = self.constraints.switches().filter(|&t| t > 0.0 && t < seconds).collect();
        switches.sort_by(f64::total_cmp);
        switches.dedup();
        switches
    }
}

/// The constants of a roll-out.
struct Run<'a> {
    policy: &'a ModelPolicy<'a>,
    constraints: &'a ConstraintSet,
    scale: DVector<f64>,
    switches: Vec<f64>,
    seconds: f64,
}

impl Run<'_> {
    /// N(x, t) π(x), under the active constraints.
    fn velocity(
        &self,
        holding: &BTreeSet<usize>,
        state: &DVector<f64>,
        time: f64,
    ) -> Result<DVector<f64>, RollOutError> {
        let mut velocity = self.policy.action(state.as_view());
        self.constraints.leave(holding, (state.as_view(), time), &self.scale, &mut velocity).map_err(fault(time))?;
        Ok(velocity)
    }

    /// Advances from one time to another in intervals between the times at which constraints begin or end. The end of an interval
    /// is excluded.
    fn advance(
        &self,
        method: &mut RungeKutta,
        holding: &mut Holding<'_>,
        mut state: DVector<f64>,
        (from, to): (f64, f64),
    ) -> Result<DVector<f64>, RollOutError> {
        let [first, last] = [from.next_up(), to].map(|time| self.switches.partition_point(|&switch| switch < time));
        let mut begin = from;
        for &end in self.switches[first..last.max(first)].iter().chain([&to]) {
            let now = holding.at(begin);
            let at = |elapsed: f64| (begin + elapsed).min(end.next_down());
            let field = |state: &DVector<f64>, elapsed: f64| self.velocity(now, state, at(elapsed));
            state = method.follow(field, state, end - begin).map_err(|halt| match halt {
                Unfollowed::Field(error) => error,
                Unfollowed::NotFinite { state, elapsed } => {
                    RollOutError::NotFinite { state: state.as_slice().to_vec(), time: begin + elapsed }
                }
                Unfollowed::Steps { limit, elapsed } => {
                    RollOutError::TooManySteps { limit, time: begin + elapsed, seconds: self.seconds }
                }
            })?;
            begin = end;
        }
        Ok(state)
    }
}

/// A share of every channel's spread, limited by the smallest ball's radius. A constant channel has a small share of the largest
/// spread instead.
fn tolerance(model: &Model, least_radius: f64) -> DVector<f64> {
    let spread = |at: usize| model.state[at].high - model.state[at].low;
    let widest = (0..model.state.len()).map(|at| spread(at) * model.state[at].scale).fold(0.0, f64::max);
    DVector::from_fn(model.state.len(), |at, _| {
        let floor = 1e-3 * widest / model.state[at].scale;
        let spread = spread(at).max(floor).max(f64::MIN_POSITIVE);
        let rounding = 4.0 * f64::EPSILON * model.state[at].high.abs().max(model.state[at].low.abs());
        (TOLERANCE * spread).min((OF_RADIUS * least_radius).max(FINEST * spread)).max(rounding)
    })
}

fn positive(name: &'static str, value: f64) -> Result<f64, RollOutError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(RollOutError::NotPositive { name, value }) }
}

fn fault(time: f64) -> impl Fn(Fault) -> RollOutError {
    move |(constraint, reason)| RollOutError::Constraint { constraint, time, reason }
}
