//! Rows that are documents, one per sample.

use std::collections::HashMap;

use crate::input::Input;
use crate::raw::{MOST_CHANNELS, RawRecordings};
use crate::rows::json::{Json, MOST_LEAVES};
use crate::rows::roles::{Column, HEAD_ROWS, content};
use crate::rows::table::{Row as _, Table};
use crate::{Fault, ReadError};

/// Rows of documents. The paths of the first document are the columns.
pub(crate) struct Documents<'a> {
    input: &'a Input<'a>,
    word: &'static str,
    names: Vec<String>,
    index: HashMap<String, usize>,
    head: Vec<(u64, Vec<Json>)>,
    table: Option<Table>,
}

impl<'a> Documents<'a> {
    pub(crate) fn new(input: &'a Input<'a>, word: &'static str) -> Self {
        Self { input, word, names: Vec::new(), index: HashMap::new(), head: Vec::new(), table: None }
    }

    pub(crate) fn push(&mut self, place: u64, document: &Json) -> Result<(), ReadError> {
        let row = self.row(place, document)?;
        if let Some(table) = &mut self.table {
            table.push(place, &row)
        } else {
            self.head.push((place, row));
            if self.head.len() == HEAD_ROWS {
                self.table = Some(self.begin()?);
                self.head.clear();
            }
            Ok(())
        }
    }

    /// The values of a document by column.
    fn row(&mut self, place: u64, document: &Json) -> Result<Vec<Json>, ReadError> {
        if self.names.is_empty() {
            return self.first_row(place, document);
        }
        let mut row = vec![Json::Null; self.names.len()];
        let mut unknown = None;
        let mut next = 0;
        document.leaves(&mut String::new(), &mut |path, leaf| {
            // The keys are mostly in the order of the first document.
            let expected = Some(next).filter(|&next| self.names.get(next).is_some_and(|name| name == path));
            match expected.or_else(|| self.index.get(path).copied()) {
                Some(column) => {
                    row[column] = leaf.clone();
                    next = column + 1;
                }
                None => unknown = unknown.take().or_else(|| Some(path.to_owned())),
            }
        });
        match unknown {
            Some(path) => {
                let place = format!("{}, {} {place}", self.input.name, self.word);
                let what = format!("'{path}' is not in the first {}", self.word);
                Err(ReadError::Ragged(Fault::new(what, place, "the same keys, and lists of the same length, in each")))
            }
            None => Ok(row),
        }
    }

    fn first_row(&mut self, place: u64, document: &Json) -> Result<Vec<Json>, ReadError> {
        let mut row = Vec::new();
        document.leaves(&mut String::new(), &mut |path, leaf| {
            if row.len() <= MOST_LEAVES {
                row.push(leaf.clone());
                self.names.push(path.to_owned());
            }
        });
        self.index = self.names.iter().enumerate().map(|(at, name)| (name.clone(), at)).collect();
        let place = format!("{}, {} {place}", self.input.name, self.word);
        if !matches!(document, Json::Map(_)) || row.is_empty() {
            let what = "not an object of names and numbers";
            return Err(ReadError::Json(Fault::new(what, place, "lines like {\"t\": 0.05, \"x\": 0.5, \"y\": 1.2}")));
        }
        if row.len() > MOST_CHANNELS && self.input.options.state.is_empty() {
            let what = format!("one JSON object of {} values, not one sample", row.len());
            let remedy = "one line per movement: {\"state\": [[0.1, 0.2], …], \"dt\": 0.05}, or per sample: {\"t\": 0.05, \"x\": 0.5}";
            return Err(ReadError::Json(Fault::new(what, place, remedy)));
        }
        if row.len() > MOST_LEAVES {
            let what = format!("more than {MOST_LEAVES} values in one {}", self.word);
            return Err(ReadError::TooLarge(Fault::new(what, place, "one line per episode, or per sample")));
        }
        Ok(row)
    }

    /// Creates the table from the first rows.
    fn begin(&self) -> Result<Table, ReadError> {
        let column = |(at, name): (usize, &String)| Column {
            name: name.clone(),
            content: content(self.head.iter().map(|(_, row)| row.number(at))),
        };
        let columns: Vec<Column> = self.names.iter().enumerate().map(column).collect();
        let input = self.input;
        let mut table = Table::new(&columns, (&input.name, &input.stem), self.word, input.options)?;
        self.head.iter().try_for_each(|(place, row)| table.push(*place, row))?;
        Ok(table)
    }

    pub(crate) fn finish(self) -> Result<RawRecordings, ReadError> {
        let table = match self.table {
            Some(table) => table,
            None => self.begin()?,
        };
        Ok(table.finish())
    }
}
