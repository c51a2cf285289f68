//! Decides which files, and which pieces of large ones, are read at once.

use std::path::PathBuf;

use demo_io::{Piece, ReadError, ReadOptions, pieces_of};

/// Approximate number of rows of all digests together; in seven dimensions they take 60 MB.
const ROWS: u64 = 500_000;

/// Number of the largest pieces that fit into the size read at once: enough to be spread evenly over a file, and each small compared with
/// that size on every thread.
const PIECES: u64 = 16;

/// The limit on a piece's size is at least this, in bytes: the beginning of the file is read with each piece.
const SMALLEST: u64 = 256 << 10;

/// The files that are read at once, and those that are reduced to digests. Large files are divided into pieces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Division {
    /// Evenly spread over all files, or all of them if they are small enough.
    pub at_once: Vec<Piece>,
    /// The other files and pieces, in their order.
    pub further: Vec<FurtherPiece>,
}

/// A file, or a piece of one, that is reduced to a digest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FurtherPiece {
    /// Its index among the further pieces.
    pub at: usize,
    /// The file or piece.
    pub piece: Piece,
    /// Its size in bytes.
    pub bytes: u64,
    /// Largest number of rows of its digest, proportional to its share of all bytes.
    pub rows: usize,
}

impl Division {
    /// Default size of the files read at once, in bytes: about four million samples in the plane as text.
    pub const AT_ONCE: u64 = 256_000_000;
    /// The word for all files.
    pub const ALL: &str = "all";

    /// Parses a size as users write it: "256MB", "1.5 GB", or "all".
    pub fn bytes(text: &str) -> Option<u64> {
        let text = text.to_lowercase();
        if text == Self::ALL {
            return Some(u64::MAX);
        }
        let units = [("kb", 1e3), ("mb", 1e6), ("gb", 1e9), ("tb", 1e12)];
        let (number, unit) = units.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, factor)))?;
        let bytes = number.trim().parse::<f64>().ok()? * unit;
        (1.0..1e18).contains(&bytes).then_some(bytes as u64)
    }

    /// The I-th of N shares of the further files, counted from 1, dealt out in turn.
    pub fn share(&self, (this, of): (usize, usize)) -> Vec<FurtherPiece> {
        self.further.iter().skip(this.saturating_sub(1)).step_by(of.max(1)).cloned().collect()
    }

    /// Whether the files have at most `most_bytes` together.
    ///
    /// # Errors
    /// [`ReadError`] for a folder that cannot be read.
    pub fn fits(files: &[PathBuf], most_bytes: u64) -> Result<bool, ReadError> {
        Ok(bytes_of_all(&listed(files)?) <= most_bytes)
    }

    /// A division that reads all files at once.
    pub fn none(files: &[PathBuf]) -> Division {
        let whole = |path| Piece::whole(path, files.len() > 1);
        Division { at_once: files.iter().map(whole).collect(), further: vec![] }
    }

    /// Selects every k-th file to be read at once, with the smallest k for which these have at most `most_bytes` together; if there is
    /// none, only the first file. Folders with one file per movement are divided by file; a data set counts as one file. Text with more
    /// than a sixteenth of these bytes is divided into pieces ([`pieces_of`]), for which it is read once; `progress` takes the number of
    /// bytes read since the last call. The result depends only on the order, the sizes and the data read with `options`.
    ///
    /// # Errors
    /// [`ReadError`] for a folder that cannot be read, and for files that are divided.
    pub fn of(
        files: &[PathBuf],
        options: &ReadOptions,
        most_bytes: u64,
        progress: &mut dyn FnMut(u64),
    ) -> Result<Division, ReadError> {
        let listed = listed(files)?;
        if bytes_of_all(&listed) <= most_bytes {
            return Ok(Division::none(files));
        }
        let named_by_file = listed.len() > 1 || listed != files;
        let most_of_one = (most_bytes / PIECES).max(SMALLEST);
        let mut pieces = vec![];
        for path in listed {
            pieces.extend(pieces_of(Piece::whole(path, named_by_file), most_of_one, options, progress)?);
        }
        let sizes: Vec<u64> = pieces.iter().map(Piece::bytes).collect();
        let fits = |every: &usize| sizes.iter().step_by(*every).sum::<u64>() <= most_bytes;
        let every = (1..pieces.len()).find(fits).unwrap_or(pieces.len().max(1));
        let is_at_once = |at: usize| at.is_multiple_of(every);
        let of_others: u64 = sizes.iter().enumerate().filter(|(at, _)| !is_at_once(*at)).map(|(_, bytes)| bytes).sum();
        let mut division = Division { at_once: vec![], further: vec![] };
        for (place, (piece, bytes)) in pieces.into_iter().zip(sizes).enumerate() {
            if is_at_once(place) {
                division.at_once.push(piece);
            } else {
                let share = u128::from(ROWS) * u128::from(bytes) / u128::from(of_others.max(1));
                let (at, rows) = (division.further.len(), (share as usize).max(1));
                division.further.push(FurtherPiece { at, piece, bytes, rows });
            }
        }
        Ok(division)
    }
}

/// The files, with folders of one file per movement expanded.
fn listed(files: &[PathBuf]) -> Result<Vec<PathBuf>, ReadError> {
    Ok(files.iter().map(|path| demo_io::files_of(path)).collect::<Result<Vec<_>, _>>()?.concat())
}

fn bytes_of_all(files: &[PathBuf]) -> u64 {
    files.iter().map(|path| demo_io::bytes_of(path)).sum()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn sizes_have_units() {
        let sizes = ["256MB", "1.5 gb", "all", "256", "MB", "-1kB", "infGB", "1e30TB", ""].map(Division::bytes);
        let (more, none) = ([Some(256_000_000), Some(1_500_000_000), Some(u64::MAX)], [None; 6]);
        assert_eq!(sizes.to_vec(), [&more[..], &none[..]].concat());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Every file is in one part, in order. The files read at once fit the limit unless there is only one, and rows are distributed by
        /// bytes.
        #[test]
        fn every_file_is_read_once(sizes in prop::collection::vec(0usize..3000, 1..12), most in 1u64..20_000) {
            let folder = tempfile::tempdir().expect("a folder");
            let files: Vec<PathBuf> = (0..sizes.len()).map(|at| folder.path().join(format!("{at}.csv"))).collect();
            for (path, &size) in files.iter().zip(&sizes) {
                fs::write(path, vec![b'0'; size]).expect("a file");
            }
            let divided = |files: &[PathBuf]| {
                Division::of(files, &ReadOptions::default(), most, &mut |_| ()).expect("a division")
            };
            let division = divided(&files);
            let further = || division.further.iter();
            let found: BTreeSet<&PathBuf> =
                division.at_once.iter().chain(further().map(|further| &further.piece)).map(|piece| &piece.path).collect();
            prop_assert_eq!(found.len(), files.len());
            prop_assert_eq!(division.at_once.len() + division.further.len(), files.len());
            let at_once: u64 = division.at_once.iter().map(Piece::bytes).sum();
            prop_assert!(at_once <= most || division.at_once.len() == 1);
            prop_assert!(further().all(|file| file.bytes == file.piece.bytes() && file.rows > 0));
            let rows: usize = further().map(|file| file.rows).sum();
            prop_assert!(rows as u64 <= ROWS + division.further.len() as u64);
            let shares = [1, 2, 3].map(|this| division.share((this, 3)));
            let mut shared: Vec<FurtherPiece> = shares.concat();
            shared.sort_by_key(|file| file.at);
            prop_assert_eq!(&shared, &division.further);
            // A folder is equivalent to its files.
            let of_folder = divided(&[folder.path().to_owned()]);
            if !of_folder.further.is_empty() {
                prop_assert_eq!(of_folder.at_once.len() + of_folder.further.len(), files.len());
            }
        }
    }

    /// A large file is divided into evenly spread pieces; small files stay whole.
    #[test]
    fn a_large_file_is_divided() {
        let folder = tempfile::tempdir().expect("a folder");
        let [large, small] = ["large.csv", "small.csv"].map(|name| folder.path().join(name));
        let header = "episode,t,x,y\n";
        let movement = |episode: usize| (0..100).map(move |at| format!("{episode},{at},{},{}\n", at * 2, at * 3));
        let rows: String = (0..3000).flat_map(movement).collect();
        let bytes = rows.len() as u64;
        fs::write(&large, format!("{header}{rows}")).expect("a file");
        fs::write(&small, format!("{header}{}", movement(0).collect::<String>())).expect("a file");
        let most = bytes / 3;
        let files = [large.clone(), small.clone()];
        let division = Division::of(&files, &ReadOptions::default(), most, &mut |_| ()).expect("a division");
        let further = division.further.iter().map(|further| &further.piece);
        let mut pieces: Vec<&Piece> = division.at_once.iter().chain(further).collect();
        pieces.sort_by_key(|piece| (piece.path.clone(), piece.span.as_ref().map(|span| span.number)));
        assert_eq!(pieces.pop(), Some(&Piece::whole(small, true)));
        let mut end = header.len() as u64;
        for piece in pieces {
            let span = piece.span.as_ref().expect("a part").bytes.clone();
            assert!(piece.path == large && piece.named_by_file && span.start == end);
            assert!(span.end - span.start <= (most / PIECES).max(SMALLEST));
            end = span.end;
        }
        assert_eq!(end, header.len() as u64 + bytes);
        assert!(division.at_once.len() > 2 && division.at_once.iter().map(Piece::bytes).sum::<u64>() <= most);
    }
}
