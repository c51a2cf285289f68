//! Tests: captions are true of every run, and the texts that compare figures with the paper's match the committed
//! records.

use std::fs;
use std::path::Path;

use experiments::measure::Measure::{self, Ncpe, Nupe, PotentialNmse};
use experiments::results::{Cell, Results};
use experiments::variants::two_digits;

use crate::{Figure, Sources, figures};

/// The full run to which the texts refer.
pub(super) fn records() -> Sources {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/records/seed-1");
    let results = Results::read("results.json", &fs::read_to_string(folder.join("results.json")).unwrap()).unwrap();
    let document = |id: &str| {
        let text = fs::read_to_string(folder.join(format!("figures/{id}.json")))?;
        Ok(Some(serde_json::from_str(&text)?))
    };
    Sources::of(results, document).unwrap()
}

/// The text that compares a figure with the paper's.
pub(super) fn text(id: &str) -> &'static str {
    figures().into_iter().find(|figure| figure.id == id).and_then(|figure| figure.beside_paper).unwrap()
}

fn cell<'s>(sources: &'s Sources, experiment: &str, row: &str, measure: Measure) -> &'s Cell {
    let rows = &sources.experiment(experiment).unwrap().rows;
    &rows.iter().find(|result| result.id == row).unwrap().measures[&measure]
}

fn assert_says(id: &str, words: &str) {
    let text = text(id);
    assert!(text.contains(words), "{id} does not say {words:?}: {text}");
}

const ERRORS: [(&str, Measure); 3] = [("π", Nupe), ("Nπ", Ncpe), ("φ", PotentialNmse)];

/// Checks for a text such as "π from 0.18 to 0.43", with the errors of two rows.
fn assert_says_from_to(sources: &Sources, id: &str, [from, to]: [&str; 2], errors: &[(&str, Measure)]) {
    for (name, measure) in errors {
        let [from, to] = [from, to].map(|row| two_digits(cell(sources, id, row, *measure).mean));
        assert_says(id, &format!("{name} from {from} to {to}"));
    }
}

#[test]
fn captions_hold_for_every_run_and_comparisons_for_one() {
    for Figure { id, caption, beside_paper, needs, .. } in figures() {
        assert!(!caption.contains("paper") && !caption.contains("seed"), "{id}: {caption}");
        let of_results = needs.iter().any(|need| experiments::registry().unwrap().iter().any(|e| e.id == *need));
        let names_the_run = beside_paper.is_some_and(|text| text.starts_with("In the full run of seed 1"));
        assert!(names_the_run || !(of_results || id == "figure8"), "{id}: {beside_paper:?}");
    }
}

/// Whether φ has the lowest error, and whether π has the highest.
fn order(sources: &Sources, experiment: &str, row: &str) -> (bool, bool) {
    let [policy, seen, potential] = ERRORS.map(|(_, measure)| cell(sources, experiment, row, measure).mean);
    (potential < seen.min(policy), policy > seen.max(potential))
}

#[test]
fn figure_6_left_text_matches_the_records() {
    let (sources, id) = (records(), "figure6_left");
    assert_says_from_to(&sources, id, ["narrow-20", "narrow-100"], &ERRORS);
    let median = two_digits(cell(&sources, id, "narrow-20", PotentialNmse).median);
    assert_says(id, &format!("the median of φ is {median}"));
    assert_says(id, "with the narrow bandwidth from 40 % on, with the medium one from 80 % on");
    for (bandwidth, first) in [("narrow", 40), ("medium", 80)] {
        for percent in [20, 40, 60, 80, 100] {
            assert_eq!(order(&sources, id, &format!("{bandwidth}-{percent}")), (percent >= first, true));
        }
    }
}

#[test]
fn figure_6_right_text_matches_the_records() {
    let (sources, id) = (records(), "figure6_right");
    assert_says_from_to(&sources, id, ["velocity-narrow-2.5", "velocity-narrow-20"], &ERRORS);
    assert_says(id, "with π on top and φ lowest throughout");
    for bandwidth in ["narrow", "medium"] {
        for percent in [2.5, 5.0, 10.0, 15.0, 20.0] {
            let row = format!("velocity-{bandwidth}-{percent}");
            assert_eq!(order(&sources, id, &row), (true, true), "{row}");
        }
    }
    let [narrow, medium] =
        ["displacement-narrow-5", "displacement-medium-5"].map(|row| two_digits(cell(&sources, id, row, Nupe).mean));
    assert_says(
        id,
        &format!("at 5 % the error of π is {narrow} with the narrow bandwidth and {medium} with the medium one"),
    );
}

#[test]
fn figure_9_text_matches_the_records() {
    let (sources, id) = (records(), "figure9");
    assert_says_from_to(&sources, id, ["d-0.1", "d-1.0"], &ERRORS);
    assert_says_from_to(&sources, id, ["r-0.1", "r-1.0"], &[ERRORS[0], ERRORS[2]]);
}

/// The explanation of a cell of a table.
fn explained(experiment: &str, row: &str, measure: Measure) -> String {
    let all = experiments::registry().unwrap();
    let experiment = all.into_iter().find(|other| other.id == experiment).unwrap();
    experiment.explain(row, measure).unwrap().to_owned()
}

#[test]
fn other_readings_of_tables_are_quoted_as_they_are() {
    let sources = records();
    let numbers = |row, measure| {
        ["table1", "table1-literal"].map(|experiment| two_digits(cell(&sources, experiment, row, measure).mean))
    };
    for measure in [PotentialNmse, Nupe, Ncpe] {
        let [two, three] = numbers("parabola-40x40-wide", measure);
        let text = explained("table1-literal", "parabola-40x40-wide", measure);
        assert!(text.contains(&format!("{two} with two, {three} with three")), "{two} {three}: {text}");
        let [five, three] = numbers("sinusoidal-100x100-wide", measure);
        let text = explained("table1-literal", "sinusoidal-100x100-wide", measure);
        assert!(text.contains(&format!("{three} with three, {five} with five")), "{three} {five}: {text}");
    }
}

/// Numbers that explanations of cells call printed are printed in the paper.
#[test]
fn numbers_called_printed_are_in_the_paper() {
    let number = |word: &str| {
        let word = word.trim_matches(|c: char| !c.is_ascii_digit());
        let last_place = 0.1_f64.powf(word.split_once('.').map_or(0.0, |(_, decimals)| decimals.len() as f64));
        word.parse::<f64>().ok().map(|value| (value, last_place))
    };
    let mut found = 0;
    for experiment in experiments::registry().unwrap() {
        let printed: Vec<f64> = experiment.paper.values().flat_map(|row| row.values()).map(|cell| cell.mean).collect();
        let is_printed =
            |(value, last_place): (f64, f64)| printed.iter().any(|mean| (mean - value).abs() <= 0.500_001 * last_place);
        for text in experiment.explanations.texts.values().flat_map(|row| row.values()) {
            let words: Vec<&str> = text.split_whitespace().collect();
            let is_number = |word: &str| word.starts_with(|c: char| c.is_ascii_digit());
            let tells = |pair: &&[&str]| (pair[0].ends_with("printed") || pair[0] == "for") && is_number(pair[1]);
            let after = words.windows(2).filter(tells).map(|pair| pair[1]);
            let before = words.windows(3).filter(|three| three[1..] == ["is", "printed."]).map(|three| three[0]);
            for told in after.chain(before).filter_map(number) {
                assert!(is_printed(told), "{}: {told:?} is not printed: {text}", experiment.id);
                found += 1;
            }
        }
    }
    assert!(found > 10, "{found}");
}

/// Checks the statements about plain Euler steps of the grasp's potential, and about the way of the hands in the paper's
/// two seconds.
#[test]
fn grasp_rates_match_the_text() {
    let grasp = experiments::grasp().unwrap();
    let rate = 2.0 * grasp.scene.potential().weight;
    let way = 100.0 * (1.0 - (-2.0 * rate).exp());
    assert_says("figure7", &format!("in 2 s this potential moves a hand over {way:.0} %"));
    let seconds = grasp.roll_out.time_step * grasp.roll_out.n_samples as f64;
    assert_says("figure7", &format!("movements last 2 s, ours {seconds}"));
    let step = rate / 2.0 * grasp.roll_out.time_step;
    let alone = (step / (1.0 - step)).powi(2);
    let text = explained("table2", "alignment", Measure::AlignmentNmse);
    assert!(text.contains(&format!("1/(1 - {step})")) && text.contains(&format!("{:.2}e-4", 1e4 * alone)), "{text}");
    let registry = experiments::registry().unwrap();
    let table = registry.iter().find(|experiment| experiment.id == "table2").unwrap();
    let above = 100.0 * (table.paper("alignment", Measure::AlignmentNmse).unwrap().mean / alone - 1.0);
    assert!(text.contains(&format!("{above:.0} percent larger")), "{above}: {text}");
}
