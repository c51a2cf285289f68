use std::collections::BTreeMap;

use super::format::opcode;
use crate::rows::packed::{Misfit, Reader};

/// The records of a bag that are read.
#[derive(Debug, PartialEq)]
pub(super) enum Record<'a> {
    Schema {
        id: u16,
        name: &'a str,
    },
    Channel {
        id: u16,
        schema: u16,
        topic: &'a str,
        encoding: &'a str,
    },
    Message {
        channel: u16,
        /// Nanoseconds since 1970.
        log_time: u64,
        data: &'a [u8],
    },
    Metadata {
        name: &'a str,
        entries: BTreeMap<String, String>,
    },
}

impl<'a> Record<'a> {
    /// Whether records of this kind are read.
    pub(super) fn is_read(kind: u8) -> bool {
        matches!(kind, opcode::SCHEMA | opcode::CHANNEL | opcode::MESSAGE | opcode::METADATA)
    }

    /// Parses a record of a kind that is read.
    pub(super) fn parse(kind: u8, content: &'a [u8]) -> Result<Self, Misfit> {
        let mut fields = Reader::of_record(content);
        Ok(match kind {
            opcode::SCHEMA => Record::Schema { id: fields.u16()?, name: fields.text()? },
            opcode::CHANNEL => Record::Channel {
                id: fields.u16()?,
                schema: fields.u16()?,
                topic: fields.text()?,
                encoding: fields.text()?,
            },
            opcode::MESSAGE => {
                let channel = fields.u16()?;
                let _sequence = fields.u32()?;
                let log_time = fields.u64()?;
                let _published = fields.u64()?;
                Record::Message { channel, log_time, data: fields.rest() }
            }
            opcode::METADATA => Record::Metadata { name: fields.text()?, entries: fields.map()? },
            _ => return Err(Misfit),
        })
    }
}
