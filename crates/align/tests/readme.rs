//! The program that the README prints is the one that is built and run as somebody else's crate.

#[test]
fn the_readme_prints_the_downstream_program() {
    let readme = include_str!("../../../README.md");
    let program = include_str!("../../../docs/examples/downstream/src/main.rs");
    assert!(
        readme.contains(&format!("```rust,no_run\n{program}```")),
        "README.md: copy docs/examples/downstream/src/main.rs"
    );
}
