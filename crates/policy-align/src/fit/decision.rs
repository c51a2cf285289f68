use crate::Decision;

/// A decision, its reason, and the flag that overrides it.
pub(super) fn decision(what: &str, value: impl Into<String>, why: impl Into<String>, flag: &str) -> Decision {
    Decision { what: what.to_owned(), value: value.into(), why: why.into(), flag: flag.to_owned() }
}
