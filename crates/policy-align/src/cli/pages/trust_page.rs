//! The trust report: how far to trust a policy.

use maud::{Markup, html};
use motion::LearntPolicy as _;
use page::{Card, Part};
use policy_align::{AlignedNumbers, ConstraintStretch, Model, Prepared, Subject, TrustNumbers, direction_by_channels};

use crate::cli::describe::learner;
use crate::cli::lines::counted;
use crate::cli::pages::constraint_marks::{held, recorded};
use crate::cli::pages::constraints_part::{constraints_part, found};
use crate::cli::pages::error_map::error_map;
use crate::cli::pages::left_out_part::left_out_part;
use crate::cli::pages::numbers_table::{COVERAGE, Good, NOISE, numbers as table};
use crate::cli::pages::page_parts::{channels, decisions, left_out, opening, page, part};
use crate::cli::pages::pairs::pairs;
use crate::cli::pages::picture::Picture;
use crate::cli::trust_files::{DIGITS, NAMED};

const FIELD: &str = "The learnt policy";
/// Size of the picture, which fills half of the page, in pixels.
const SIZE: (f64, f64) = (540.0, 570.0);
const SENTENCES: [&str; 3] = [
    "Good: all checks passed.",
    "Doubtful: read the findings before you use it.",
    "Do not use: the policy is wrong, or cannot be checked.",
];

/// The page of a model, with a picture of the prepared demonstrations from which it was learnt.
pub(crate) fn trust_page(model: &Model, name: &str, checksum: &str, prepared: &Prepared) -> String {
    let title = format!("How far to trust {name}");
    let learnt = html! {
        "Learnt by " (learner(model)) ", from " (counted(model.data.episodes, "episode")) " with "
        (counted(model.data.samples, "sample")) (rows(model)) ". All checks work without the true policy. They may miss a \
         constraint that is the same in every demonstration."
    };
    let verdict = (model.trust.verdict, SENTENCES);
    let body = opening(("verdict", &title), verdict, &model.trust.findings, &learnt);
    let opening = Part { id: "verdict".to_owned(), title: "Verdict".to_owned(), body };
    let found = found(model, prepared).unwrap_or_default();
    let mut parts = Vec::new();
    if model.state.len() >= 2 {
        parts.push(part("field", FIELD, &field(model, prepared, &found)));
    }
    parts.push(part("numbers", "Numbers", &numbers(model)));
    parts.extend(error_map(model, prepared));
    parts.extend(left_out_part(model, prepared));
    parts.extend(pairs(model, prepared));
    parts.extend(constraints_part(&found, model));
    parts.push(part("decisions", "Decisions", &decisions(&model.decisions)));
    parts.push(part("data", "Data", &data(model, checksum)));
    page(&title, name, opening, parts)
}

/// The number of rows made from the samples, if they were thinned or averaged.
fn rows(model: &Model) -> String {
    let rows = model.decisions.iter().find(|decision| decision.what == Subject::Rows);
    rows.map_or(String::new(), |rows| format!(" ({} rows: {})", rows.value, rows.why))
}

fn field(model: &Model, prepared: &Prepared, found: &[ConstraintStretch]) -> Markup {
    let model = &model.in_usual_context();
    let held = held(found, prepared);
    let constraints = if held.is_empty() {
        ""
    } else {
        " Purple: where constraints found below cut this plane, in the middle of the stretch of time on which they acted, and their \
         normals; dashed where they move."
    };
    let (title, demonstrated) = (FIELD.to_owned(), recorded(prepared));
    let picture = Picture { title, model, dims: [0, 1], demonstrated, held, followed: vec![] };
    let plane = plot::Plane { size: SIZE, ..picture.plane() };
    let svg = plot::Picture::rows(&[&[&plane]]).svg();
    let potential = if model.policy().potential().is_some() {
        " Thin lines join states of equal potential, with its value; the policy leads downhill."
    } else {
        ""
    };
    let rest = if model.state.len() > 2 || !model.context.is_empty() {
        " All other channels are at their median."
    } else {
        ""
    };
    let caption = format!(
        "Arrows: the learnt policy. Blue: the demonstrations; dots mark where they start, arrowheads which way they go.{constraints}{potential} Grey: outside the range of the demonstrations, or too \
         far from all of them to predict an action.{rest}"
    );
    Card { id: "field", title: FIELD, caption: &caption, remark: None, svg: &svg }.under(FIELD)
}

fn numbers(model: &Model) -> Markup {
    let numbers = &model.trust.numbers;
    let worst = numbers.episode_errors.iter().map(|&(_, error)| error).max_by(f64::total_cmp);
    // For PolicyAlign, a Gaussian process is learnt as well; some numbers are of that process.
    let aligned = numbers.aligned.as_ref();
    let named =
        |what: &str, learner: &str| if aligned.is_some() { format!("{what} ({learner})") } else { what.to_owned() };
    let (gp, slope) = ("of the Gaussian process", "of the slope GP");
    let of_policy = [
        (
            named("Cross-validated error along the observed motion, relative to the policy", "of PolicyAlign"),
            Some(numbers.held_out_error),
            Good::Below(TrustNumbers::GOOD_HELD_OUT_ERROR),
        ),
        (
            "The same for the direct learner (plain averaging)".to_owned(),
            Some(numbers.held_out_error_direct),
            Good::COMPARED,
        ),
        (
            "Cross-validated error of the direct learner in all directions".to_owned(),
            Some(numbers.direct_error),
            Good::COMPARED,
        ),
        (
            if aligned.is_some() {
                "Expected error: by the difference from the Gaussian process and its posterior variance".to_owned()
            } else {
                "Error expected from the posterior variance".to_owned()
            },
            Some(numbers.expected_error),
            Good::Below(numbers.good_expected_error()),
        ),
        (
            named("Difference between slope and direct policy", "both Gaussian processes"),
            Some(numbers.gap),
            Good::Words("large where constraints acted"),
        ),
        (named("Cross-validated error of the worst episode", gp), worst, Good::Words("near that of all episodes")),
        (
            named("Difference between the policies learnt from either half of the episodes", gp),
            numbers.halves,
            numbers.good_halves().map_or(Good::Words("any: the expected error is small"), Good::Below),
        ),
        (
            named(
                "Squared errors divided by the variance that the policy predicts; 1 where it predicts its errors",
                slope,
            ),
            Some(numbers.z_squared),
            Good::Below(4.0),
        ),
        (COVERAGE.0.to_owned(), Some(numbers.direction_coverage), COVERAGE.1),
        (
            named("Rotation: share of the policy that no potential explains", slope),
            Some(numbers.rotation_share),
            Good::Words("0 for a potential"),
        ),
        (
            named("Share of rollouts that leave the demonstrated region", "of PolicyAlign"),
            Some(numbers.leaving),
            Good::Below(TrustNumbers::GOOD_LEAVING),
        ),
        (NOISE.0.to_owned(), Some(numbers.step_noise), NOISE.1),
    ];
    let kept = |aligned: &AlignedNumbers| aligned.kept as f64 / (aligned.kept + aligned.discarded) as f64;
    let of_alignment = [
        ("Share of the episodes that were aligned", aligned.map(kept), Good::Words("near 1")),
        ("Disagreement of the aligned potentials", aligned.map(|aligned| aligned.residual), Good::Below(0.1)),
        (
            "Share of held-out samples outside every receptive field",
            aligned.map(|aligned| aligned.unsupported),
            Good::Below(0.05),
        ),
        ("Difference from the Gaussian process", aligned.map(|aligned| aligned.difference), Good::Below(0.1)),
    ];
    let of_alignment = of_alignment.map(|(what, value, good)| (what.to_owned(), value, good));
    let [unseen, least_known] = [&numbers.unseen_direction, &numbers.least_known_direction]
        .map(|direction| direction_by_channels(direction, &model.state));
    html! {
        p { "Errors are mean squared errors as a share of the mean squared action: 0 is exact, 1 is no better than standing still." }
        (table(of_policy.into_iter().chain(of_alignment)))
        p { "Least observed direction: motion along " (unseen) ". The policy is least certain along " (least_known) "." }
    }
}

fn data(model: &Model, checksum: &str) -> Markup {
    let files: Vec<String> =
        model.data.files.iter().map(|file| format!("{}, SHA-256 {:.16}", file.name, file.sha256)).collect();
    html! {
        (channels(&model.state))
        @if !model.context.is_empty() { p { "Context, constant during a movement:" } (channels(&model.context)) }
        (left_out(&model.data.left_out))
        p .where { "Files: "
        (files.join("; ")) ". " (model.made_by.program) ", " (model.made_by.time) ", seed " (model.seed) ". "
        (NAMED) (format!("{checksum:.DIGITS$}")) "." }
    }
}
