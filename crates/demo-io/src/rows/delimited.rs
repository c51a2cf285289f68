//! Text with separators: CSV, TSV, columns separated by blanks.

mod beginning;
mod cut;
mod dialect;
mod fields;
mod records;
mod source;

use csv::ByteRecord;

use self::beginning::{Beginning, header_again, is_header};
pub(crate) use self::cut::cut;
use crate::arrays::array::{ArraySpec, Data, Kind};
use crate::arrays::flat;
use crate::input::Input;
use crate::raw::{RawRecordings, remark};
use crate::rows::piece::Span;
use crate::rows::table::Row as _;
use crate::{Fault, ReadError, SamplesAre};

/// Reads all records, or those of a part.
pub(crate) fn read(
    input: &Input<'_>,
    part: Option<&Span>,
    progress: &mut dyn FnMut(u64),
) -> Result<RawRecordings, ReadError> {
    let beginning = Beginning::of(input, progress, false)?;
    if beginning.is_transposed(input) {
        return transposed(input, beginning);
    }
    let mut table = beginning.table(input)?;
    let is_idle = beginning.header.is_some() && input.options.samples_are == Some(SamplesAre::Columns);
    let Beginning { dialect, header, mut records, head } = beginning;
    drop(head);
    if let Some(part) = part {
        table.forget_episodes();
        records = records.within(part, &dialect)?;
    }
    let mut record = ByteRecord::new();
    while let Some(line) = records.next(&mut record)? {
        table.push(line, &dialect.fields(&record)).map_err(|error| match &header {
            Some(header) if is_header(&record, header) => header_again(line, &input.name),
            _ => error,
        })?;
    }
    let mut recordings = table.finish();
    if is_idle {
        let what = "--samples-are columns has no effect on a table with a header";
        recordings.findings.push(remark(what, "no --samples-are, or a file whose lines are channels without a header"));
    }
    if dialect.decimal_comma {
        let what = format!("decimal commas of {} were read as points", input.name);
        recordings.findings.push(remark(what, "--decimal . if they are something else"));
    }
    Ok(recordings)
}

/// Reads text without names in which each line holds a channel: an array whose samples are columns.
fn transposed(input: &Input<'_>, beginning: Beginning<'_>) -> Result<RawRecordings, ReadError> {
    let Beginning { dialect, mut records, head, .. } = beginning;
    let mut numbers = Vec::new();
    let mut push = |line: u64, record: &ByteRecord| {
        input.charge(8 * record.len() as u64)?;
        for column in 0..record.len() {
            let number = dialect.fields(record).number(column);
            numbers.push(number.map_err(|text| {
                let what = format!("'{}' is not a number", text.chars().take(40).collect::<String>());
                let place = format!("{}, line {line}, column {column}", input.name);
                ReadError::NotANumber(Fault::new(what, place, "lines of numbers only, or a first line with names"))
            })?);
        }
        Ok(())
    };
    head.iter().try_for_each(|(line, record)| push(*line, record))?;
    let mut lines = head.len();
    let mut record = ByteRecord::new();
    while let Some(line) = records.next(&mut record)? {
        push(line, &record)?;
        lines += 1;
    }
    let mut samples = records.fields;
    // A separator ends each line.
    if samples > 1 && numbers.chunks_exact(samples).all(|line| line[samples - 1].is_nan()) {
        numbers = numbers.chunks_exact(samples).flat_map(|line| &line[..samples - 1]).copied().collect();
        samples -= 1;
    }
    let shape = vec![lines, samples];
    let described = [ArraySpec { name: input.stem.clone(), shape, kind: Kind::Number("float64") }];
    flat::recordings(input, &described, &mut |_| Ok(Data::Numbers(numbers.clone())))
}
