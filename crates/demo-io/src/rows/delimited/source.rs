use std::cell::Cell;
use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::rc::Rc;

use super::dialect::Dialect;
use crate::ReadError;
use crate::input::Input;

/// A record of more bytes is no row of numbers.
const LONGEST_RECORD: usize = 16 << 20;

/// The file's text as the parser should see it: without byte order mark, runs of blanks as one, and no endless records.
pub(super) struct TextSource<'a> {
    file: File,
    progress: &'a mut dyn FnMut(u64),
    /// Bytes read since the last record: to be set to 0 with each.
    pub(super) since_record: Rc<Cell<usize>>,
    skip: usize,
    blanks: Option<Squeeze>,
}

impl<'a> TextSource<'a> {
    pub(super) fn new(
        input: &Input<'_>,
        dialect: &Dialect,
        progress: &'a mut dyn FnMut(u64),
    ) -> Result<Self, ReadError> {
        Ok(Self {
            file: input.open()?,
            progress,
            since_record: Rc::default(),
            skip: dialect.mark,
            blanks: dialect.blanks.then(Squeeze::default),
        })
    }
}

impl Read for TextSource<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            // A blank may come out that was read before: one more byte than goes in.
            let start = usize::from(self.blanks.is_some());
            let read = self.file.read(&mut buffer[start..])?;
            (self.progress)(read as u64);
            let since = self.since_record.get() + read;
            if since > LONGEST_RECORD {
                return Err(io::ErrorKind::FileTooLarge.into());
            }
            self.since_record.set(since);
            let skipped = self.skip.min(read);
            self.skip -= skipped;
            let written = if let Some(squeeze) = &mut self.blanks {
                squeeze.squeeze(buffer, start + skipped..start + read)
            } else {
                buffer.copy_within(skipped..read, 0);
                read - skipped
            };
            if written > 0 || read == 0 {
                return Ok(written);
            }
        }
    }
}

/// Runs of blanks and tabs become one blank, and none at the ends of lines.
#[derive(Default)]
struct Squeeze {
    in_line: bool,
    pending: bool,
    quoted: bool,
}

impl Squeeze {
    /// Squeezes what stands at `range`, which begins at 1 at least, to the front.
    fn squeeze(&mut self, text: &mut [u8], range: Range<usize>) -> usize {
        let mut written = 0;
        for at in range {
            let letter = text[at];
            match letter {
                b' ' | b'\t' if !self.quoted => self.pending = self.in_line,
                b'\n' | b'\r' => {
                    (self.in_line, self.pending) = (false, false);
                    text[written] = letter;
                    written += 1;
                }
                _ => {
                    self.quoted ^= letter == b'"';
                    if self.pending {
                        text[written] = b' ';
                        written += 1;
                    }
                    (self.in_line, self.pending) = (true, false);
                    text[written] = letter;
                    written += 1;
                }
            }
        }
        written
    }
}
