//! Fixes a model's context.

use nalgebra::DVector;
use thiserror::Error;

use crate::{ContextUse, Model, PrepareOptions, StateChannel};

/// Reasons why a context cannot be fixed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ContextError {
    /// The model has no such channel.
    #[error("the model's context has no '{name}'; it has {}", listed(.known))]
    Unknown {
        /// The given name.
        name: String,
        /// The names of the context's channels.
        known: Vec<String>,
    },
    /// A channel has no value.
    #[error("the context needs a number for each of {}", listed(.names))]
    Missing {
        /// All channels of the context.
        names: Vec<String>,
    },
    /// A value is NaN or infinite.
    #[error("{name} is {value}: a context has finite numbers")]
    NotFinite {
        /// The channel.
        name: String,
        /// Its value.
        value: f64,
    },
}

fn listed(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

impl Model {
    /// The model with a fixed context c, (p) in the order of [`Model::context`] and in the units of the recording. Its policy
    /// depends on the state alone and can be used wherever a model can.
    ///
    /// # Errors
    /// [`ContextError`].
    pub fn in_context(&self, context: &DVector<f64>) -> Result<Model, ContextError> {
        let names = self.context_names();
        if context.len() != names.len() {
            return Err(ContextError::Missing { names });
        }
        match names.into_iter().zip(context).find(|(_, value)| !value.is_finite()) {
            Some((name, &value)) => Err(ContextError::NotFinite { name, value }),
            None => Ok(Model { chosen_context: context.clone(), ..self.clone() }),
        }
    }

    /// As [`Model::in_context`], with the values by name.
    ///
    /// # Errors
    /// [`ContextError`].
    pub fn in_named_context(&self, values: &[(String, f64)]) -> Result<Model, ContextError> {
        let known = self.context_names();
        if let Some((name, _)) = values.iter().find(|(name, _)| !known.contains(name)) {
            return Err(ContextError::Unknown { name: name.clone(), known });
        }
        let value = |name: &String| values.iter().find(|(given, _)| given == name).map(|(_, value)| *value);
        let context: Option<Vec<f64>> = known.iter().map(value).collect();
        self.in_context(&DVector::from_vec(context.ok_or(ContextError::Missing { names: known })?))
    }

    /// The model in its fixed context, or else in the median context of its demonstrations.
    #[must_use]
    pub fn in_usual_context(&self) -> Model {
        if self.open_context().is_empty() {
            return self.clone();
        }
        let middle = self.context.iter().map(|channel| channel.median);
        Model { chosen_context: DVector::from_iterator(self.context.len(), middle), ..self.clone() }
    }

    /// Options that prepare recordings in the model's units and context, like those from which it was learnt.
    #[must_use]
    pub fn prepare_options(&self, base: &PrepareOptions) -> PrepareOptions {
        PrepareOptions { scale: self.scale(), context: self.context_use(), ..base.clone() }
    }

    /// Which channels are the context of other recordings.
    pub fn context_use(&self) -> ContextUse {
        ContextUse::of(&self.context)
    }

    /// Names of the context's channels, (p).
    pub fn context_names(&self) -> Vec<String> {
        StateChannel::names(&self.context)
    }

    /// The channels of the context unless it is fixed: [`Model::policy`] takes their values after those of the state.
    pub fn open_context(&self) -> &[StateChannel] {
        if self.chosen_context.is_empty() { &self.context } else { &[] }
    }

    /// The channels of all inputs of the learner's policy: the state, then the context.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = &StateChannel> {
        self.state.iter().chain(&self.context)
    }

    /// Their scales, (n + p).
    pub(crate) fn input_scales(&self) -> DVector<f64> {
        StateChannel::scales(self.inputs())
    }
}
