use std::io::{BufRead as _, BufReader};

use super::lines::Lines;
use super::movements::Form;
use crate::ReadError;
use crate::input::{Input, unreadable};
use crate::raw::MOST_EPISODES;
use crate::regular_file::FileState;
use crate::rows::piece::{Cuts, Span, Start};

/// Cuts into parts of whole lines, each of at most `most` bytes unless a line has more. Returns no part unless each line is an episode in
/// [`crate::write`]'s form.
pub(crate) fn cut(
    input: &Input<'_>,
    (most, of): (u64, FileState),
    progress: &mut dyn FnMut(u64),
) -> Result<Vec<Span>, ReadError> {
    let mut first = Lines::new(input)?;
    let form = first.next(true, &mut |_| ())?.map(|document| Form::of(&document, false));
    if form != Some(Form::Episode) || first.next(false, &mut |_| ())?.is_none() {
        return Ok(Vec::new());
    }
    let mut file = BufReader::with_capacity(1 << 16, input.open()?);
    let (mut cuts, mut movements) = (Cuts::new(most, of), 0);
    // For the current line.
    let (mut start, mut line, mut byte, mut is_blank) = (0, 1, 0, true);
    loop {
        let read = file.fill_buf().map_err(|error| unreadable(&error, &input.name))?;
        if read.is_empty() {
            return Ok(if movements > MOST_EPISODES { Vec::new() } else { cuts.finish() });
        }
        let end = read.iter().position(|&letter| letter == b'\n').map_or(read.len(), |at| at + 1);
        let mark = if byte == 0 && read.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        if is_blank && !read[mark..end].trim_ascii().is_empty() {
            is_blank = false;
            cuts.push(Start { byte: start, line, movements });
            movements += 1;
        }
        byte += end as u64;
        if read[end - 1] == b'\n' {
            (start, line, is_blank) = (byte, line + 1, true);
        }
        file.consume(end);
        progress(end as u64);
    }
}
