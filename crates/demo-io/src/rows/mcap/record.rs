use std::collections::BTreeMap;

use super::fields::{Fields, Misfit};
use super::format::opcode;

/// The kinds of records that are of use here.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Schema,
    Channel,
    Message,
    Metadata,
}

impl Kind {
    pub(super) fn of(opcode: u8) -> Option<Kind> {
        match opcode {
            opcode::SCHEMA => Some(Kind::Schema),
            opcode::CHANNEL => Some(Kind::Channel),
            opcode::MESSAGE => Some(Kind::Message),
            opcode::METADATA => Some(Kind::Metadata),
            _ => None,
        }
    }
}

/// What of a bag is of use here.
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
    pub(super) fn parse(kind: Kind, content: &'a [u8]) -> Result<Self, Misfit> {
        let mut fields = Fields::new(content);
        Ok(match kind {
            Kind::Schema => Record::Schema { id: fields.u16()?, name: fields.text()? },
            Kind::Channel => Record::Channel {
                id: fields.u16()?,
                schema: fields.u16()?,
                topic: fields.text()?,
                encoding: fields.text()?,
            },
            Kind::Message => {
                let channel = fields.u16()?;
                let _sequence = fields.u32()?;
                let log_time = fields.u64()?;
                let _published = fields.u64()?;
                Record::Message { channel, log_time, data: fields.rest() }
            }
            Kind::Metadata => Record::Metadata { name: fields.text()?, entries: fields.map()? },
        })
    }
}
