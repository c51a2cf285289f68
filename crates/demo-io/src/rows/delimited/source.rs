use std::cell::Cell;
use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read, Seek as _, SeekFrom};
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
    /// Bytes of the file that may still be read.
    left: u64,
    blanks: Option<Squeeze>,
    /// Bytes of a byte order mark.
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

    /// These bytes of the file, which follow the end of a line.
    pub(super) fn within(mut self, bytes: &Range<u64>) -> io::Result<Self> {
        self.file.seek(SeekFrom::Start(bytes.start))?;
        self.since_record.set(0);
        let blanks = self.blanks.map(|_| Squeeze::default());
        Ok(Self { skip: 0, left: bytes.end.saturating_sub(bytes.start), blanks, ..self })
    }

    /// The byte of the file that the parser sees as this one, which begins a record; none if blanks between quotation marks stand around it.
    /// To be asked in ascending order.
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
            // A blank may come out that was read before: one more byte than goes in.
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

/// Runs of blanks and tabs become one blank, and none at the ends of lines.
#[derive(Default)]
struct Squeeze {
    in_line: bool,
    pending: bool,
    quoted: bool,
    /// Bytes of the file before what is squeezed next, and of what has been squeezed.
    read: u64,
    written: u64,
    /// Where lines ended outside quotation marks, as bytes squeezed and bytes of the file, if it is asked.
    ends: Option<VecDeque<(u64, u64)>>,
}

impl Squeeze {
    /// Squeezes what stands at `range`, which begins at 1 at least, to the front.
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

    /// The byte of the file behind the end of a line, by that of the squeezed text.
    fn byte_of(&mut self, squeezed: u64) -> Option<u64> {
        let ends = self.ends.as_mut()?;
        while ends.front().is_some_and(|end| end.0 < squeezed) {
            ends.pop_front();
        }
        ends.front().filter(|end| end.0 == squeezed).map(|end| end.1)
    }
}
