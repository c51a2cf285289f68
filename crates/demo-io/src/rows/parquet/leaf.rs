use parquet::basic::{self, LogicalType, Type};
use parquet::column::page::Page;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::file::reader::{FileReader, RowGroupReader};
use parquet::schema::types::ColumnDescriptor;

use super::descriptions;
use super::failure::{damaged, failed};
use crate::arrays::array::Data;
use crate::arrays::npy;
use crate::input::Input;
use crate::raw::MOST_CHANNELS;
use crate::rows::stamps::Stamp;
use crate::{Fault, ReadError, TimeUnit};

/// A column of values in the file: one per row, or lists of equal length.
#[derive(Debug)]
#[allow(clippy::struct_excessive_bools, reason = "facts of a schema that have nothing to do with each other")]
pub(super) struct Leaf {
    pub(super) name: String,
    index: usize,
    /// Number of values per row.
    pub(super) width: usize,
    pub(super) list: bool,
    pub(super) text: bool,
    pub(super) whole: bool,
    most_defined: i16,
    time_unit: Option<TimeUnit>,
    half: bool,
    /// Size of a floating-point value in bytes.
    float: Option<usize>,
}

/// Values of a row group, `width` per row.
#[derive(Debug)]
pub(super) struct Values {
    data: Data,
    time_unit: Option<TimeUnit>,
}

impl Leaf {
    /// The readable leaves of the schema. The width of a list is that of the first row.
    pub(super) fn all(file: &dyn FileReader, input: &Input<'_>) -> Result<Vec<Self>, ReadError> {
        let schema = file.metadata().file_metadata().schema_descr_ptr();
        let mut leaves = Vec::new();
        for (index, column) in schema.columns().iter().enumerate() {
            // Images and other nested lists are no states.
            if column.max_rep_level() > 1 {
                continue;
            }
            let mut leaf = Self::new(index, column);
            if leaf.list {
                match leaf.width_of_first(file, input)? {
                    Some(width) if width <= MOST_CHANNELS => leaf.width = width,
                    _ => continue,
                }
            }
            leaves.push(leaf);
        }
        Ok(leaves)
    }

    fn new(index: usize, column: &ColumnDescriptor) -> Self {
        let list = column.max_rep_level() == 1;
        let parts = column.path().parts();
        // The path of a list ends with its writer's name for elements: list.element, bag.array_element, item.
        let name = if list { parts.first().cloned().unwrap_or_default() } else { parts.join(".") };
        let logical = column.logical_type_ref();
        let half = matches!(logical, Some(LogicalType::Float16));
        let physical = column.physical_type();
        Self {
            name,
            index,
            width: 1,
            list,
            text: matches!(physical, Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY) && !half,
            whole: matches!(physical, Type::INT32 | Type::INT64 | Type::BOOLEAN),
            most_defined: column.max_def_level(),
            time_unit: time_unit(column),
            half,
            float: match physical {
                Type::FLOAT => Some(4),
                Type::DOUBLE => Some(8),
                _ => None,
            },
        }
    }

    fn width_of_first(&self, file: &dyn FileReader, input: &Input<'_>) -> Result<Option<usize>, ReadError> {
        for group in 0..file.num_row_groups() {
            let reader = file.get_row_group(group).map_err(|error| failed(&error, input))?;
            if reader.metadata().num_rows() > 0 {
                descriptions::check_pages(reader.metadata().column(self.index), input)?;
                let (_, starts) = self.entries(&*reader, 1, input)?;
                return Ok(starts.get(1).copied().filter(|&width| width > 0));
            }
        }
        Ok(None)
    }

    /// The values of `rows` rows.
    pub(super) fn read(&self, group: &dyn RowGroupReader, rows: usize, input: &Input<'_>) -> Result<Values, ReadError> {
        input.charge((rows as u64).saturating_mul(8 * self.width as u64))?;
        descriptions::check_pages(group.metadata().column(self.index), input)?;
        self.refuse_damaged_dictionary(group, input)?;
        let (data, starts) = self.entries(group, rows, input)?;
        let even = starts.iter().enumerate().all(|(row, &start)| start == row * self.width);
        if starts.len() != rows + 1 || !even {
            let what = format!("'{}' holds lists of different lengths, or too few", self.name);
            let place = format!("{}, column '{}'", input.name, self.name);
            let remedy = "--state with columns of numbers or lists of one length";
            return Err(ReadError::Ragged(Fault::new(what, place, remedy)));
        }
        Ok(Values { data, time_unit: self.time_unit })
    }

    /// Refuses a dictionary with a repeated value. Pages seldom have checksums, but a dictionary holds each value once,
    /// so a repeated value means that bytes were overwritten. Otherwise samples would be wrong without notice.
    fn refuse_damaged_dictionary(&self, group: &dyn RowGroupReader, input: &Input<'_>) -> Result<(), ReadError> {
        let Some(size) = self.float else { return Ok(()) };
        let failed = |error| failed(&error, input);
        let mut pages = group.get_column_page_reader(self.index).map_err(failed)?;
        if let Some(Page::DictionaryPage { buf, .. }) = pages.get_next_page().map_err(failed)? {
            let mut values: Vec<&[u8]> = buf.chunks_exact(size).collect();
            values.sort_unstable();
            if values.windows(2).any(|pair| pair[0] == pair[1]) {
                let place = format!("{}, column '{}'", input.name, self.name);
                return Err(damaged("a dictionary holds a value twice", &place));
            }
        }
        Ok(())
    }

    /// Values of the first `rows` rows, and the index at which each row begins; the last index is the number of values.
    fn entries(
        &self,
        group: &dyn RowGroupReader,
        rows: usize,
        input: &Input<'_>,
    ) -> Result<(Data, Vec<usize>), ReadError> {
        let reader = group.get_column_reader(self.index).map_err(|error| failed(&error, input))?;
        let missing = f64::NAN;
        let half = |bytes: &[u8]| bytes.try_into().map_or(missing, |bytes| npy::half(u16::from_le_bytes(bytes)));
        let read = match reader {
            ColumnReader::DoubleColumnReader(reader) => {
                self.filled(reader, rows, |value| *value, missing, Data::Numbers)
            }
            ColumnReader::FloatColumnReader(reader) => {
                self.filled(reader, rows, |value| f64::from(*value), missing, Data::Numbers)
            }
            ColumnReader::Int64ColumnReader(reader) => self.filled(reader, rows, |value| Some(*value), None, whole),
            ColumnReader::Int32ColumnReader(reader) => {
                self.filled(reader, rows, |value| Some(i64::from(*value)), None, whole)
            }
            ColumnReader::BoolColumnReader(reader) => {
                self.filled(reader, rows, |value| Some(i64::from(*value)), None, whole)
            }
            ColumnReader::Int96ColumnReader(reader) => {
                self.filled(reader, rows, |value| Some(value.to_nanos()), None, whole)
            }
            ColumnReader::ByteArrayColumnReader(reader) => {
                self.filled(reader, rows, |value| text(value.data()), String::new(), Data::Text)
            }
            ColumnReader::FixedLenByteArrayColumnReader(reader) if self.half => {
                self.filled(reader, rows, |value| half(value.data()), missing, Data::Numbers)
            }
            ColumnReader::FixedLenByteArrayColumnReader(reader) => {
                self.filled(reader, rows, |value| text(value.data()), String::new(), Data::Text)
            }
        };
        read.map_err(|error| failed(&error, input))
    }

    /// Values with missing ones filled in; reading stops at the first error or at the end.
    fn filled<T: DataType, V: Clone>(
        &self,
        mut reader: ColumnReaderImpl<T>,
        rows: usize,
        convert: impl Fn(&T::T) -> V,
        missing: V,
        data: impl FnOnce(Vec<V>) -> Data,
    ) -> parquet::errors::Result<(Data, Vec<usize>)> {
        let mut filled: Vec<V> = Vec::new();
        let mut starts: Vec<usize> = Vec::new();
        let (mut values, mut defined, mut repeated) = (Vec::new(), Vec::new(), Vec::new());
        let mut left = rows;
        while left > 0 {
            values.clear();
            defined.clear();
            repeated.clear();
            let (records, ..) =
                reader.read_records(left.min(BATCH), Some(&mut defined), Some(&mut repeated), &mut values)?;
            if records == 0 {
                break;
            }
            left -= records.min(left);
            let mut next = values.iter();
            let entries = if self.most_defined == 0 { values.len() } else { defined.len() };
            for entry in 0..entries {
                if repeated.get(entry).is_none_or(|&level| level == 0) {
                    starts.push(filled.len());
                }
                let level = defined.get(entry).copied().unwrap_or(self.most_defined);
                if level == self.most_defined {
                    filled.extend(next.next().map(&convert));
                } else if !self.list || level + 1 == self.most_defined {
                    filled.push(missing.clone());
                }
            }
        }
        starts.push(filled.len());
        Ok((data(filled), starts))
    }
}

/// Number of records to read at once.
const BATCH: usize = 4096;

/// Integers; if one is missing, they become f64, which has NaN.
fn whole(values: Vec<Option<i64>>) -> Data {
    match values.iter().copied().collect::<Option<Vec<i64>>>() {
        Some(values) => Data::Whole(values),
        None => Data::Numbers(values.into_iter().map(|value| value.map_or(f64::NAN, |value| value as f64)).collect()),
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn time_unit(column: &ColumnDescriptor) -> Option<TimeUnit> {
    if column.physical_type() == Type::INT96 {
        return Some(TimeUnit::Nanoseconds);
    }
    let unit = match column.logical_type_ref() {
        Some(LogicalType::Timestamp(stamp)) => stamp.unit,
        Some(LogicalType::Time(time)) => time.unit,
        _ => return None,
    };
    Some(match unit {
        basic::TimeUnit::MILLIS => TimeUnit::Milliseconds,
        basic::TimeUnit::MICROS => TimeUnit::Microseconds,
        basic::TimeUnit::NANOS => TimeUnit::Nanoseconds,
    })
}

impl Values {
    pub(super) fn number(&self, at: usize) -> Result<f64, String> {
        match &self.data {
            Data::Numbers(numbers) => Ok(numbers[at]),
            Data::Whole(whole) | Data::Dates(whole, _) => Ok(whole[at] as f64),
            Data::Text(texts) if texts[at].is_empty() => Ok(f64::NAN),
            Data::Text(texts) => texts[at].parse().map_err(|_| texts[at].clone()),
        }
    }

    pub(super) fn stamp(&self, at: usize) -> Result<(Stamp, Option<TimeUnit>), String> {
        match &self.data {
            Data::Text(texts) => Stamp::text(&texts[at]).ok_or_else(|| texts[at].clone()),
            data => Ok((data.stamp(at).0, self.time_unit)),
        }
    }

    pub(super) fn label(&self, at: usize) -> String {
        self.data.label(at)
    }
}
