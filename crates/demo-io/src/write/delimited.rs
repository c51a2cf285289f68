use std::io::Write;

use super::{Failure, WriteError, has_velocities};
use crate::ReadOptions;
use crate::rows::roles::{Column, Content, assign};
use motion::Recordings;

/// Writes `episode, t, x, y, x_vel, y_vel`, one row per sample, with numbers in the shortest form that reads back to
/// the same bits.
pub(super) fn write(file: impl Write, recordings: &Recordings, separator: u8) -> Result<(), Failure> {
    let velocities = has_velocities(recordings)?;
    let constraints = recordings.episodes.iter().any(|episode| episode.constraint.is_some());
    let mut header = vec!["episode".to_owned(), "t".to_owned()];
    header.extend(constraints.then(|| "constraint".to_owned()));
    let leading = header.len();
    header.extend(recordings.state.iter().map(|channel| channel.name.clone()));
    if velocities {
        header.extend(recordings.state.iter().map(|channel| format!("{}_vel", channel.name)));
    }
    check(&header, leading..leading + recordings.state.len())?;
    let mut writer = csv::WriterBuilder::new().delimiter(separator).from_writer(file);
    writer.write_record(&header).map_err(std::io::Error::from)?;
    let mut number = String::new();
    for episode in &recordings.episodes {
        for (sample, time) in episode.times.stamps().iter().enumerate() {
            let mut field = |text: &str| writer.write_field(text).map_err(std::io::Error::from);
            field(&episode.name)?;
            let label = episode.constraint.as_ref().map_or("", |labels| labels.at(sample));
            let columns = [Some(&episode.positions), episode.velocities.as_ref()];
            field(shortest(&mut number, *time))?;
            if constraints {
                field(label)?;
            }
            for value in columns.into_iter().flatten().flat_map(|numbers| numbers.column(sample)) {
                field(shortest(&mut number, *value))?;
            }
            writer.write_record(None::<&[u8]>).map_err(std::io::Error::from)?;
        }
    }
    Ok(writer.flush()?)
}

fn shortest(buffer: &mut String, value: f64) -> &str {
    use std::fmt::Write as _;
    buffer.clear();
    // Writing to a String cannot fail.
    let _ = write!(buffer, "{value:?}");
    buffer
}

/// Checks that a reader detects the same roles.
fn check(header: &[String], state: std::ops::Range<usize>) -> Result<(), WriteError> {
    let columns: Vec<Column> =
        header.iter().map(|name| Column { name: name.clone(), content: Content::Counting }).collect();
    let roles = assign(&columns, &ReadOptions::default(), "").map(|roles| roles.state);
    match roles {
        Ok(found) if found.iter().copied().eq(state) => Ok(()),
        Ok(found) => Err(WriteError::Names {
            found: crate::rows::roles::shortened(&found.iter().map(|&at| &header[at]).collect::<Vec<_>>()),
        }),
        Err(error) => Err(WriteError::Names { found: error.fault().what.clone() }),
    }
}
