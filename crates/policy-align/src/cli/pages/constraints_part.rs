//! The estimated constraints on the trust page.

use std::collections::BTreeMap;

use maud::html;
use page::Part;
use policy_align::gp::{Acting, Hypothesis};
use policy_align::{ConstraintStretch, Model, Prepared, estimate_constraints};

use crate::cli::lines::short;
use crate::cli::pages::page_parts::{constraints, part};

/// Largest number of constraints in the list.
const LISTED: usize = 12;
/// Movements times the cube of the dimension; above this the search takes too long for a page.
const MOST: usize = 20_000;

/// The constraint, or its absence, on each stretch of the movements; `None` unless the data show constraints.
pub(crate) fn found(model: &Model, prepared: &Prepared) -> Option<Vec<ConstraintStretch>> {
    let effort = prepared.episodes.len() * model.state.len().pow(3);
    if model.trust.numbers.reading != Hypothesis::Constrained || effort > MOST {
        return None;
    }
    estimate_constraints(model, prepared, None).ok()
}

/// A table of the constraints, the most frequent first; `None` without constraints.
pub(crate) fn constraints_part(found: &[ConstraintStretch], model: &Model) -> Option<Part> {
    let mut alike: BTreeMap<String, Vec<&ConstraintStretch>> = BTreeMap::new();
    for stretch in found.iter().filter(|stretch| stretch.acting == Acting::Constraint) {
        alike.entry(stretch.in_words(&model.state)).or_default().push(stretch);
    }
    let seconds = |of: &[&ConstraintStretch]| of.iter().map(|of| of.seconds.1 - of.seconds.0).sum::<f64>();
    let mut alike: Vec<(String, Vec<&ConstraintStretch>)> = alike.into_iter().collect();
    alike.sort_by(|(_, a), (_, b)| b.len().cmp(&a.len()).then(seconds(b).total_cmp(&seconds(a))));
    let row = |(words, of): &(String, Vec<&ConstraintStretch>)| {
        let worst =
            of.iter().max_by(|a, b| a.angle.total_cmp(&b.angle)).map_or_else(String::new, |of| of.angle_in_words());
        [words.clone(), of.len().to_string(), short(seconds(of)), worst]
    };
    let rows: Vec<[String; 4]> = alike.iter().take(LISTED).map(row).collect();
    let more = alike.len().saturating_sub(LISTED);
    let others = found.len() - alike.iter().map(|(_, of)| of.len()).sum::<usize>();
    let body = html! {
        p { "What turned the movements aside from the learnt policy, while it stayed constant." }
        (constraints(&rows))
        p {
            @if more > 0 { "And " (more) " more: " code { "policy-align constraints" } " lists all. " }
            @if others > 0 { "In " (others) " other stretches no constraint is seen, or one that changes." }
        }
    };
    (!rows.is_empty()).then(|| part("constraints", "Constraints found", &body))
}
