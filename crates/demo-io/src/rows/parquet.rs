//! Parquet: named columns as in CSV; a column of lists of equal length yields as many states.

mod descriptions;
mod failure;
mod fields;
mod leaf;

use std::collections::HashMap;

use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};

use self::failure::failed;
use self::leaf::Leaf;
use crate::clean::ENVIRONMENT;
use crate::input::Input;
use crate::names::selection::select;
use crate::raw::{RawRecordings, remark};
use crate::rows::roles::{Column, Content};
use crate::rows::stamps::Stamp;
use crate::rows::table::{Row, Table};
use crate::{Fault, ReadError, ReadOptions, TimeUnit};
use motion::Finding;

/// Properties of columns that another file describes.
#[derive(Debug, Default)]
pub(crate) struct Described {
    /// Names of a list's elements, by the column's name.
    pub(crate) elements: HashMap<String, Vec<String>>,
    /// Seconds between samples.
    pub(crate) period: Option<f64>,
}

/// The state's column in LeRobot's format and its imitations.
pub(crate) const STATE: &str = "observation.state";

pub(crate) fn read(
    input: &Input<'_>,
    described: &Described,
    progress: &mut dyn FnMut(u64),
) -> Result<RawRecordings, ReadError> {
    descriptions::check_end(input)?;
    let file = SerializedFileReader::new(input.open()?).map_err(|error| failed(&error, input))?;
    let leaves = Leaf::all(&file, input)?;
    if leaves.is_empty() {
        let what = "there is no column of numbers";
        return Err(ReadError::Empty(Fault::new(what, &input.name, "another file")));
    }
    let columns = Columns::new(leaves);
    let options = columns.options(input.options, described, &input.name)?;
    let names: Vec<Column> = columns.expanded();
    let listed = !options.state.is_empty() || columns.leaves.iter().any(|leaf| leaf.list);
    let mut table = Table::new(&names, (&input.name, &input.stem), "row", &options)?;
    let used = table.used();
    let mut checked = described.period.filter(|_| input.options.dt.is_none()).and_then(|period| columns.stamps(period));
    let mut row = 0;
    for group in 0..file.num_row_groups() {
        let reader = file.get_row_group(group).map_err(|error| failed(&error, input))?;
        let rows = usize::try_from(reader.metadata().num_rows()).unwrap_or(0);
        let mut data: Vec<Option<leaf::Values>> = Vec::with_capacity(columns.leaves.len());
        for (leaf, first) in columns.leaves.iter().zip(&columns.firsts) {
            let wanted = (*first..first + leaf.width).any(|column| used.contains(&column));
            data.push(if wanted { Some(leaf.read(&*reader, rows, input)?) } else { None });
        }
        if let Some(stamps) = &mut checked {
            stamps.check(&*reader, rows, row, input)?;
        }
        for at in 0..rows {
            table.push(row, &GroupRow { columns: &columns, data: &data, at })?;
            row += 1;
        }
        progress(u64::try_from(reader.metadata().compressed_size()).unwrap_or(0));
    }
    if row == 0 {
        return Err(ReadError::Empty(Fault::new("there is no row", &input.name, "a file with samples")));
    }
    let mut recordings = table.finish();
    recordings.drop_constant &= !listed;
    recordings.findings.extend(checked.and_then(|stamps| stamps.finding));
    rename(&mut recordings, described);
    Ok(recordings)
}

/// Leaves of the schema, and the columns into which they expand.
struct Columns {
    leaves: Vec<Leaf>,
    /// The first column of each leaf.
    firsts: Vec<usize>,
    /// The leaf of each column.
    owners: Vec<usize>,
}

impl Columns {
    fn new(leaves: Vec<Leaf>) -> Self {
        let mut firsts = Vec::new();
        let mut owners = Vec::new();
        for (index, leaf) in leaves.iter().enumerate() {
            firsts.push(owners.len());
            owners.extend(std::iter::repeat_n(index, leaf.width));
        }
        Self { leaves, firsts, owners }
    }

    fn name(&self, column: usize) -> String {
        let leaf = &self.leaves[self.owners[column]];
        if leaf.list {
            format!("{}_{}", leaf.name, column - self.firsts[self.owners[column]])
        } else {
            leaf.name.clone()
        }
    }

    fn expanded(&self) -> Vec<Column> {
        let content = |column: usize| match &self.leaves[self.owners[column]] {
            Leaf { text: true, .. } => Content::Text,
            Leaf { whole: true, .. } => Content::Counting,
            _ => Content::Numbers,
        };
        (0..self.owners.len()).map(|column| Column { name: self.name(column), content: content(column) }).collect()
    }

    /// The options, with patterns of lists replaced by their elements.
    fn options(&self, options: &ReadOptions, described: &Described, file: &str) -> Result<ReadOptions, ReadError> {
        let mut mine = options.clone();
        mine.dt = options.dt.or(described.period);
        mine.state = self.elements(&options.state, described, file)?;
        mine.velocity = self.elements(&options.velocity, described, file)?;
        mine.context = self.elements(&options.context, described, file)?;
        mine.ignore = options.ignore.iter().flat_map(|pattern| self.elements_of(pattern)).collect();
        if mine.state.is_empty() {
            mine.state = self.elements_of(STATE).into_iter().filter(|name| name != STATE || self.has(STATE)).collect();
            if !mine.state.is_empty() && mine.context.is_empty() && self.has(ENVIRONMENT) {
                mine.context = self.elements_of(ENVIRONMENT);
            }
        }
        if mine.state.is_empty() {
            // Actions are goals, not positions.
            mine.ignore.extend(
                self.leaves
                    .iter()
                    .filter(|leaf| leaf.name.starts_with("action"))
                    .flat_map(|leaf| self.elements_of(&leaf.name)),
            );
        }
        Ok(mine)
    }

    fn has(&self, name: &str) -> bool {
        self.leaves.iter().any(|leaf| leaf.name == name)
    }

    /// Names of the columns of the leaves that match a pattern; the pattern itself if none matches.
    fn elements_of(&self, pattern: &str) -> Vec<String> {
        let names: Vec<&str> = self.leaves.iter().map(|leaf| &leaf.name[..]).collect();
        match select(&[pattern.to_owned()], &names) {
            Ok(found) if !pattern.bytes().all(|letter| letter.is_ascii_digit() || letter == b'-') => found
                .into_iter()
                .flat_map(|leaf| self.firsts[leaf]..self.firsts[leaf] + self.leaves[leaf].width)
                .map(|column| self.name(column))
                .collect(),
            _ if pattern == STATE => Vec::new(),
            _ => vec![pattern.to_owned()],
        }
    }

    /// As [`Self::elements_of`], but elements of the state may also have the names that another file gives.
    fn elements(&self, patterns: &[String], described: &Described, file: &str) -> Result<Vec<String>, ReadError> {
        let mut columns = Vec::new();
        for pattern in patterns.iter().flat_map(|pattern| pattern.split(',')).map(str::trim) {
            let given = described.elements.get(STATE).and_then(|names| select(&[pattern.to_owned()], names).ok());
            match given.filter(|_| !self.has(pattern)) {
                Some(elements) => columns.extend(elements.into_iter().map(|at| format!("{STATE}_{at}"))),
                None => columns.extend(self.elements_of(pattern)),
            }
        }
        let names: Vec<String> = self.expanded().into_iter().map(|column| column.name).collect();
        if let Err(pattern) = select(&columns, &names) {
            let leaves: Vec<&str> = self.leaves.iter().map(|leaf| &leaf.name[..]).collect();
            return Err(crate::rows::roles::no_column(&pattern, &leaves, file));
        }
        Ok(columns)
    }

    fn stamps(&self, period: f64) -> Option<Stamps<'_>> {
        let leaf = |name: &str| self.leaves.iter().find(|leaf| leaf.name == name && !leaf.list && !leaf.text);
        Some(Stamps { period, stamp: leaf("timestamp")?, frame: leaf("frame_index")?, finding: None })
    }
}

/// Renames channels to the names that another file gives.
fn rename(recordings: &mut RawRecordings, described: &Described) {
    let given: HashMap<String, &String> = described
        .elements
        .iter()
        .flat_map(|(list, names)| names.iter().enumerate().map(move |(at, name)| (format!("{list}_{at}"), name)))
        .collect();
    for channel in &mut recordings.channels {
        if let Some(name) = given.get(&channel.name) {
            channel.name = (*name).clone();
        }
    }
}

/// Stamps beside a rate. They must agree with the rate but are not used, because single precision makes them uneven.
struct Stamps<'a> {
    period: f64,
    stamp: &'a Leaf,
    frame: &'a Leaf,
    finding: Option<Finding>,
}

impl Stamps<'_> {
    fn check(
        &mut self,
        group: &dyn RowGroupReader,
        rows: usize,
        first: u64,
        input: &Input<'_>,
    ) -> Result<(), ReadError> {
        if self.finding.is_some() {
            return Ok(());
        }
        let (stamps, frames) = (self.stamp.read(group, rows, input)?, self.frame.read(group, rows, input)?);
        for row in 0..rows {
            let (Ok(stamp), Ok(frame)) = (stamps.number(row), frames.number(row)) else { continue };
            let off = (stamp - frame * self.period).abs();
            // The accuracy of single precision after an hour.
            if off > 1e-4 + stamp.abs() * 1e-7 {
                let place = format!("{}, row {}", input.name, first + row as u64);
                let what = format!("{place}: the stamp {stamp} s does not belong to frame {frame} at the rate in meta");
                self.finding = Some(remark(what, "the rate was used; check both"));
                break;
            }
        }
        Ok(())
    }
}

/// A row of a row group.
struct GroupRow<'a> {
    columns: &'a Columns,
    /// `None` for an unused leaf.
    data: &'a [Option<leaf::Values>],
    at: usize,
}

impl GroupRow<'_> {
    fn values(&self, column: usize) -> Option<(&leaf::Values, usize)> {
        let owner = self.columns.owners[column];
        let leaf = &self.columns.leaves[owner];
        Some((self.data[owner].as_ref()?, self.at * leaf.width + column - self.columns.firsts[owner]))
    }
}

impl Row for GroupRow<'_> {
    fn number(&self, column: usize) -> Result<f64, String> {
        self.values(column).map_or(Ok(f64::NAN), |(values, at)| values.number(at))
    }

    fn stamp(&self, column: usize) -> Result<(Stamp, Option<TimeUnit>), String> {
        self.values(column).map_or(Ok((Stamp::MISSING, None)), |(values, at)| values.stamp(at))
    }

    fn label(&self, column: usize, label: &mut String) {
        label.clear();
        if let Some((values, at)) = self.values(column) {
            label.push_str(&values.label(at));
        }
    }
}
