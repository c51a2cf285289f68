use demo_io::{ReadOptions, read};

use crate::large::{FurtherFile, PartError};
use crate::{Digest, Digester, FileSummary, trim_still};

/// Reads a file and makes its digest; holds this file alone. `trim`: samples at rest at either end are removed. Calls `progress` with the
/// number of bytes read since the last call.
///
/// # Errors
/// [`PartError`], which names the file.
pub fn digest_file(
    file: &FurtherFile,
    digester: &Digester,
    (options, trim): (&ReadOptions, bool),
    progress: &mut dyn FnMut(u64),
) -> Result<Digest, PartError> {
    let FurtherFile { path, rows, .. } = file;
    let mut recordings = read(path, options, progress)?;
    if trim {
        trim_still(&mut recordings);
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut digest =
        digester.digest(recordings, *rows).map_err(|source| PartError::Digest { file: name.clone(), source })?;
    for left_out in &mut digest.data.left_out {
        left_out.episode = format!("{name}/{}", left_out.episode);
    }
    if path.is_file() {
        let summary =
            FileSummary::of(path).map_err(|error| PartError::File { file: name, reason: error.to_string() })?;
        digest.data.files = vec![summary];
    }
    Ok(digest)
}
