use std::path::Path;

use policy_align::ConstraintSet;

/// Any text is either refused in one line or read as constraints. The folder contains no robot.
pub(crate) fn constraint_file(text: &str) {
    let channels = ["x", "y"].map(ToOwned::to_owned);
    if let Err(error) = ConstraintSet::from_toml(text, &channels, Path::new("no folder")) {
        assert_eq!(error.to_string().lines().count(), 1, "{error}");
    }
}
