//! States from a file for prediction: one column per channel, found by name, or the channels alone.

use std::path::Path;

use nalgebra::DMatrix;
use policy_align::Model;

use crate::cli::failure::{Exit, Failure, displayed};

/// Largest size of a file of states, in bytes.
const LARGEST: u64 = 1 << 30;

/// Reads states (n, N) from delimited text; with an open context, each is followed by its context, (n + p, N). `-` is standard
/// input.
pub(crate) fn states(path: &Path, model: &Model) -> Result<DMatrix<f64>, Failure> {
    let bytes = if path == Path::new("-") {
        demo_io::read_bounded(std::io::stdin(), LARGEST)
    } else {
        demo_io::read_bytes(path, LARGEST)
    };
    let bytes = bytes.map_err(|error| Failure::reading(path, error))?;
    let text = str::from_utf8(&bytes).map_err(|_| Failure::reading(path, "it is not UTF-8"))?;
    parsed(text, model, &displayed(path))
}

fn parsed(text: &str, model: &Model, place: &str) -> Result<DMatrix<f64>, Failure> {
    let n = inputs(model).count();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let first = text.lines().next().unwrap_or_default();
    let separator = [b'\t', b';', b','].into_iter().find(|&s| first.contains(char::from(s))).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator)
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let fault =
        |what: String, line: u64, remedy: &str| Failure::new(Exit::File, what, format!("{place}, line {line}"), remedy);
    let (mut columns, mut numbers): (Option<Vec<usize>>, Vec<f64>) = (None, Vec::new());
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(1, csv::Position::line);
            fault("the row differs from the first in its number of fields".to_owned(), line, "rows of equal length")
        })?;
        let line = record.position().map_or(1, csv::Position::line);
        let Some(columns) = &columns else {
            let found = columns_of(&record, model).ok_or_else(|| {
                let what =
                    format!("the first row does not name all of {}", inputs(model).collect::<Vec<_>>().join(", "));
                fault(what, line, "a header with these names, or only these columns")
            })?;
            let is_header = record.iter().any(|field| field.parse::<f64>().is_err());
            if !is_header {
                take(&record, &found, &mut numbers).map_err(|what| fault(what, line, "numbers"))?;
            }
            columns = Some(found);
            continue;
        };
        take(&record, columns, &mut numbers).map_err(|what| fault(what, line, "a number"))?;
    }
    let states = DMatrix::from_vec(n, numbers.len() / n, numbers);
    if states.ncols() == 0 {
        return Err(fault("the file has no state".to_owned(), 1, "one row per state, or --at 0.3,1.2"));
    }
    Ok(states)
}

/// Columns of the channels, by a header or by number.
fn columns_of(record: &csv::StringRecord, model: &Model) -> Option<Vec<usize>> {
    if record.iter().all(|field| field.parse::<f64>().is_ok()) {
        return (record.len() == inputs(model).count()).then(|| (0..record.len()).collect());
    }
    inputs(model).map(|name| record.iter().position(|field| field == name)).collect()
}

/// Names of the policy's inputs.
fn inputs(model: &Model) -> impl Iterator<Item = &str> {
    model.state.iter().chain(model.open_context()).map(|channel| channel.name.as_str())
}

fn take(record: &csv::StringRecord, columns: &[usize], numbers: &mut Vec<f64>) -> Result<(), String> {
    for &column in columns {
        let field = record.get(column).unwrap_or_default();
        match field.parse::<f64>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            _ => return Err(format!("'{field}' is not a finite number")),
        }
    }
    Ok(())
}
