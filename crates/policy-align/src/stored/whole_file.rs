use std::io;
use std::path::Path;

/// Writes a whole file or nothing ([`demo_io::write_whole`]): what stood there before stays until everything is on the
/// disk.
///
/// # Errors
/// What the system says.
pub fn write_whole(path: &Path, contents: &[u8]) -> io::Result<()> {
    demo_io::write_whole(path, |file| file.write_all(contents))
}
