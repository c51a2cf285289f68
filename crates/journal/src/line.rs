//! One line: a record as JSON, preceded by the SHA-256 of its text, which reveals changes.

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest as _, Sha256};

/// The line of a record, including its line end.
pub(crate) fn of(record: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    let json = serde_json::to_vec(record)?;
    Ok([checksum(&json).as_bytes(), b" ", &json, b"\n"].concat())
}

/// The record of a line without its line end; `None` if it is torn, changed, or a record of another form.
pub(crate) fn read<T: DeserializeOwned>(line: &[u8]) -> Option<T> {
    let space = line.iter().position(|&byte| byte == b' ')?;
    let (written, json) = (&line[..space], &line[space + 1..]);
    if written == checksum(json).as_bytes() { serde_json::from_slice(json).ok() } else { None }
}

fn checksum(json: &[u8]) -> String {
    Sha256::digest(json).iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().concat()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// After changing, removing or adding a byte, reading returns the written record or nothing.
        #[test]
        fn a_changed_line_never_reads_as_another_record(
            record in (any::<f64>().prop_filter("JSON has no others", |value| value.is_finite()), ".*"),
            at in any::<prop::sample::Index>(),
            byte in any::<u8>(),
            kind in 0..3,
        ) {
            let mut line = of(&record).expect("JSON");
            prop_assert_eq!(line.pop(), Some(b'\n'));
            prop_assert!(!line.contains(&b'\n'));
            prop_assert_eq!(read(&line), Some(record.clone()));
            let at = at.index(line.len());
            match kind {
                0 => line[at] = byte,
                1 => drop(line.remove(at)),
                _ => line.insert(at, byte),
            }
            prop_assert!(read::<(f64, String)>(&line).is_none_or(|read| read == record));
        }
    }

    #[test]
    fn every_changed_digit_is_rejected() {
        let line = of(&0.0123456789).expect("JSON");
        for at in (0..line.len()).filter(|&at| line[at].is_ascii_digit()) {
            let mut changed = line.clone();
            changed[at] = b'0' + (line[at] - b'0' + 1) % 10;
            assert_eq!(read::<f64>(&changed), None, "{}", String::from_utf8_lossy(&changed));
        }
    }

    #[test]
    fn lines_without_a_valid_checksum_are_rejected() {
        let wrong = format!("{} 1.0", checksum(b"2.0"));
        for line in ["1.0", " 1.0", &wrong, "", " ", "null", "\0"] {
            assert_eq!(read::<f64>(line.as_bytes()), None, "{line}");
        }
    }
}
