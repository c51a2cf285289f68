use std::cell::Cell;
use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read, Seek as _, SeekFrom};
use std::ops::Range;
use std::rc::Rc;

use super::dialect::Dialect;
use crate::ReadError;
use crate::input::Input;

/// Maximum number of bytes of a record; a longer one is no row of numbers.
const LONGEST_RECORD: usize = 16 << 20;

/// The file's text as the parser sees it: without byte order mark, with runs of blanks as one blank, and with a limit on the length of
/// records.
pub(super) struct TextSource<'a> {
    file: File,
    progress: &'a mut dyn FnMut(u64),
    /// Bytes read since the last record; the caller resets it to 0 with each record.
    pub(super) since_record: Rc<Cell<usize>>,
    skip: usize,
    /// Bytes of the file that may still be read.
    left: u64,
    blanks: Option<Squeeze>,
    /// Length of the byte order mark in bytes.
    mark: u64,
}

impl<'a> TextSource<'a> {
    pub(super) fn new(
        input: &Input<'_>,
        dialect: &Dialect,
        progress: &'a mut dyn FnMut(u64),
        is_cut: bool,
    ) -> Result<Self, ReadError> {
        let ends = is_cut.then(VecDeque::new);
        Ok(Self {
            file: input.open()?,
            progress,
            since_record: Rc::default(),
            skip: dialect.mark,
            left: u64::MAX,
            blanks: dialect.blanks.then(|| Squeeze { ends, read: dialect.mark as u64, ..Squeeze::default() }),
            mark: dialect.mark as u64,
        })
    }

    /// Restricts the source to these bytes of the file, which follow the end of a line.
    pub(super) fn within(mut self, bytes: &Range<u64>) -> io::Result<Self> {
        self.file.seek(SeekFrom::Start(bytes.start))?;
        self.since_record.set(0);
        let blanks = self.blanks.map(|_| Squeeze::default());
        Ok(Self { skip: 0, left: bytes.end.saturating_sub(bytes.start), blanks, ..self })
    }

    /// The file's byte for the parser's byte at which a record begins; `None` if that is not possible because of blanks between quotation
    /// marks. Calls must be in ascending order.
    pub(super) fn byte_of(&mut self, parsed: u64) -> Option<u64> {
        match &mut self.blanks {
            Some(squeeze) if parsed > 0 => squeeze.byte_of(parsed),
            _ => Some(self.mark + parsed),
        }
    }
}

impl Read for TextSource<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            // A blank read earlier may be written now: one more byte than was read.
            let start = usize::from(self.blanks.is_some());
            let read = (&mut self.file).take(self.left).read(&mut buffer[start..])?;
            self.left -= read as u64;
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

/// Reduces runs of blanks and tabs to one blank, and removes those at the ends of lines.
#[derive(Default)]
struct Squeeze {
    in_line: bool,
    pending: bool,
    quoted: bool,
    /// Bytes of the file before the next input; `written` is the number of bytes written so far.
    read: u64,
    written: u64,
    /// Ends of lines outside quotation marks, as bytes written and bytes of the file; `None` if they are not needed.
    ends: Option<VecDeque<(u64, u64)>>,
}

impl Squeeze {
    /// Squeezes the text at `range`, which starts at 1 or later, to the front.
    fn squeeze(&mut self, text: &mut [u8], range: Range<usize>) -> usize {
        let (mut written, first) = (0, range.start);
        let after = range.end;
        for at in range {
            let letter = text[at];
            match letter {
                b' ' | b'\t' if !self.quoted => self.pending = self.in_line,
                b'\n' | b'\r' => {
                    (self.in_line, self.pending) = (false, false);
                    text[written] = letter;
                    written += 1;
                    if let Some(ends) = self.ends.as_mut().filter(|_| !self.quoted) {
                        ends.push_back((self.written + written as u64, self.read + (at + 1 - first) as u64));
                    }
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
        self.read += (after - first) as u64;
        self.written += written as u64;
        written
    }

    /// The byte of the file after the end of a line, from that of the squeezed text.
    fn byte_of(&mut self, squeezed: u64) -> Option<u64> {
        let ends = self.ends.as_mut()?;
        while ends.front().is_some_and(|end| end.0 < squeezed) {
            ends.pop_front();
        }
        ends.front().filter(|end| end.0 == squeezed).map(|end| end.1)
    }
}
