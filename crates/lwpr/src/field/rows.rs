//! Memory aligned for vector registers.

use std::ops::{Deref, DerefMut};

/// Size of a cache line in bytes. Loading a register across the end of a line takes twice as long.
const LINE: usize = 64;

/// A fixed number of `f64` on the heap, aligned to a cache line.
#[derive(Default)]
pub(crate) struct Rows {
    /// Contains the numbers at an offset.
    buffer: Vec<f64>,
    start: usize,
    len: usize,
}

impl Rows {
    pub(crate) fn zeros(len: usize) -> Self {
        let slack = LINE / size_of::<f64>();
        let buffer = vec![0.0; len + slack];
        let start = buffer.as_ptr().align_offset(LINE).min(slack);
        Rows { buffer, start, len }
    }
}

impl From<&[f64]> for Rows {
    fn from(numbers: &[f64]) -> Self {
        let mut rows = Rows::zeros(numbers.len());
        rows.copy_from_slice(numbers);
        rows
    }
}

impl Deref for Rows {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.buffer[self.start..self.start + self.len]
    }
}

impl DerefMut for Rows {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.buffer[self.start..self.start + self.len]
    }
}

impl Clone for Rows {
    fn clone(&self) -> Self {
        Rows::from(&**self)
    }
}

impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl std::fmt::Debug for Rows {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(&**self).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::{LINE, Rows};

    #[test]
    fn copies_start_at_a_cache_line_too() {
        for len in 0..40 {
            let numbers: Vec<f64> = (0..len).map(f64::from).collect();
            let rows = Rows::from(&numbers[..]).clone();
            assert_eq!(*rows, numbers[..]);
            assert_eq!(rows.as_ptr().addr() % LINE, 0);
        }
    }
}
