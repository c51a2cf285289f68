//! The program printed in docs/rust.md is the one that is built and run as a crate outside of the workspace.

#[test]
fn the_page_prints_the_downstream_program() {
    let page = include_str!("../../../docs/rust.md");
    let program = include_str!("../../../docs/examples/downstream/src/main.rs");
    assert!(
        page.contains(&format!("```rust,no_run\n{program}```")),
        "docs/rust.md: copy docs/examples/downstream/src/main.rs"
    );
}
