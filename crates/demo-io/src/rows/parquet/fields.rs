//! Types of the fields in a Parquet file's metadata, in the order of their numbers, which count from 1 (parquet.thrift of the
//! format, version 2.12).

use self::Holds::{Any, Byte, Bytes, Double, Integer, List, Truth};

/// Type of a field.
pub(super) enum Holds {
    /// The number is not used.
    Any,
    Truth,
    Byte,
    /// An integer of two, four or eight bytes; all have the same encoding.
    Integer,
    /// An integer whose value is kept.
    Size(Size),
    Double,
    Bytes,
    List(&'static Holds),
    Fields(&'static Fields),
}

/// Sizes of a page.
#[derive(Clone, Copy)]
pub(super) enum Size {
    /// Uncompressed size in bytes.
    Whole,
    /// Size in bytes after the header.
    InFile,
    /// Number of values of a dictionary.
    Values,
}

/// Fields of a structure. Every reader skips fields that are not listed.
pub(super) type Fields = [Holds];

/// `FileMetaData`
pub(super) const FILE: &Fields = &[
    Integer,
    List(&Holds::Fields(SCHEMA_ELEMENT)),
    Integer,
    List(&Holds::Fields(ROW_GROUP)),
    List(&Holds::Fields(KEY_VALUE)),
    Bytes,
    List(&UNION),
    UNION,
    Bytes,
];

/// `PageHeader`
pub(super) const PAGE: &Fields = &[
    Integer,
    Holds::Size(Size::Whole),
    Holds::Size(Size::InFile),
    Integer,
    Holds::Fields(&[Integer, Integer, Integer, Integer, Holds::Fields(STATISTICS)]),
    EMPTY,
    Holds::Fields(&[Holds::Size(Size::Values), Integer, Truth]),
    Holds::Fields(&[Integer, Integer, Integer, Integer, Integer, Integer, Truth, Holds::Fields(STATISTICS)]),
];

const SCHEMA_ELEMENT: &Fields =
    &[Integer, Integer, Integer, Bytes, Integer, Integer, Integer, Integer, Integer, Holds::Fields(LOGICAL_TYPE)];

const LOGICAL_TYPE: &Fields = &[
    EMPTY,
    EMPTY,
    EMPTY,
    EMPTY,
    Holds::Fields(&[Integer, Integer]),
    EMPTY,
    Holds::Fields(&[Truth, UNION]),
    Holds::Fields(&[Truth, UNION]),
    Any,
    Holds::Fields(&[Byte, Truth]),
    EMPTY,
    EMPTY,
    EMPTY,
    EMPTY,
    EMPTY,
    Holds::Fields(&[Byte]),
    Holds::Fields(&[Bytes]),
    Holds::Fields(&[Bytes, Integer]),
];

/// A structure without relevant fields.
const EMPTY: Holds = Holds::Fields(&[]);

/// A union of structures without relevant fields: column orders, time units, encryptions.
const UNION: Holds = Holds::Fields(&[EMPTY, EMPTY, EMPTY]);

const ROW_GROUP: &Fields = &[
    List(&Holds::Fields(COLUMN_CHUNK)),
    Integer,
    Integer,
    List(&Holds::Fields(&[Integer, Truth, Truth])),
    Integer,
    Integer,
    Integer,
];

const COLUMN_CHUNK: &Fields =
    &[Bytes, Integer, Holds::Fields(COLUMN), Integer, Integer, Integer, Integer, UNION, Bytes];

/// `ColumnMetaData`
const COLUMN: &Fields = &[
    Integer,
    List(&Integer),
    List(&Bytes),
    Integer,
    Integer,
    Integer,
    Integer,
    List(&Holds::Fields(KEY_VALUE)),
    Integer,
    Integer,
    Integer,
    Holds::Fields(STATISTICS),
    List(&Holds::Fields(&[Integer, Integer, Integer])),
    Integer,
    Integer,
    Holds::Fields(&[Integer, List(&Integer), List(&Integer)]),
    Holds::Fields(&[Holds::Fields(BOX), List(&Integer)]),
];

const KEY_VALUE: &Fields = &[Bytes, Bytes];

const STATISTICS: &Fields = &[Bytes, Bytes, Integer, Integer, Bytes, Bytes, Truth, Truth, Integer];

const BOX: &Fields = &[Double, Double, Double, Double, Double, Double, Double, Double];
