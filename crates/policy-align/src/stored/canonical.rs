use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use serde_json::Value;
use sha2::{Digest as _, Sha256};

/// SHA-256, hexadecimal, of the canonical text of a value: no white space, object members sorted by name, numbers as
/// serde_json writes them. It does not depend on white space and order in a file, but on everything else.
pub(crate) fn checksum(value: &Value) -> String {
    let mut text = String::new();
    write(value, &mut text);
    sha256(text.as_bytes())
}

/// SHA-256 of bytes, hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// SHA-256 of a file's contents and their size in bytes; the file is read in pieces.
///
/// # Errors
/// The system's error.
pub fn sha256_of_file(path: &Path) -> io::Result<(String, u64)> {
    let (mut file, mut hasher, mut bytes) = (File::open(path)?, Sha256::new(), 0);
    let mut piece = vec![0; 1 << 16];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok((hexadecimal(&hasher.finalize()), bytes)),
            count => {
                hasher.update(&piece[..count]);
                bytes += count as u64;
            }
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().concat()
}

fn write(value: &Value, text: &mut String) {
    match value {
        Value::Array(elements) => {
            text.push('[');
            for element in elements {
                write(element, text);
                text.push(',');
            }
            text.push(']');
        }
        Value::Object(members) => {
            let mut members: Vec<_> = members.iter().collect();
            // serde_json keeps the order of the file if any crate of the program enables that.
            members.sort_by_key(|(name, _)| *name);
            text.push('{');
            for (name, member) in members {
                text.push_str(&Value::from(name.as_str()).to_string());
                text.push(':');
                write(member, text);
                text.push(',');
            }
            text.push('}');
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => text.push_str(&value.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksum_ignores_only_order_and_whitespace() {
        let checksum_of = |text: &str| checksum(&serde_json::from_str(text).unwrap());
        let one = checksum_of(r#"{"a": [1.5, null], "b": "é"}"#);
        assert_eq!(one, checksum_of("{\"b\":\"\\u00e9\",\n\"a\":[1.5,null]}"));
        for other in [r#"{"a":[1.5],"b":"é"}"#, r#"{"a":[1.25,null],"b":"é"}"#, r#"{"a":[1.5,null],"c":"é"}"#] {
            assert_ne!(one, checksum_of(other));
        }
        assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        let (path, bytes) = (tempfile::NamedTempFile::new().unwrap().into_temp_path(), vec![7; 200_001]);
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(sha256_of_file(&path).unwrap(), (sha256(&bytes), 200_001));
    }
}
