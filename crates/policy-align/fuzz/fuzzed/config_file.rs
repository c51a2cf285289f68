use std::path::Path;

use crate::cli::failure::Failure;
use crate::cli::options::config::Config;
use crate::cli::options::flags::{FitFlags, PrepareFlags, ReadFlags};
use crate::cli::options::rollout_flags::RollOutFlags;

/// Any text is either refused in three lines or parsed into flags.
pub(crate) fn config_file(text: &str) {
    if let Err(failure) = every_table(text) {
        assert_eq!(failure.to_string().lines().count(), 3, "{failure}");
    }
}

fn every_table(text: &str) -> Result<(), Failure> {
    let config = Config::parsed(text, Path::new("c.toml"))?;
    let read = config.under("read", &ReadFlags::default())?;
    read.options()?;
    config.under("prepare", &PrepareFlags::default())?.options(&read)?;
    config.under("fit", &FitFlags::default())?.options()?;
    config.under("rollout", &RollOutFlags::default())?;
    Ok(())
}
