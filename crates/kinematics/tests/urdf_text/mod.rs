//! URDF texts for the tests.
pub(crate) const LIMIT: &str = r#"<limit lower="-1" upper="2" effort="1" velocity="1"/>"#;
pub(crate) const ORIGIN: &str = r#"<origin xyz="0.1 0 0.2" rpy="0 0 0"/>"#;

/// A robot with links of these names and other tags.
pub(crate) fn robot(links: &str, rest: &str) -> String {
    robot_of_version("", links, rest)
}

pub(crate) fn robot_of_version(version: &str, links: &str, rest: &str) -> String {
    let links: Vec<String> = links.split_whitespace().map(|name| format!("<link name=\"{name}\"/>")).collect();
    let links = links.concat();
    format!("<robot name=\"r\" {version}>{links}{rest}</robot>")
}

pub(crate) fn joint(name: &str, kind: &str, parent: &str, child: &str, inside: &str) -> String {
    format!(r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inside}</joint>"#)
}

/// Two links and a joint "j" between them that contains these tags.
pub(crate) fn single(kind: &str, inside: &str) -> String {
    robot("a b", &joint("j", kind, "a", "b", inside))
}

/// Three links in a row; joint "j1" moves freely about z, "j2" contains these tags.
pub(crate) fn double(first: &str, second: &str, inside: &str) -> String {
    let first = joint("j1", first, "a", "b", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/>{LIMIT}"#));
    let second = joint("j2", second, "b", "c", &format!(r#"{ORIGIN}<axis xyz="0 0 1"/>{LIMIT}{inside}"#));
    robot("a b c", &(first + &second))
}
