//! Which files, and which pieces of large ones, are read at once.

use std::path::PathBuf;

use demo_io::{Piece, ReadError, ReadOptions, pieces_of};

/// Rows of all digests together, about: so many in seven dimensions take 60 MB.
const ROWS: u64 = 500_000;

/// Pieces that have the size of what is read at once: enough to be evenly spread over a file, and small beside it on each thread.
const PIECES: u64 = 16;

/// Bytes that a piece may always have: the beginning of the file is looked at with each.
const SMALLEST: u64 = 256 << 10;

/// Files that are read at once, and those of which digests are made; of large files pieces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Division {
    /// Evenly spread over all; all of them if they are small enough.
    pub at_once: Vec<Piece>,
    /// The others, in their order.
    pub further: Vec<FurtherPiece>,
}

/// A file, or a piece of one, of which a digest is made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FurtherPiece {
    /// Its place among them.
    pub at: usize,
    /// Which it is.
    pub piece: Piece,
    /// Its size.
    pub bytes: u64,
    /// Rows of its digest at most, by its share of all bytes.
    pub rows: usize,
}

impl Division {
    /// Bytes of files that are read at once, unless told otherwise: four million samples in the plane as text.
    pub const AT_ONCE: u64 = 256_000_000;
    /// The word for all files.
    pub const ALL: &str = "all";

    /// A size as users write it: "256MB", "1.5 GB", or "all".
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

    /// Whether files have at most so many bytes together.
    ///
    /// # Errors
    /// [`ReadError`] for a folder that cannot be read.
    pub fn fits(files: &[PathBuf], most_bytes: u64) -> Result<bool, ReadError> {
        Ok(bytes_of_all(&listed(files)?) <= most_bytes)
    }

    /// All files at once.
    pub fn none(files: &[PathBuf]) -> Division {
        let whole = |path| Piece::whole(path, files.len() > 1);
        Division { at_once: files.iter().map(whole).collect(), further: vec![] }
    }

    /// Every so many of the files, so that they have at most so many bytes together; the first alone if none is smaller. Of folders that
    /// hold a file for each movement the files count, a data set counts as one. In place of a text that has more than a sixteenth of these
    /// bytes its pieces count ([`pieces_of`]), which is read once for that; `progress` takes the number of bytes read since the last call.
    /// Depends on the order, the sizes and what is read with `options` alone.
    ///
    /// # Errors
    /// [`ReadError`] for a folder that cannot be read, and of files that are cut.
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

/// These files, and those of folders that hold one for each movement.
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

        /// Every file is in one part, in order; those at once are few enough unless that is a single one; and rows are shared out by bytes.
        #[test]
        fn every_file_is_read_once(sizes in prop::collection::vec(0usize..3000, 1..12), most in 1u64..20_000) {
            let folder = tempfile::tempdir().expect("a folder");
            let files: Vec<PathBuf> = (0..sizes.len()).map(|at| folder.path().join(format!("{at}.csv"))).collect();
            for (path, &size) in files.iter().zip(&sizes) {
                fs::write(path, vec![b'0'; size]).expect("a file");
            }
            let of = |files: &[PathBuf]| {
                Division::of(files, &ReadOptions::default(), most, &mut |_| ()).expect("a division")
            };
            let division = of(&files);
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
            // The folder is its files.
            let of_folder = of(&[folder.path().to_owned()]);
            if !of_folder.further.is_empty() {
                prop_assert_eq!(of_folder.at_once.len() + of_folder.further.len(), files.len());
            }
        }
    }

    /// A large file counts as its pieces, which are evenly spread over it; small ones beside it stay whole.
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
