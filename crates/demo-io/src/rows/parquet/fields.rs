//! What the fields of a Parquet file's descriptions hold, by their numbers (parquet.thrift of the format, version 2.12).

use self::Holds::{Byte, Bytes, Double, Integer, List, Truth};

/// What a field holds.
pub(super) enum Holds {
    Truth,
    Byte,
    /// Of two, four or eight bytes: they are written alike.
    Integer,
    /// An integer that is remembered.
    Size(Size),
    Double,
    Bytes,
    List(&'static Holds),
    Fields(&'static Fields),
}

/// Sizes of a page.
#[derive(Clone, Copy)]
pub(super) enum Size {
    /// Bytes when decompressed.
    Whole,
    /// Bytes after the description.
    InFile,
    /// Values of a dictionary.
    Values,
}

/// Fields of a structure. What is not listed is skipped by every reader.
pub(super) type Fields = [(i16, Holds)];

/// `FileMetaData`
pub(super) const FILE: &Fields = &[
    (1, Integer),
    (2, List(&Holds::Fields(SCHEMA_ELEMENT))),
    (3, Integer),
    (4, List(&Holds::Fields(ROW_GROUP))),
    (5, List(&Holds::Fields(KEY_VALUE))),
    (6, Bytes),
    (7, List(&Holds::Fields(UNION))),
    (8, Holds::Fields(UNION)),
    (9, Bytes),
];

/// `PageHeader`
pub(super) const PAGE: &Fields = &[
    (1, Integer),
    (2, Holds::Size(Size::Whole)),
    (3, Holds::Size(Size::InFile)),
    (4, Integer),
    (5, Holds::Fields(&[(1, Integer), (2, Integer), (3, Integer), (4, Integer), (5, Holds::Fields(STATISTICS))])),
    (6, Holds::Fields(&[])),
    (7, Holds::Fields(&[(1, Holds::Size(Size::Values)), (2, Integer), (3, Truth)])),
    (
        8,
        Holds::Fields(&[
            (1, Integer),
            (2, Integer),
            (3, Integer),
            (4, Integer),
            (5, Integer),
            (6, Integer),
            (7, Truth),
            (8, Holds::Fields(STATISTICS)),
        ]),
    ),
];

const SCHEMA_ELEMENT: &Fields = &[
    (1, Integer),
    (2, Integer),
    (3, Integer),
    (4, Bytes),
    (5, Integer),
    (6, Integer),
    (7, Integer),
    (8, Integer),
    (9, Integer),
    (10, Holds::Fields(LOGICAL_TYPE)),
];

const LOGICAL_TYPE: &Fields = &[
    (1, Holds::Fields(&[])),
    (2, Holds::Fields(&[])),
    (3, Holds::Fields(&[])),
    (4, Holds::Fields(&[])),
    (5, Holds::Fields(&[(1, Integer), (2, Integer)])),
    (6, Holds::Fields(&[])),
    (7, Holds::Fields(&[(1, Truth), (2, Holds::Fields(UNION))])),
    (8, Holds::Fields(&[(1, Truth), (2, Holds::Fields(UNION))])),
    (10, Holds::Fields(&[(1, Byte), (2, Truth)])),
    (11, Holds::Fields(&[])),
    (12, Holds::Fields(&[])),
    (13, Holds::Fields(&[])),
    (14, Holds::Fields(&[])),
    (15, Holds::Fields(&[])),
    (16, Holds::Fields(&[(1, Byte)])),
    (17, Holds::Fields(&[(1, Bytes)])),
    (18, Holds::Fields(&[(1, Bytes), (2, Integer)])),
];

/// One of several, each without fields that matter here: orders of columns, units of time, encryptions.
const UNION: &Fields = &[(1, Holds::Fields(&[])), (2, Holds::Fields(&[])), (3, Holds::Fields(&[]))];

const ROW_GROUP: &Fields = &[
    (1, List(&Holds::Fields(COLUMN_CHUNK))),
    (2, Integer),
    (3, Integer),
    (4, List(&Holds::Fields(&[(1, Integer), (2, Truth), (3, Truth)]))),
    (5, Integer),
    (6, Integer),
    (7, Integer),
];

const COLUMN_CHUNK: &Fields = &[
    (1, Bytes),
    (2, Integer),
    (3, Holds::Fields(COLUMN)),
    (4, Integer),
    (5, Integer),
    (6, Integer),
    (7, Integer),
    (8, Holds::Fields(UNION)),
    (9, Bytes),
];

/// `ColumnMetaData`
const COLUMN: &Fields = &[
    (1, Integer),
    (2, List(&Integer)),
    (3, List(&Bytes)),
    (4, Integer),
    (5, Integer),
    (6, Integer),
    (7, Integer),
    (8, List(&Holds::Fields(KEY_VALUE))),
    (9, Integer),
    (10, Integer),
    (11, Integer),
    (12, Holds::Fields(STATISTICS)),
    (13, List(&Holds::Fields(&[(1, Integer), (2, Integer), (3, Integer)]))),
    (14, Integer),
    (15, Integer),
    (16, Holds::Fields(&[(1, Integer), (2, List(&Integer)), (3, List(&Integer))])),
    (17, Holds::Fields(&[(1, Holds::Fields(BOX)), (2, List(&Integer))])),
];

const KEY_VALUE: &Fields = &[(1, Bytes), (2, Bytes)];

const STATISTICS: &Fields =
    &[(1, Bytes), (2, Bytes), (3, Integer), (4, Integer), (5, Bytes), (6, Bytes), (7, Truth), (8, Truth), (9, Integer)];

const BOX: &Fields =
    &[(1, Double), (2, Double), (3, Double), (4, Double), (5, Double), (6, Double), (7, Double), (8, Double)];
