use std::io::Write as _;

use demo_io::{ReadOptions, read};

/// Any bytes yield recordings or an error in three lines. The first line of the file may hold the reading options as JSON:
/// `{"sort":true}`.
pub(crate) fn readers(bytes: &[u8]) {
    let end = bytes.iter().position(|&byte| byte == b'\n').unwrap_or(0);
    let (mut options, content) = match serde_json::from_slice::<ReadOptions>(&bytes[..end]) {
        Ok(options) => (options, &bytes[end + 1..]),
        Err(_) => (ReadOptions::default(), bytes),
    };
    // A trusted file may take any amount of memory.
    options.trust = false;
    let mut file = tempfile::NamedTempFile::new().expect("a folder for files");
    file.write_all(content).expect("room for a file");
    let found = match read(file.path(), &options, &mut |_| ()) {
        Ok(found) => found,
        Err(error) => return assert_eq!(error.to_string().lines().count(), 3, "{error}"),
    };
    assert!(!found.state.is_empty() && !found.episodes.is_empty());
    for episode in &found.episodes {
        let times = &episode.times;
        assert!(times.steps().all(|step| step > 0.0 && step.is_finite()), "{times:?}");
        for numbers in [Some(&episode.positions), episode.velocities.as_ref()].into_iter().flatten() {
            assert_eq!(numbers.shape(), (found.state.len(), times.len()));
            assert!(numbers.iter().all(|number| number.is_finite()));
        }
    }
}
