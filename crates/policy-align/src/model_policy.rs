use std::cell::RefCell;

use motion::{Certainty, LearntPolicy, Policy, Potential};
use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView, DVectorViewMut};

use crate::{Learnt, Model, StateChannel};

/// Least share of a Gaussian process's prior variance that the demonstrations must explain at a supported state.
const LEAST_KNOWN: f64 = 0.5;
/// Share of its range by which a channel may lie beyond the demonstrated range. A Gaussian process with a trend extrapolates it to
/// any distance, without support by demonstrations.
pub(crate) const BEYOND: f64 = 0.25;

/// A model's policy in the units of the recording: π(x) = S⁻¹ π'(S x). S multiplies every channel by its
/// [`scale`](crate::StateChannel::scale), and π' is the learnt policy.
///
/// Its state is that of the model, (n), in the fixed context. With an open context, the context follows the state, (n + p), and the
/// action along it is 0.
#[derive(Debug)]
pub struct ModelPolicy<'a> {
    learnt: &'a dyn LearntPolicy,
    inputs: Inputs,
    potential: Option<ModelPotential<'a>>,
    least_support: f64,
    bounds: Vec<[f64; 2]>,
}

/// A model's potential, φ(x) = φ'(S x) / s². Here s is the scale that all channels share, or 1 if they differ.
///
/// If they share one, the policy is −∇φ. If they differ, π = −S⁻²∇φ: still downhill, but not in the steepest direction, because
/// distances in the user's units are not those of the learner. φ is then in the learner's units.
#[derive(Debug)]
pub struct ModelPotential<'a> {
    learnt: &'a dyn LearntPolicy,
    inputs: Inputs,
    per_unit: f64,
}

/// Inputs of the learner's policy besides the state: the fixed context, (p) or empty, and the scales of all inputs, (n + p).
#[derive(Debug, Clone)]
struct Inputs {
    scale: DVector<f64>,
    context: DVector<f64>,
}

impl Model {
    /// The policy in the units of the recording and in the fixed context.
    pub fn policy(&self) -> ModelPolicy<'_> {
        let (learnt, per_unit) = (self.learnt.policy(), self.potential_factor());
        let scale = self.input_scales();
        let inputs = Inputs { scale, context: self.chosen_context.clone() };
        let potential = learnt.potential().map(|_| ModelPotential { learnt, inputs: inputs.clone(), per_unit });
        let least_support = match self.learnt {
            Learnt::PolicyAlign(_) => f64::MIN_POSITIVE,
            Learnt::Auto(_) | Learnt::Slope(_) | Learnt::Direct(_) => LEAST_KNOWN,
        };
        ModelPolicy { learnt, inputs, potential, least_support, bounds: self.bounds() }
    }

    /// Range of every channel in which the policy is supported: the demonstrated range, a quarter wider on either side. The state's
    /// channels come first, then the context's, (n + p).
    pub fn bounds(&self) -> Vec<[f64; 2]> {
        let bound = |channel: &StateChannel| {
            let beyond = BEYOND * (channel.high - channel.low);
            [channel.low - beyond, channel.high + beyond]
        };
        self.inputs().map(bound).collect()
    }
}

impl ModelPolicy<'_> {
    /// Whether a state (n) has sufficient [support](LearntPolicy::support) for acting. An LWPR policy must have a receptive field
    /// there; the demonstrations must explain half of a Gaussian process's prior variance; and no channel may be beyond
    /// [`Model::bounds`].
    pub fn is_supported(&self, state: DVectorView<'_, f64>) -> bool {
        self.supported(state.as_view(), self.least_support)[0]
    }

    /// Whether each of these states (n, N) is supported, by [`LearntPolicy::supported`].
    pub fn are_supported(&self, states: DMatrixView<'_, f64>) -> Vec<bool> {
        self.supported(states, self.least_support)
    }

    /// Whether no channel of a state (n) is beyond [`Model::bounds`].
    fn is_within(&self, state: DVectorView<'_, f64>) -> bool {
        let inputs = state.iter().chain(&self.inputs.context);
        self.bounds.iter().zip(inputs).all(|([low, high], x)| (low..=high).contains(&x))
    }

    /// The least support of a supported state.
    pub fn least_support(&self) -> f64 {
        self.least_support
    }
}

impl Policy for ModelPolicy<'_> {
    fn dim(&self) -> usize {
        self.inputs.dim()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        self.inputs.vector_into(state, action.as_view_mut(), |state, action| self.learnt.action_into(state, action));
        action.component_div_assign(&self.inputs.scale.rows(0, action.len()));
    }

    fn actions(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        self.inputs.unscaled(self.learnt.actions(self.inputs.scaled_columns(states).as_view()))
    }
}

impl LearntPolicy for ModelPolicy<'_> {
    fn potential(&self) -> Option<&dyn Potential> {
        self.potential.as_ref().map(|potential| potential as &dyn Potential)
    }

    /// The learnt policy's support; 0 beyond [`Model::bounds`].
    fn support(&self, state: DVectorView<'_, f64>) -> f64 {
        if self.is_within(state) { self.inputs.scaled(state, |state| self.learnt.support(state)) } else { 0.0 }
    }

    fn action_sd_into(&self, state: DVectorView<'_, f64>, mut deviation: DVectorViewMut<'_, f64>) -> bool {
        let of_learnt = |state: DVectorView<'_, f64>, deviation: DVectorViewMut<'_, f64>| {
            self.learnt.action_sd_into(state, deviation)
        };
        let known = self.inputs.vector_into(state, deviation.as_view_mut(), of_learnt);
        if known {
            deviation.component_div_assign(&self.inputs.scale.rows(0, deviation.len()));
        }
        known
    }

    fn certainty(&self, states: DMatrixView<'_, f64>) -> Certainty {
        let mut certainty = self.learnt.certainty(self.inputs.scaled_columns(states).as_view());
        for (support, state) in certainty.support.iter_mut().zip(states.column_iter()) {
            if !self.is_within(state) {
                *support = 0.0;
            }
        }
        certainty.deviations = certainty.deviations.map(|deviations| self.inputs.unscaled(deviations));
        certainty
    }

    fn supported(&self, states: DMatrixView<'_, f64>, least: f64) -> Vec<bool> {
        let within: Vec<bool> = states.column_iter().map(|state| self.is_within(state) || least <= 0.0).collect();
        let asked: Vec<usize> = (0..within.len()).filter(|&at| within[at]).collect();
        let mut found = self
            .learnt
            .supported(self.inputs.scaled_columns(states.select_columns(&asked).as_view()).as_view(), least)
            .into_iter();
        within.into_iter().map(|within| within && found.next().unwrap_or_default()).collect()
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
        self.inputs.dim()
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        self.per_unit * self.inputs.scaled(state, |state| self.beneath().value(state))
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        let of_learnt = |state: DVectorView<'_, f64>, gradient: DVectorViewMut<'_, f64>| {
            self.beneath().gradient_into(state, gradient);
        };
        self.inputs.vector_into(state, gradient.as_view_mut(), of_learnt);
        gradient.component_mul_assign(&self.inputs.scale.rows(0, gradient.len()));
        gradient *= self.per_unit;
    }
}

thread_local! {
    /// Buffers for S x and for the learner's result on state and context. Each thread has its own, which is allocated only once.
    static SCALED: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    static WHOLE: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

impl Inputs {
    /// Dimension of a state.
    fn dim(&self) -> usize {
        self.scale.len() - self.context.len()
    }

    /// Evaluates a function at S x.
    fn scaled<T>(&self, state: DVectorView<'_, f64>, evaluate: impl FnOnce(DVectorView<'_, f64>) -> T) -> T {
        assert_eq!(state.len(), self.dim(), "a state has as many dimensions as the policy");
        SCALED.with_borrow_mut(|place| {
            place.clear();
            place.extend(state.iter().chain(&self.context).zip(&self.scale).map(|(x, s)| x * s));
            evaluate(DVectorView::from_slice(place, self.scale.len()))
        })
    }

    /// S x with the fixed context, for each state (n, N): (n + p, N).
    fn scaled_columns(&self, states: DMatrixView<'_, f64>) -> DMatrix<f64> {
        let n = self.dim();
        assert_eq!(states.nrows(), n, "a state has as many dimensions as the policy");
        let input = |k: usize, at: usize| if k < n { states[(k, at)] } else { self.context[k - n] };
        DMatrix::from_fn(self.scale.len(), states.ncols(), |k, at| input(k, at) * self.scale[k])
    }

    /// The state components of vectors in the learner's units, (n + p, N), converted to those of the recording, (n, N).
    fn unscaled(&self, vectors: DMatrix<f64>) -> DMatrix<f64> {
        let mut vectors = vectors.resize_vertically(self.dim(), 0.0);
        for mut vector in vectors.column_iter_mut() {
            vector.component_div_assign(&self.scale.rows(0, self.dim()));
        }
        vectors
    }

    /// The state components of a vector evaluated at S x.
    fn vector_into<T>(
        &self,
        state: DVectorView<'_, f64>,
        mut vector: DVectorViewMut<'_, f64>,
        evaluate: impl FnOnce(DVectorView<'_, f64>, DVectorViewMut<'_, f64>) -> T,
    ) -> T {
        if self.context.is_empty() {
            return self.scaled(state, |state| evaluate(state, vector));
        }
        WHOLE.with_borrow_mut(|whole| {
            whole.clear();
            whole.resize(self.scale.len(), 0.0);
            let found =
                self.scaled(state, |state| evaluate(state, DVectorViewMut::from_slice(whole, self.scale.len())));
            vector.copy_from_slice(&whole[..vector.len()]);
            found
        })
    }
}
