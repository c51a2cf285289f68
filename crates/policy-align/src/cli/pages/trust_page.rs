//! The page that says how far to trust a policy.

use maud::{Markup, html};
use motion::{Demonstrations, LearntPolicy as _};
use nalgebra::DMatrix;
use page::{Card, Document, Part};
use policy_align::{Model, TrustNumbers, Verdict};
use text::plain;

use crate::cli::in_words::learner;
use crate::cli::lines::{counted, short};
use crate::cli::pages::page_parts::{
    NUMBERS, STYLE, channels, decisions, direction, found, left_out, part, row, table,
};
use crate::cli::pages::picture::Picture;
use crate::cli::trust_files::{DIGITS, NAMED};

/// The page of a model, with a picture of the demonstrations if they are given, in the units of the learner.
pub(crate) fn trust_page(model: &Model, name: &str, checksum: &str, shown: Option<&Demonstrations>) -> String {
    let title = format!("How far to trust {name}");
    let opening = Part { id: "verdict".to_owned(), title: "Verdict".to_owned(), body: opening(model, &title) };
    let mut parts = Vec::new();
    if model.state.len() >= 2 {
        parts.push(part("field", FIELD, &field(model, shown)));
    }
    parts.push(part("numbers", "Numbers", &numbers(model)));
    parts.push(part("decisions", "Decisions", &decisions(&model.decisions)));
    parts.push(part("data", "Data", &data(model, checksum)));
    plain(&Document { title: &title, name, opening, parts, style: STYLE }.html()).into_owned()
}

const FIELD: &str = "The learnt policy";

fn opening(model: &Model, title: &str) -> Markup {
    let (class, words) = match model.trust.verdict {
        Verdict::Good => ("conclusion", "Good: all checks passed."),
        Verdict::Doubtful => ("conclusion doubtful", "Doubtful: read the findings before you use it."),
        Verdict::DoNotUse => ("conclusion wrong", "Do not use: the policy is wrong, or cannot be checked."),
    };
    html! {
        h1 #verdict { (title) }
        p class=(class) { (words) }
        @if !model.trust.findings.is_empty() {
            ul .findings { @for finding in &model.trust.findings { (found(finding)) } }
        }
        p { "Learnt by " (learner(model)) ", from " (counted(model.data.episodes, "episode")) " with "
            (counted(model.data.samples, "sample")) ". All checks work without the true policy. They cannot detect a \
             constraint that is the same in every demonstration." }
    }
}

fn field(model: &Model, shown: Option<&Demonstrations>) -> Markup {
    let movements = shown.map_or_else(Vec::new, |shown| {
        let unscaled = |states: &DMatrix<f64>| {
            DMatrix::from_fn(states.nrows(), states.ncols(), |k, i| states[(k, i)] / model.state[k].scale)
        };
        shown.trajectories().iter().map(|movement| unscaled(movement.states())).collect()
    });
    let plane = Picture::of(FIELD.to_owned(), model, [0, 1], movements, vec![]).plane();
    let svg = plot::Picture::rows(&[&[&plane]]).svg();
    let potential = if model.policy().potential().is_some() {
        " Thin lines join states of equal potential, with its value; the policy leads downhill."
    } else {
        ""
    };
    let rest = if model.state.len() > 2 { " All other channels are at their median." } else { "" };
    let caption = format!(
        "Arrows: the learnt policy. Blue: the demonstrations.{potential} Grey: outside the range of the demonstrations, or too \
         far from all of them to predict an action.{rest}"
    );
    Card { id: "field", title: FIELD, caption: &caption, remark: None, svg: &svg }.under(FIELD)
}

fn numbers(model: &Model) -> Markup {
    let numbers = &model.trust.numbers;
    let mut rows = vec![
        row(
            "Cross-validated error along the observed motion",
            &short(numbers.held_out_error),
            &below(TrustNumbers::GOOD_HELD_OUT_ERROR),
        ),
        row(
            "The same for the direct learner (plain averaging)",
            &short(numbers.held_out_error_direct),
            "for comparison",
        ),
        row(
            "Cross-validated error of the direct learner in all directions",
            &short(numbers.direct_error),
            "for comparison",
        ),
        row(
            "Error expected from the posterior variance",
            &short(numbers.expected_error),
            &below(TrustNumbers::GOOD_EXPECTED_ERROR),
        ),
        row("Difference between slope and direct policy", &short(numbers.gap), "large where constraints acted"),
    ];
    if let Some((_, error)) = numbers.episode_errors.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
        rows.push(row("Cross-validated error of the worst episode", &short(*error), "near that of all episodes"));
    }
    if let Some(halves) = numbers.halves {
        rows.push(row(
            "Difference between the policies learnt from either half of the episodes",
            &short(halves),
            &below(TrustNumbers::GOOD_HALVES),
        ));
    }
    rows.extend([
        row(
            "Squared errors divided by the variance that the policy predicts",
            &short(numbers.z_squared),
            "about 1, below 4",
        ),
        row(
            "Coverage of the least observed direction",
            &short(numbers.direction_coverage),
            "above 0.1; 1 if all directions are alike",
        ),
        row(
            "Rotation: share of the policy that no potential explains",
            &short(numbers.rotation_share),
            "0 for a potential",
        ),
        row("Share of rollouts that leave the demonstrated region", &short(numbers.leaving), "0"),
        row("Share of noise in the squared steps", &short(numbers.step_noise), "below 0.1"),
    ]);
    if let Some(aligned) = &numbers.aligned {
        rows.extend([
            row("Episodes aligned", &format!("{} of {}", aligned.kept, aligned.kept + aligned.discarded), "nearly all"),
            row("Disagreement of the aligned potentials", &short(aligned.residual), "below 0.1"),
            row("Share of held-out samples outside every receptive field", &short(aligned.unsupported), "below 0.05"),
            row("Difference from the Gaussian process", &short(aligned.difference), "below 0.1"),
        ]);
    }
    html! {
        p { "Errors are mean squared errors as a share of the mean squared action: 0 is exact, 1 is no better than standing still." }
        (table(&NUMBERS, &rows))
        p { "Least observed direction: motion along " (direction(&model.state, &numbers.unseen_direction))
            ". The policy is least certain along " (direction(&model.state, &numbers.least_known_direction)) "." }
    }
}

/// What verdicts ask for.
fn below(threshold: f64) -> String {
    format!("below {threshold}")
}

fn data(model: &Model, checksum: &str) -> Markup {
    let files: Vec<String> =
        model.data.files.iter().map(|file| format!("{}, SHA-256 {:.16}", file.name, file.sha256)).collect();
    html! {
        (channels(&model.state))
        (left_out(&model.data.left_out))
        p .where { "Files: "
        (files.join("; ")) ". " (model.made_by.program) ", " (model.made_by.time) ", seed " (model.seed) ". "
        (NAMED) (format!("{checksum:.DIGITS$}")) "." }
    }
}
