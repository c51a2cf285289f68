use std::cell::RefCell;

use motion::{LearntPolicy, Policy, Potential};
use nalgebra::{DVector, DVectorView, DVectorViewMut};

use crate::{Learnt, Model, StateChannel};

/// Share of the prior variance of a Gaussian process that the demonstrations must have taken away where it is used.
const LEAST_KNOWN: f64 = 0.5;
/// Share of its range by which a channel may lie beyond the demonstrated range. A Gaussian process with a trend follows it
/// at any distance, where no demonstration supports it.
pub(crate) const BEYOND: f64 = 0.25;

/// A model's policy in the units of the recording: π(x) = S⁻¹ π'(S x), where S multiplies every channel by its
/// [`scale`](crate::StateChannel::scale) and π' is the policy that was learnt.
#[derive(Debug)]
pub struct ModelPolicy<'a> {
    learnt: &'a dyn LearntPolicy,
    scale: DVector<f64>,
    potential: Option<ModelPotential<'a>>,
    least_support: f64,
    bounds: Vec<[f64; 2]>,
}

/// A model's potential, φ(x) = φ'(S x) / s², where s is the scale that all channels share, and 1 if they differ.
///
/// Where they share one, the policy is −∇φ. Where they differ, π = −S⁻²∇φ: still downhill, but no longer straight down,
/// because distances in the user's units are not those that were learnt with. φ is then in the learner's units.
#[derive(Debug)]
pub struct ModelPotential<'a> {
    learnt: &'a dyn LearntPolicy,
    scale: DVector<f64>,
    per_unit: f64,
}

impl Model {
    /// The policy, in the units of the recording.
    pub fn policy(&self) -> ModelPolicy<'_> {
        let learnt = self.learnt.policy();
        let (scale, per_unit) = (self.scales(), self.potential_factor());
        let potential = learnt.potential().map(|_| ModelPotential { learnt, scale: scale.clone(), per_unit });
        let least_support = match self.learnt {
            Learnt::PolicyAlign(_) => f64::MIN_POSITIVE,
            Learnt::Auto(_) | Learnt::Slope(_) | Learnt::Direct(_) => LEAST_KNOWN,
        };
        ModelPolicy { learnt, scale, potential, least_support, bounds: self.bounds() }
    }

    /// Range of every channel that counts as known: the demonstrated range, a quarter wider on either side, (n).
    pub fn bounds(&self) -> Vec<[f64; 2]> {
        let bound = |channel: &StateChannel| {
            let beyond = BEYOND * (channel.high - channel.low);
            [channel.low - beyond, channel.high + beyond]
        };
        self.state.iter().map(bound).collect()
    }
}

impl ModelPolicy<'_> {
    /// Whether a state (n) has the [support](LearntPolicy::support) that acting on it needs: an LWPR policy has a
    /// receptive field there, a Gaussian process has lost half of its prior variance; and no channel is beyond
    /// [`Model::bounds`].
    pub fn is_supported(&self, state: DVectorView<'_, f64>) -> bool {
        self.support(state) >= self.least_support
    }

    /// The smallest support of a known state.
    pub fn least_support(&self) -> f64 {
        self.least_support
    }
}

impl Policy for ModelPolicy<'_> {
    fn dim(&self) -> usize {
        self.scale.len()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        scaled(state, &self.scale, |state| self.learnt.action_into(state, action.as_view_mut()));
        action.component_div_assign(&self.scale);
    }
}

impl LearntPolicy for ModelPolicy<'_> {
    fn potential(&self) -> Option<&dyn Potential> {
        self.potential.as_ref().map(|potential| potential as &dyn Potential)
    }

    /// As of the policy that was learnt; 0 beyond [`Model::bounds`].
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        let within = self.bounds.iter().zip(&state).all(|([low, high], x)| (low..=high).contains(&x));
        if within { scaled(state, &self.scale, |state| self.learnt.support(state)) } else { 0.0 }
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, mut deviation: DVectorViewMut<'_, f64>) -> bool {
        let known = scaled(state, &self.scale, |state| self.learnt.action_sd_into(state, deviation.as_view_mut()));
        if known {
            deviation.component_div_assign(&self.scale);
        }
        known
    }

    fn kept(&self) -> Option<&[usize]> {
        self.learnt.kept()
    }

    fn warnings(&self) -> Vec<String> {
        self.learnt.warnings()
    }
}

impl ModelPotential<'_> {
    fn beneath(&self) -> &dyn Potential {
        self.learnt.potential().expect("made only of a policy that has one")
    }
}

impl Potential for ModelPotential<'_> {
    fn dim(&self) -> usize {
        self.scale.len()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        self.per_unit * scaled(state, &self.scale, |state| self.beneath().value(state))
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        scaled(state, &self.scale, |state| self.beneath().gradient_into(state, gradient.as_view_mut()));
        gradient.component_mul_assign(&self.scale);
        gradient *= self.per_unit;
    }
}

thread_local! {
    /// S x. Each thread has one, so that none allocates more than once.
    static SCALED: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// Evaluates at S x.
fn scaled<T>(state: DVectorView<'_, f64>, scale: &DVector<f64>, evaluate: impl FnOnce(DVectorView<'_, f64>) -> T) -> T {
    assert_eq!(state.len(), scale.len(), "a state has as many dimensions as the policy");
    SCALED.with_borrow_mut(|place| {
        place.clear();
        place.extend(state.iter().zip(scale).map(|(x, s)| x * s));
        evaluate(DVectorView::from_slice(place, scale.len()))
    })
}
