use hdf5_pure::{Chunk, DType, Dataset, Error, File, FormatError, Group};

use crate::arrays::array::{ArraySpec, Data, Kind};
use crate::input::Input;
use crate::{Fault, ReadError};

/// The arrays of a file found so far.
pub(super) struct Tree<'a> {
    pub(super) input: &'a Input<'a>,
    arrays: Vec<(ArraySpec, Dataset)>,
}

impl<'a> Tree<'a> {
    pub(super) fn new(input: &'a Input<'a>) -> Self {
        Self { input, arrays: Vec::new() }
    }

    pub(super) fn ok<T>(&self, result: Result<T, Error>) -> Result<T, ReadError> {
        result.map_err(|error| failed(&error, self.input))
    }

    pub(super) fn described(&self) -> Vec<ArraySpec> {
        self.arrays.iter().map(|(described, _)| described.clone()).collect()
    }

    /// The arrays of a group, with `prefix` before their names, and their indices.
    pub(super) fn arrays(&mut self, group: &Group, prefix: &str) -> Result<Vec<(String, usize)>, ReadError> {
        let mut found = Vec::new();
        for name in self.ok(group.datasets())? {
            let dataset = self.ok(group.dataset(&name))?;
            let shape: Option<Vec<usize>> =
                self.ok(dataset.shape())?.into_iter().map(|length| usize::try_from(length).ok()).collect();
            let (Some(shape), Ok(kind)) = (shape, dataset.dtype().map(kind)) else { continue };
            let name = format!("{prefix}{name}");
            self.arrays.push((ArraySpec { name: name.clone(), shape, kind }, dataset));
            found.push((name, self.arrays.len() - 1));
        }
        Ok(found)
    }

    pub(super) fn load(&self, index: usize) -> Result<Data, ReadError> {
        let (described, dataset) = &self.arrays[index];
        let count = described.shape.iter().try_fold(1u64, |count, &length| count.checked_mul(length as u64));
        let size = self.ok(dataset.element_size())?.max(8);
        self.input.charge(count.and_then(|count| count.checked_mul(size)).unwrap_or(u64::MAX))?;
        self.require_whole_chunks(described, dataset)?;
        let data = match &described.kind {
            Kind::Text => dataset.read_string().map(Data::Text),
            Kind::Number("float16") => dataset.read_raw().map(|bytes| Data::Numbers(halves(&bytes, dataset))),
            Kind::Number("uint64" | "float32" | "float64") => dataset.read_f64().map(Data::Numbers),
            Kind::Number(_) => dataset.read_i64().map(Data::Whole),
            _ => return Ok(Data::Text(Vec::new())),
        };
        let data = self.ok(data)?;
        if Some(data.len() as u64) == count {
            return Ok(data);
        }
        let what = format!("'{}' holds {} values", described.with_shape(), data.len());
        Err(ReadError::corrupt(what, &self.input.name))
    }

    /// Requires that all chunks lie within the file, because the reader allocates memory for a chunk before it looks
    /// for it.
    fn require_whole_chunks(&self, described: &ArraySpec, dataset: &Dataset) -> Result<(), ReadError> {
        let outside =
            |chunk: &Chunk| chunk.address.checked_add(chunk.storage_size).is_none_or(|end| end > self.input.len);
        // The reader checks chunks with the one kind of index that cannot be listed, one by one.
        if dataset.is_chunked() && dataset.chunks().is_ok_and(|chunks| chunks.iter().any(outside)) {
            let what = format!("'{}' has a part beyond the end of the file", described.with_shape());
            return Err(ReadError::corrupt(what, &self.input.name));
        }
        Ok(())
    }
}

fn halves(bytes: &[u8], dataset: &Dataset) -> Vec<f64> {
    use hdf5_pure::{Datatype, DatatypeByteOrder};
    let big =
        matches!(dataset.datatype(), Ok(Datatype::FloatingPoint { byte_order: DatatypeByteOrder::BigEndian, .. }));
    let half = |pair: &[u8]| {
        let pair = [pair[0], pair[1]];
        crate::arrays::npy::half(if big { u16::from_be_bytes(pair) } else { u16::from_le_bytes(pair) })
    };
    bytes.chunks_exact(2).map(half).collect()
}

fn kind(kind: DType) -> Kind {
    match kind {
        DType::F32 => Kind::Number("float32"),
        DType::F64 => Kind::Number("float64"),
        DType::I8 => Kind::Number("int8"),
        DType::I16 => Kind::Number("int16"),
        DType::I32 => Kind::Number("int32"),
        DType::I64 => Kind::Number("int64"),
        DType::U8 => Kind::Number("uint8"),
        DType::U16 => Kind::Number("uint16"),
        DType::U32 => Kind::Number("uint32"),
        DType::U64 => Kind::Number("uint64"),
        DType::String | DType::VariableLengthString => Kind::Text,
        DType::Other(other) if matches!(*other, hdf5_pure::Datatype::FloatingPoint { size: 2, .. }) => {
            Kind::Number("float16")
        }
        other => Kind::Other(other.to_string()),
    }
}

/// The demonstrations that `/mask/<filter>` names.
pub(super) fn mask(file: &File, filter: &str, input: &Input<'_>) -> Result<Vec<String>, ReadError> {
    let masks = file.group("mask").map_err(|_| super::no_mask(filter, &[], &input.name))?;
    let known = masks.datasets().map_err(|error| failed(&error, input))?;
    if !known.iter().any(|name| name == filter) {
        return Err(super::no_mask(filter, &known, &input.name));
    }
    let names = masks.dataset(filter).and_then(|mask| mask.read_string()).map_err(|error| failed(&error, input))?;
    Ok(names.into_iter().map(|name| name.trim_end_matches('\0').to_owned()).collect())
}

pub(super) fn failed(error: &Error, input: &Input<'_>) -> ReadError {
    let file = &input.name;
    match error {
        Error::Format(FormatError::UnexpectedEof { .. }) => {
            ReadError::truncated(format!("the file is cut off: {error}"), file)
        }
        Error::Io(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            ReadError::truncated("the file is cut off", file)
        }
        Error::Io(error) => crate::input::unreadable(error, file),
        Error::Format(FormatError::SignatureNotFound) => {
            let what = "not an HDF5 file: its signature is missing";
            ReadError::NotThisFormat(Fault::new(what, file, "--as with the format it has"))
        }
        _ => {
            let text = error.to_string();
            let remedy = "h5repack -j 1 -k 2 -f GZIP=4 IN OUT, or another copy of the file";
            let fault = |kind: &str| Fault::new(format!("the file is {kind}: {text}"), file, remedy);
            if text.contains("nsupported") || text.contains("version") {
                ReadError::Unsupported(fault("of a kind of HDF5 that is not read"))
            } else {
                ReadError::Corrupt(fault("damaged, or of a kind that is not read"))
            }
        }
    }
}
