//! `cargo xtask conformance`: compares our numbers and files with reference cases of other programs.

use std::path::PathBuf;

use clap::Args;

use crate::progress::say;

#[derive(Debug, Args)]
pub(crate) struct Conformance {
    /// Folder with lwpr/*.json, kinematics/*.json and their robots, slope_gp/*.json, reading/*.json, urdf_traps/expected.json and files/expected.json with their files. What a file of slope_gp or reading is, its member `kind` says, or how its name begins
    #[arg(long, value_name = "DIR")]
    vectors: PathBuf,
}

impl Conformance {
    /// Fails if a file disagrees, or if there is none.
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        conformance::compare(&self.vectors, say)
    }
}
