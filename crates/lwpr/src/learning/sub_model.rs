//! The fields of one output, and how they learn from one sample.

use crate::Pruning;
use crate::field::Field;
use crate::learning::activation::{ActivatedField, Near};
use crate::learning::activation_table::ActivationTable;
use crate::learning::memory::Seen;
use crate::learning::rules::{LearnFromOne, Workspace};
use crate::settings::Settings;

/// The receptive fields of one output.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct SubModel {
    pub(crate) fields: Vec<Field>,
    pub(crate) table: ActivationTable,
    pub(crate) n_pruned: usize,
}

/// The fields that a sample activates, and the strongest of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Activated {
    near: Near,
    pub(crate) strongest: Strongest,
}

/// The strongest and second strongest activation of a sample, and whose they are.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Strongest {
    pub(crate) first: f64,
    pub(crate) second: f64,
    pub(crate) first_field: usize,
    pub(crate) second_field: usize,
}

impl Strongest {
    /// With another field; of equal ones the earlier counts as stronger. Values are chosen, not branches, since which field
    /// is the strongest cannot be predicted.
    #[inline(always)]
    fn with(self, field: usize, w: f64) -> Self {
        let stronger = w > self.first;
        let ((first, first_field), (next, next_field)) = if stronger {
            ((w, field), (self.first, self.first_field))
        } else {
            ((self.first, self.first_field), (w, field))
        };
        let follows = stronger || next > self.second;
        let (second, second_field) = if follows { (next, next_field) } else { (self.second, self.second_field) };
        Strongest { first, second, first_field, second_field }
    }

    /// Takes note of another field where they come in any order, and of equal ones the first in the list counts; only the strongest is kept.
    #[inline(always)]
    pub(crate) fn see_unordered(&mut self, field: usize, w: f64) {
        if w > self.first || (w >= self.first && field < self.first_field) {
            (self.first, self.first_field) = (w, field);
        }
    }

    /// Whether the sample needs a field of its own.
    #[inline(always)]
    pub(crate) fn asks_for_field(&self, settings: &Settings) -> bool {
        self.first <= settings.params.w_gen
    }
}

impl SubModel {
    /// Finds the fields that the normalised sample `x` activates, some of which may have been `seen`, and how strongly.
    #[inline(always)]
    pub(crate) fn activate<S: pulp::Simd>(
        &self,
        simd: S,
        settings: &Settings,
        x: &[f64],
        workspace: &mut Workspace,
        (squared_radius, seen): (&mut Activated, Option<&mut Seen>),
    ) {
        let (fields, sample) = ((&self.fields[..], &self.table), (x, settings.squared_radius));
        squared_radius.near.find(simd, settings, fields, sample, &mut workspace.rows, seen);
        let fields = squared_radius.near.iter();
        squared_radius.strongest = fields
            .fold(Strongest::default(), |strongest, ActivatedField { field, activation, .. }| {
                strongest.with(field, activation.w)
            });
    }

    /// One step of learning from the normalised sample (x, y): 1.4 of the algorithm for one output.
    #[inline(always)]
    pub(crate) fn learn<S: pulp::Simd>(
        &mut self,
        simd: S,
        settings: &Settings,
        x: &[f64],
        y: f64,
        workspace: &mut Workspace,
        squared_radius: &Activated,
    ) {
        let near = &squared_radius.near;
        LearnFromOne { settings, fields: &mut self.fields, near, x, y, workspace }.run(simd);
        for ActivatedField { field, .. } in near.iter() {
            self.table.set_metric(settings, field, &self.fields[field]);
        }
        let strongest = squared_radius.strongest;
        if strongest.asks_for_field(settings) {
            self.create(settings, x, y, strongest);
        } else if strongest.second > settings.params.w_prune {
            self.prune(settings, strongest);
        }
    }

    fn create(&mut self, settings: &Settings, x: &[f64], y: f64, strongest: Strongest) {
        let template = self.fields.get(strongest.first_field).filter(|field| is_template(settings, strongest, field));
        let field = Field::new(settings, x, y, template);
        self.table.set(settings, self.fields.len(), &field);
        self.fields.push(field);
    }

    fn prune(&mut self, settings: &Settings, strongest: Strongest) {
        let Strongest { first_field, second_field, .. } = strongest;
        let trace = |k: usize| self.fields[k].trace(settings);
        let first_is_wider = trace(first_field) < trace(second_field);
        let gone = match settings.params.pruning {
            Pruning::Wider if first_is_wider => first_field,
            Pruning::Wider => second_field,
            Pruning::Narrower if first_is_wider => second_field,
            Pruning::Narrower => first_field,
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
    strongest.first > 0.1 * settings.params.w_gen && field.is_trustworthy()
}
