//! The fields of one output, and their training with one sample.

use crate::Pruning;
use crate::field::Field;
use crate::learning::activation::{ActivatedField, ActivatedFields};
use crate::learning::activation_table::ActivationTable;
use crate::learning::memory::KnownDistances;
use crate::learning::rules::{LearnFromOne, Workspace};
use crate::settings::Settings;

/// The receptive fields of one output.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct SubModel {
    pub(crate) fields: Vec<Field>,
    pub(crate) table: ActivationTable,
    pub(crate) n_pruned: usize,
}

/// The strongest activation for a sample, and its field.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Strongest {
    pub(crate) w: f64,
    pub(crate) field: usize,
}

impl Strongest {
    /// The strongest of the fields near a sample, without the field `but`; the earlier one of equals. Needed for few samples
    /// only.
    fn among(activated: &ActivatedFields, but: Option<usize>) -> Self {
        let mut strongest = Strongest::default();
        for ActivatedField { field, activation, .. } in activated.iter() {
            if activation.w > strongest.w && Some(field) != but {
                strongest = Strongest { w: activation.w, field };
            }
        }
        strongest
    }

    /// Considers another field, for fields in arbitrary order; among equals, the first in the list counts. Uses conditional
    /// moves instead of branches, because which field is the strongest is unpredictable.
    #[inline(always)]
    pub(crate) fn see_unordered(&mut self, field: usize, w: f64) {
        let earlier = if w == self.w && field < self.field { field } else { self.field };
        (self.w, self.field) = if w > self.w { (w, field) } else { (self.w, earlier) };
    }

    /// Whether the sample needs a new field.
    #[inline(always)]
    pub(crate) fn asks_for_field(&self, settings: &Settings) -> bool {
        self.w <= settings.params.w_gen
    }
}

impl SubModel {
    /// Finds the fields that the normalised sample `x` activates, and their activations. Some distances may be `known`.
    #[inline(always)]
    pub(crate) fn activate<S: pulp::Simd>(
        &self,
        simd: S,
        settings: &Settings,
        x: &[f64],
        workspace: &mut Workspace,
        (activated, known): (&mut ActivatedFields, Option<&mut KnownDistances>),
    ) {
        let (fields, sample) = ((&self.fields[..], &self.table), (x, settings.squared_radius));
        activated.find(simd, settings, fields, sample, &mut workspace.rows, known);
    }

    /// One step of learning from the normalised sample (x, y): 1.4 of the algorithm for one output.
    #[inline(always)]
    pub(crate) fn learn<S: pulp::Simd>(
        &mut self,
        simd: S,
        settings: &Settings,
        (x, y): (&[f64], f64),
        workspace: &mut Workspace,
        activated: &ActivatedFields,
    ) {
        let table = settings.narrow().then_some(&mut self.table);
        LearnFromOne { settings, fields: &mut self.fields, table, activated, x, y, workspace }.run(simd);
        if activated.asks_for_field(settings) {
            self.create(settings, x, y, Strongest::among(activated, None));
        } else if settings.params.w_prune < 1.0 {
            let first = Strongest::among(activated, None).field;
            let second = Strongest::among(activated, Some(first));
            if second.w > settings.params.w_prune {
                self.prune(settings, (first, second.field));
            }
        }
    }

    fn create(&mut self, settings: &Settings, x: &[f64], y: f64, strongest: Strongest) {
        let template = self.fields.get(strongest.field).filter(|field| is_template(settings, strongest, field));
        let field = Field::new(settings, x, y, template);
        self.table.set(settings, self.fields.len(), &field);
        self.fields.push(field);
    }

    /// Removes one of the two strongest fields.
    fn prune(&mut self, settings: &Settings, (first, second): (usize, usize)) {
        let trace = |k: usize| self.fields[k].trace(settings);
        let first_is_wider = trace(first) < trace(second);
        let gone = match settings.params.pruning {
            Pruning::Wider if first_is_wider => first,
            Pruning::Wider => second,
            Pruning::Narrower if first_is_wider => second,
            Pruning::Narrower => first,
        };
        self.fields.swap_remove(gone);
        let last = self.fields.len();
        if gone < last {
            self.table.set(settings, gone, &self.fields[gone]);
        }
        self.table.pop(settings, last);
        self.n_pruned += 1;
    }
}

/// Whether a new field takes its shape from the strongest one.
pub(crate) fn is_template(settings: &Settings, strongest: Strongest, field: &Field) -> bool {
    strongest.w > 0.1 * settings.params.w_gen && field.is_trustworthy()
}
