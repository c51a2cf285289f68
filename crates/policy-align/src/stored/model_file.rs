//! Models as JSON with a checksum, described in `docs/model-file.md`.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::canonical::checksum;
use super::error::ModelError;
use super::whole_file::write_whole;
use crate::model_policy::BEYOND;
use crate::{Model, StateChannel, Verdict};

const FORMAT: &str = "policy-align model";

/// The latest version; it and all earlier ones can be read. Models without context are written as version 1.
const VERSION: u64 = 2;

/// Header of a model file.
#[derive(Serialize)]
struct Stored<'a> {
    format: &'static str,
    version: u64,
    checksum: String,
    #[serde(flatten)]
    model: &'a Model,
}

/// The checksum stored in a model file; a trust report refers to its model by it.
pub fn checksum_of(model_file: &[u8]) -> Option<String> {
    #[derive(Deserialize)]
    struct Named {
        checksum: String,
    }
    serde_json::from_slice(model_file).ok().map(|named: Named| named.checksum)
}

impl Model {
    /// Largest size of a file in bytes.
    pub const LARGEST: u64 = 256 << 20;

    /// The text of a model file: one JSON document, with all digits of the numbers.
    ///
    /// # Errors
    /// [`ModelError::Unwritable`] if it could not be read back, for instance because a number is not finite.
    pub fn to_json(&self) -> Result<String, ModelError> {
        let unwritable = |path: &str, reason: String| ModelError::Unwritable { path: path.to_owned(), reason };
        let version = if self.context.is_empty() { 1 } else { VERSION };
        let stored = |checksum| Stored { format: FORMAT, version, checksum, model: self };
        let value = serde_json::to_value(stored(String::new())).map_err(|e| unwritable("model", e.to_string()))?;
        let checksum = checksum(&without_checksum(value.as_object().cloned().unwrap_or_default()));
        let text = serde_json::to_string(&stored(checksum)).map_err(|e| unwritable("model", e.to_string()))? + "\n";
        match Model::from_json(text.as_bytes()) {
            Ok(_) => Ok(text),
            Err(ModelError::Member { path, reason, .. }) => Err(ModelError::Unwritable { path, reason }),
            Err(error) => Err(unwritable("model", error.to_string())),
        }
    }

    /// Reads a model from the bytes of a file. Its predictions are the same to the last bit as before it was stored.
    ///
    /// # Errors
    /// [`ModelError`], with the place of the fault.
    pub fn from_json(bytes: &[u8]) -> Result<Model, ModelError> {
        if bytes.iter().find(|byte| !byte.is_ascii_whitespace()) != Some(&b'{') {
            return Err(ModelError::NotAModel { found: "the file is no JSON object".to_owned() });
        }
        let mut members: Map<String, Value> =
            serde_json::from_slice(bytes).map_err(|error| ModelError::NotJson { reason: error.to_string() })?;
        check_format(&members)?;
        let expected = without_checksum(members.clone());
        let changed = members.get("checksum").and_then(Value::as_str) != Some(checksum(&expected).as_str());
        let member = |path: &str, reason: String| ModelError::Member { path: path.to_owned(), reason, changed };
        if !members.get("checksum").is_some_and(Value::is_string) {
            return Err(member("checksum", "missing, or not a text".to_owned()));
        }
        for envelope in ["format", "version", "checksum"] {
            members.remove(envelope);
        }
        let model: Model = serde_path_to_error::deserialize(Value::Object(members))
            .map_err(|error| member(&one_line(&error.path().to_string()), one_line(&error.inner().to_string())))?;
        if changed {
            return Err(ModelError::Checksum);
        }
        match model.fault() {
            None => Ok(model),
            Some((path, reason)) => Err(member(&path, reason)),
        }
    }

    /// Writes a model file completely or not at all.
    ///
    /// # Errors
    /// As [`Model::to_json`], and [`ModelError::File`].
    pub fn save(&self, path: &Path) -> Result<(), ModelError> {
        Ok(write_whole(path, self.to_json()?.as_bytes())?)
    }

    /// Reads a model file.
    ///
    /// # Errors
    /// As [`Model::from_json`], and [`ModelError::File`].
    pub fn load(path: &Path) -> Result<Model, ModelError> {
        Model::from_json(&demo_io::read_bytes(path, Self::LARGEST)?)
    }

    /// An inconsistency of the model, with its place.
    fn fault(&self) -> Option<(String, String)> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let n = self.learnt.policy().dim();
        if self.state.is_empty() || self.inputs().count() != n {
            return Some(("state".to_owned(), format!("{} channels for a policy of {n}", self.inputs().count())));
        }
        if !positive(self.time_step) {
            return Some(("time_step".to_owned(), format!("{} is not a positive time", self.time_step)));
        }
        let not_negative = |number: f64| number >= 0.0 && number.is_finite();
        if !(positive(self.data.longest) && not_negative(self.data.speed)) {
            return Some(("data".to_owned(), "the duration must be positive and the speed not negative".to_owned()));
        }
        let (stored, worst) = (self.trust.verdict, Verdict::worst(&self.trust.findings));
        if stored != worst {
            let reason = format!("it is {}, but the worst of the findings is {}", word(stored), word(worst));
            return Some(("trust.verdict".to_owned(), reason));
        }
        let sound = |channel: &StateChannel| {
            let width = (1.0 + 2.0 * BEYOND) * (channel.high - channel.low);
            positive(channel.scale)
                && width.is_finite()
                && channel.low <= channel.median
                && channel.median <= channel.high
        };
        let at = self.inputs().position(|channel| !sound(channel))?;
        let n = self.state.len();
        Some((
            if at < n { format!("state[{at}]") } else { format!("context[{}]", at - n) },
            "the scale must be positive, and low, median and high finite and in order".to_owned(),
        ))
    }
}

fn check_format(members: &Map<String, Value>) -> Result<(), ModelError> {
    let found = members.get("format").map_or_else(
        || "`format` is missing".to_owned(),
        |found| format!("`format` is {}", one_line(&found.to_string())),
    );
    if members.get("format").and_then(Value::as_str) != Some(FORMAT) {
        return Err(ModelError::NotAModel { found });
    }
    let version = members.get("version").and_then(Value::as_u64);
    match version {
        Some(1..=VERSION) => Ok(()),
        Some(found) if found > VERSION => Err(ModelError::Newer { found, known: VERSION }),
        _ => Err(ModelError::Member {
            path: "version".to_owned(),
            reason: "missing, or not a number from 1 on".to_owned(),
            changed: true,
        }),
    }
}

/// A verdict as written in the file.
fn word(verdict: Verdict) -> String {
    serde_json::to_value(verdict).ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default()
}

fn without_checksum(mut members: Map<String, Value>) -> Value {
    members.remove("checksum");
    Value::Object(members)
}

/// Limits text from a file to one line and 200 characters for messages.
fn one_line(text: &str) -> String {
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if plain.chars().count() <= 200 { plain } else { plain.chars().take(200).collect::<String>() + " …" }
}
