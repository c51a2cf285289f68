//! The fields of one output, and how they learn from one sample.

use crate::activation::{ActivationTable, Reached};
use crate::field::{Field, Template};
use crate::kernel::Activation;
use crate::metric::{MetricScratch, update_metric};
use crate::regression::{grow_and_age, update_means, update_regression};
use crate::settings::{Settings, TRAINING_FLOOR};
use crate::{Metric, Pruning};

/// The receptive fields of one output.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct SubModel {
    pub(crate) fields: Vec<Field>,
    pub(crate) table: ActivationTable,
    pub(crate) n_pruned: usize,
}

/// Rows that an update works in; `rows` many of `width` numbers, one after the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Workspace {
    rows: Vec<f64>,
    mmt: Vec<f64>,
}

/// The fields in reach of a sample, in list order, and the strongest of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Reach {
    pub(crate) fields: Vec<Reached>,
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
    /// Takes note of another field; of equal ones the earlier counts as stronger.
    #[inline(always)]
    pub(crate) fn see(&mut self, field: usize, w: f64) {
        if w > self.first {
            (self.second, self.second_field) = (self.first, self.first_field);
            (self.first, self.first_field) = (w, field);
        } else if w > self.second {
            (self.second, self.second_field) = (w, field);
        }
    }

    /// Whether the sample needs a field of its own.
    #[inline(always)]
    pub(crate) fn asks_for_field(&self, settings: &Settings) -> bool {
        self.first <= settings.params.w_gen
    }
}

impl Workspace {
    pub(crate) fn new(settings: &Settings) -> Self {
        let mmt = if settings.params.metric == Metric::Full { settings.n_in * settings.width } else { 0 };
        Workspace { rows: vec![0.0; 5 * settings.width], mmt: vec![0.0; mmt] }
    }
}

impl SubModel {
    /// Finds the fields in reach of the normalised sample `x` and their activations.
    #[inline(always)]
    pub(crate) fn activate(
        &self,
        settings: &Settings,
        width: usize,
        x: &[f64],
        workspace: &mut Workspace,
        reach: &mut Reach,
    ) {
        let reached = &mut reach.fields;
        reached.clear();
        match settings.params.metric {
            Metric::Diagonal => self.table.reached(settings.n_in, x, settings.reach, reached),
            Metric::Full => {
                let (dx, t) = workspace.rows.split_at_mut(width);
                for (k, field) in self.fields.iter().enumerate() {
                    let q = field.full_distance(settings, width, x, dx, &mut t[..width]);
                    if q < settings.reach {
                        reached.push(Reached { field: k, q });
                    }
                }
            }
        }
        let mut strongest = Strongest::default();
        for reached in reached {
            strongest.see(reached.field, settings.params.kernel.at(reached.q).w);
        }
        reach.strongest = strongest;
    }

    /// One step of learning from the normalised sample (x, y): 1.4 of the algorithm for one output.
    #[inline(always)]
    pub(crate) fn learn(
        &mut self,
        settings: &Settings,
        width: usize,
        x: &[f64],
        y: f64,
        workspace: &mut Workspace,
        reach: &Reach,
    ) {
        let &Reach { ref fields, strongest } = reach;
        for &Reached { field: k, q } in fields {
            let activation = settings.params.kernel.at(q);
            if activation.w > TRAINING_FLOOR {
                train(&mut self.fields[k], settings, width, x, y, activation, workspace);
                self.table.set_metric(settings, k, &self.fields[k]);
            }
        }
        if strongest.asks_for_field(settings) {
            self.create(settings, x, y, strongest);
        } else if strongest.second > settings.params.w_prune {
            self.prune(settings, strongest);
        }
    }

    fn create(&mut self, settings: &Settings, x: &[f64], y: f64, strongest: Strongest) {
        let template = self.fields.get(strongest.first_field).filter(|field| is_template(settings, strongest, field));
        let field = Field::new(settings, x, y, template.map(Template));
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
    strongest.first > 0.1 * settings.params.w_gen && field.trustworthy
}

/// One field learns from a normalised sample that activates it.
#[inline(always)]
pub(crate) fn train(
    field: &mut Field,
    settings: &Settings,
    width: usize,
    x: &[f64],
    y: f64,
    activation: Activation,
    workspace: &mut Workspace,
) {
    let (dx, rest) = workspace.rows.split_at_mut(width);
    let (residual, rest) = rest.split_at_mut(width);
    let (fresh, rest) = rest.split_at_mut(width);
    let (t, md) = rest.split_at_mut(width);
    for i in 0..width {
        dx[i] = x[i] - field.rows[i];
    }
    let target = update_means(field, settings, width, x, y, activation.w, residual);
    let errors = update_regression(field, settings, width, target, activation.w, residual, fresh);
    let mut scratch = MetricScratch { t, md: &mut md[..width], mmt: &mut workspace.mmt };
    update_metric(field, settings, width, activation, errors, dx, &mut scratch);
    grow_and_age(field, settings);
}
