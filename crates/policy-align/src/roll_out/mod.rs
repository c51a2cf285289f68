//! A learnt policy followed from a start, under constraints that need not have been in the data.

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

use crate::{Model, ModelPolicy};
use constraint_set::{Fault, Watch};
use error::LONGEST;
use holding::Holding;
use runge_kutta::{RungeKutta, Unfollowed};

/// Error of a step, in spreads of the channels.
const TOLERANCE: f64 = 1e-4;
/// And at most this share of the least ball's radius …
const OF_RADIUS: f64 = 5e-4;
/// … but at least this share of the spreads: a ball of next to no radius does not make every step tiny.
const FINEST: f64 = 1e-7;
/// Steps of integration, with those tried in vain: so many, or so many for each sample and each change of constraints if
/// that is more.
const STEPS: usize = 200_000;
const STEPS_EACH: usize = 10;
/// At rest is what is slower than this share of the demonstrated median …
const AT_REST: f64 = 0.01;
/// … at all samples within so many of the model's time steps, whatever the step of the roll-out: at ten samples of the usual step.
const RESTING: f64 = 8.5;
/// Duration without another, in durations of the longest episode.
const TIMES_AS_LONG: f64 = 3.0;

/// Integrates a policy under constraints, u = N(x, t) π(x) (3), with adaptive steps.
#[derive(Debug, Clone, Default)]
pub struct RollOut {
    /// The constraints and their times.
    pub constraints: ConstraintSet,
    /// Limits at which to stop.
    pub limits: Option<JointLimits>,
    /// At most so long, in seconds; three times the longest episode if not given.
    pub seconds: Option<f64>,
    /// Between two samples of the result, in seconds; the model's time step if not given.
    pub step: Option<f64>,
}

/// The path of a roll-out.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Seconds from the start, (N).
    pub times: Vec<f64>,
    /// In the units of the recording, one column a sample, (n, N).
    pub states: DMatrix<f64>,
    /// The projected action, in units of the state per second, (n, N).
    pub velocities: DMatrix<f64>,
    /// Why it ended.
    pub stop: Stop,
    /// By how much a constraint was broken at most, in its unit, and which, counted from 1; none if there was none.
    pub broken_by: Option<(f64, usize)>,
}

/// Why a roll-out ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stop {
    /// Slower than 1 % of the demonstrated median speed for ten of the model's time steps, with no constraint left that may change.
    AtRest,
    /// The next state would have been outside the demonstrated region.
    LeftTheData,
    /// The next state would have been beyond the limit of this joint.
    Limit(String),
    /// The time was up.
    Time,
}

impl RollOut {
    /// Follows a model's policy from a start (n), in the units of the recording. The path ends with the last state that
    /// is supported and within limits.
    ///
    /// # Errors
    /// [`RollOutError`].
    pub fn follow(&self, model: &Model, start: &DVector<f64>) -> Result<Path, RollOutError> {
        let open = model.open_context();
        if !open.is_empty() {
            return Err(RollOutError::Context { names: open.iter().map(|channel| channel.name.clone()).collect() });
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
        // Since when it rests.
        let mut resting = None;
        let stop = loop {
            let (time, state) = (times[times.len() - 1], &states[states.len() - 1]);
            if time >= run.seconds {
                break Stop::Time;
            }
            // Multiples of the step, not sums of it: no rounding adds up.
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
            // A constraint that ends later may let it go on, and so may one that changes.
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

    /// Times within the roll-out at which constraints begin or end, ascending, each once.
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
    /// N(x, t) π(x), under the constraints that hold.
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

    /// From one time to another, piece by piece where constraints begin or end. Within a piece none does; its end is no
    /// part of it.
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

/// A share of every channel's spread, an idle channel having that of the widest, and of the least ball's radius.
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
