//! The tables show the contents of `results.json`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use crate::page;

/// The texts of a cell at one of its places on the page.
#[derive(Debug, Deserialize)]
struct Shown {
    experiment: String,
    row: String,
    measure: String,
    ours: String,
    median: Option<String>,
    n: Option<String>,
    paper: Option<String>,
    z: Option<String>,
    verdict: Option<String>,
    second: Option<String>,
    /// Position of each dot, pixels.
    dots: Vec<f64>,
}

const SHOWN: &str = "[...document.querySelectorAll('[data-measure]')].map(cell => {
    const text = (selector) => cell.querySelector(selector)?.textContent.replaceAll('\\u00a0', ' ') ?? null;
    return {
        experiment: cell.closest('section').id, row: cell.dataset.row, measure: cell.dataset.measure,
        ours: text('.ours'), median: text('span.median'), n: text('.n'), paper: text('.paper'), z: text('.z'),
        verdict: text('.verdict'), second: text('.second'),
        dots: [...cell.querySelector('.strip .dots').getAttribute('d').matchAll(/M([-.\\d]+)/g)].map(at => Number(at[1])),
    };
})";

/// A cell of `results.json`.
struct Cell {
    name: [String; 3],
    data_sets: u64,
    failed: u64,
    value: Value,
}

fn results(seed: u32) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../docs/records/seed-{seed}/results.json"));
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn text(value: &Value) -> String {
    value.as_str().unwrap().to_owned()
}

fn cells(results: &Value) -> Vec<Cell> {
    let mut cells = Vec::new();
    for experiment in results["experiments"].as_array().unwrap() {
        for row in experiment["rows"].as_array().unwrap() {
            for (measure, value) in row["measures"].as_object().unwrap() {
                cells.push(Cell {
                    name: [text(&experiment["id"]), text(&row["id"]), measure.clone()],
                    data_sets: row["data_sets"].as_u64().unwrap(),
                    failed: row["failed"].as_u64().unwrap(),
                    value: value.clone(),
                });
            }
        }
    }
    cells
}

/// A number as the tables print it: percentages with two decimals, errors with four, small ones with six, rounding errors with one digit.
fn printed(measure: &str, value: &Value) -> String {
    beside(measure, value, value)
}

/// A standard deviation, with the decimals of its mean.
fn deviation(measure: &str, sd: &Value, mean: &Value) -> String {
    let shown = beside(measure, sd, mean);
    let is_lost = shown.parse() == Ok(0.0) && sd.as_f64() != Some(0.0) && !shown.ends_with(".00");
    if is_lost { printed(measure, sd) } else { shown }
}

fn beside(measure: &str, value: &Value, other: &Value) -> String {
    let (Some(value), Some(other)) = (value.as_f64(), other.as_f64()) else { return "–".to_owned() };
    if ["disc", "unsupported", "beyond_limits"].contains(&measure) {
        format!("{value:.2}")
    } else if other != 0.0 && other.abs() < 1e-5 {
        format!("{value:.0e}")
    } else if other.abs() < 0.001 {
        format!("{value:.6}")
    } else {
        format!("{value:.4}")
    }
}

/// A number of the paper, with no more digits than it was printed with.
fn as_in_the_paper(measure: &str, value: &Value) -> String {
    let text = printed(measure, value);
    text.strip_suffix("00").filter(|short| short.len() == "0.1234".len()).map_or(text.clone(), str::to_owned)
}

#[test]
fn every_cell_matches_the_results() {
    let Some(mut page) = page() else { return };
    let mut shown: BTreeMap<[String; 3], Vec<Shown>> = BTreeMap::new();
    for cell in page.evaluate::<Vec<Shown>>(SHOWN) {
        let name = [cell.experiment.clone(), cell.row.clone(), cell.measure.clone()];
        shown.entry(name).or_default().push(cell);
    }
    let second = results(2);
    let second: BTreeMap<_, _> = cells(&second).into_iter().map(|cell| (cell.name.clone(), cell.value)).collect();
    let cells = cells(&results(1));
    assert!(cells.len() > 100, "{} cells", cells.len());
    // Additional learners have separate tables.
    for cell in cells.into_iter().filter(|cell| !cell.name[1].contains('/')) {
        let places = shown.remove(&cell.name).unwrap_or_else(|| panic!("{:?} is not on the page", cell.name));
        for place in &places {
            holds(&cell, place);
        }
        // One place shows all details.
        let whole = places.iter().find(|place| place.median.is_some());
        let whole = whole.unwrap_or_else(|| panic!("{:?} is nowhere shown in full", cell.name));
        holds_in_full(&cell, whole, second.get(&cell.name));
    }
    assert!(shown.is_empty(), "on the page, but in no results: {:?}", shown.keys());
}

/// Checks the contents of every place: our mean, the paper's, the verdict, and each data set as a dot.
fn holds(cell: &Cell, place: &Shown) {
    let (measure, value) = (cell.name[2].as_str(), &cell.value);
    let mean_sd =
        |of: &Value| format!("{} ± {}", printed(measure, &of["mean"]), deviation(measure, &of["sd"], &of["mean"]));
    assert_eq!(place.ours, mean_sd(value), "{:?}", cell.name);
    if value["paper"].is_null() {
        assert!(place.verdict.is_none(), "{place:?}");
    } else {
        let paper = &value["paper"];
        let sd = deviation(measure, &paper["sd"], &paper["mean"]);
        assert_eq!(
            place.paper,
            Some(format!("{} ± {sd}", as_in_the_paper(measure, &paper["mean"]))),
            "{:?}",
            cell.name
        );
        assert_eq!(place.verdict.as_deref(), value["verdict"].as_str(), "{:?}", cell.name);
    }
    let values: Vec<f64> = value["values"].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    assert_eq!(place.dots.len(), values.len(), "{:?}", cell.name);
    let mut dots: Vec<(f64, f64)> = values.into_iter().zip(place.dots.iter().copied()).collect();
    dots.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    assert!(dots.is_sorted_by(|(_, a), (_, b)| a <= b), "{:?}: a larger value lies further right", cell.name);
    assert!(dots.len() as u64 <= cell.data_sets - cell.failed, "{:?}", cell.name);
}

/// Checks median, number of data sets, significance of the difference, and the other seed.
fn holds_in_full(cell: &Cell, place: &Shown, second: Option<&Value>) {
    let (measure, value) = (cell.name[2].as_str(), &cell.value);
    assert_eq!(place.median.as_ref(), Some(&printed(measure, &value["median"])), "{:?}", cell.name);
    let n = value["values"].as_array().unwrap().iter().filter(|value| !value.is_null()).count();
    assert_eq!(place.n.as_deref(), Some(n.to_string().as_str()), "{:?}", cell.name);
    let second = second.map_or("–".to_owned(), |second| printed(measure, &second["mean"]));
    assert_eq!(place.second.as_ref(), Some(&second), "{:?}", cell.name);
    if !value["paper"].is_null() {
        // A full run has as many data sets as the paper.
        let number = |of: &Value, name: &str| of[name].as_f64().unwrap();
        let error = (number(value, "sd").powi(2) / n as f64
            + number(&value["paper"], "sd").powi(2) / cell.data_sets as f64)
            .sqrt();
        let z = (number(value, "mean") - number(&value["paper"], "mean")) / error;
        let z = if error > 0.0 { format!("{z:+.1}").replace('-', "−") } else { "–".to_owned() };
        assert_eq!(place.z.as_ref(), Some(&z), "{:?}", cell.name);
    }
}

#[test]
fn the_opening_counts_every_printed_cell() {
    let Some(mut page) = page() else { return };
    let mut counted: BTreeMap<String, u32> = BTreeMap::new();
    // The literal reading is compared with numbers that already count.
    for cell in cells(&results(1)).iter().filter(|cell| cell.name[0] != "table1-literal") {
        if let Some(verdict) = cell.value["verdict"].as_str() {
            *counted.entry(verdict.to_owned()).or_default() += 1;
        }
    }
    let shown: BTreeMap<String, u32> = page.evaluate(
        "Object.fromEntries([...document.querySelectorAll('.total [data-verdict]')]
            .map(item => [item.dataset.verdict, Number(item.querySelector('b').textContent)]))",
    );
    assert_eq!(shown, counted);
    let total: u32 = page.evaluate("Number(document.querySelector('.asked b').textContent)");
    assert_eq!(total, counted.values().sum::<u32>());
}

#[test]
fn missed_cells_are_shown_in_the_opening() {
    let Some(mut page) = page() else { return };
    let text: String = page.evaluate("document.getElementById('glance').textContent");
    let missed = |cell: &Cell| ["higher", "differs"].map(Value::from).contains(&cell.value["verdict"]);
    for cell in cells(&results(1)).into_iter().filter(missed) {
        let ours = printed(&cell.name[2], &cell.value["mean"]);
        assert!(text.contains(&cell.name[1]) && text.contains(&ours), "{:?}: {ours} is not shown", cell.name);
    }
}
