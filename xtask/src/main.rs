//! Runs the experiments of the paper and the checks of the workspace.
fn main() {}
