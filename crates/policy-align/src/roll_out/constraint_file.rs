//! Reads constraints from files.
//!
//! ```toml
//! [[constraint]]              # the state keeps x: A u = 0, several rows as [[1, 0], [0, 1]]
//! normal = [1, 0]
//!
//! [[constraint]]              # the state stays out of a ball, from 0.5 s to 2 s
//! point = [0.5, 0.5]
//! radius = 0.2
//! from = 0.5
//! until = 2.0
//!
//! [[constraint]]              # a link stays in the plane it is in; channels are joints of that name
//! robot = "arm.urdf"
//! link = "hand"
//! plane = [0, 0, 1]           # or point and radius, metres, to keep it out of a ball
//! ```

use prepare::numbers::counted;
use std::path::Path;

use kinematics::RobotModel;
use nalgebra::{DMatrix, DVector, Point3};
use serde::Deserialize;
use thiserror::Error;

use super::constraint_part::{Kind, Part};
use super::constraint_set::ConstraintSet;
use super::link_point::LinkPoint;

/// Reasons why constraints cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConstraintFileError {
    /// The text is not TOML, or has unknown members.
    #[error("{reason}")]
    NotToml {
        /// The TOML reader's message, in one line.
        reason: String,
    },
    /// A constraint with no kind, or with two.
    #[error("constraint {constraint}: {reason}")]
    Constraint {
        /// Its number, counted from 1.
        constraint: usize,
        /// Description of the fault.
        reason: String,
    },
    /// The file, or that of a robot, cannot be read.
    #[error("{file}: {source}")]
    File {
        /// Its path.
        file: String,
        /// The system's error.
        source: std::io::Error,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    constraint: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    normal: Option<Rows>,
    point: Option<Vec<f64>>,
    radius: Option<f64>,
    robot: Option<String>,
    link: Option<String>,
    plane: Option<Rows>,
    from: Option<f64>,
    until: Option<f64>,
}

/// One direction, or several.
#[derive(Deserialize)]
#[serde(untagged)]
enum Rows {
    One(Vec<f64>),
    Several(Vec<Vec<f64>>),
}

impl ConstraintSet {
    /// Reads constraints from a text. `channels` are the names of the state; paths of robots are
    /// relative to `folder`.
    ///
    /// # Errors
    /// [`ConstraintFileError`].
    pub fn from_toml(text: &str, channels: &[String], folder: &Path) -> Result<ConstraintSet, ConstraintFileError> {
        let file: File = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
            ConstraintFileError::NotToml { reason: format!("line {line}: {}", error.message().replace('\n', "; ")) }
        })?;
        let parts = file.constraint.into_iter().enumerate().map(|(at, entry)| {
            let wrong = |reason| ConstraintFileError::Constraint { constraint: at + 1, reason };
            let robot = entry.robot.as_ref().map(|robot| folder.join(robot));
            let robot = match robot {
                None => None,
                Some(path) => Some(read_robot(&path)?.map_err(wrong)?),
            };
            entry.part(channels, robot.as_ref()).map_err(wrong)
        });
        Ok(ConstraintSet { parts: parts.collect::<Result<_, _>>()? })
    }

    /// Reads constraints from a file.
    ///
    /// # Errors
    /// [`ConstraintFileError`].
    pub fn load(path: &Path, channels: &[String]) -> Result<ConstraintSet, ConstraintFileError> {
        let text = read(path)?;
        Self::from_toml(&text, channels, path.parent().unwrap_or(Path::new(".")))
    }
}

fn read(path: &Path) -> Result<String, ConstraintFileError> {
    demo_io::read_text(path).map_err(|source| ConstraintFileError::File { file: path.display().to_string(), source })
}

fn read_robot(path: &Path) -> Result<Result<RobotModel, String>, ConstraintFileError> {
    Ok(RobotModel::from_urdf(&read(path)?).map_err(|error| error.to_string()))
}

impl Entry {
    fn part(self, channels: &[String], robot: Option<&RobotModel>) -> Result<Part, String> {
        let n = channels.len();
        let link = match (robot, &self.link) {
            (Some(robot), Some(link)) => Some(LinkPoint::new(robot, link, channels)?),
            (None, None) => None,
            _ => return Err("`robot` and `link` belong together".to_owned()),
        };
        let kind = match (self.normal, self.plane, self.point, self.radius, link) {
            (Some(normal), None, None, None, None) => Kind::Normal(normal.matrix("normal", n)?),
            (None, Some(plane), None, None, Some(link)) => Kind::Plane(link, plane.matrix("plane", 3)?),
            (None, None, Some(point), Some(radius), None) => {
                Kind::Ball { centre: vector("point", point, n)?, radius: positive(radius)? }
            }
            (None, None, Some(point), Some(radius), Some(link)) => {
                let centre = vector("point", point, 3)?;
                Kind::LinkBall { link, centre: Point3::new(centre[0], centre[1], centre[2]), radius: positive(radius)? }
            }
            _ => {
                return Err("give `normal`, or `point` and `radius`; or `robot` and `link` with `plane`, or with `point` and `radius`".to_owned());
            }
        };
        let (from, until) = (self.from.unwrap_or(f64::NEG_INFINITY), self.until.unwrap_or(f64::INFINITY));
        if from.is_nan() || until.is_nan() || from >= until {
            return Err(format!("it holds from {from} s until {until} s: the second must be later"));
        }
        Ok(Part { kind, from, until })
    }
}

impl Rows {
    fn matrix(self, name: &str, n: usize) -> Result<DMatrix<f64>, String> {
        let rows = match self {
            Rows::One(row) => vec![row],
            Rows::Several(rows) => rows,
        };
        let rows = rows.into_iter().map(|row| vector(name, row, n)).collect::<Result<Vec<_>, _>>()?;
        if rows.is_empty() || rows.iter().any(|row| row.norm() == 0.0) {
            return Err(format!("`{name}` has no direction: give numbers that are not all 0"));
        }
        Ok(DMatrix::from_fn(rows.len(), n, |row, column| rows[row][column]))
    }
}

fn vector(name: &str, numbers: Vec<f64>, n: usize) -> Result<DVector<f64>, String> {
    if numbers.len() != n || !numbers.iter().all(|number| number.is_finite()) {
        return Err(format!("`{name}` has {}: it needs {n}, all finite", counted(numbers.len(), "number")));
    }
    Ok(DVector::from_vec(numbers))
}

fn positive(radius: f64) -> Result<f64, String> {
    if radius > 0.0 && radius.is_finite() {
        Ok(radius)
    } else {
        Err(format!("`radius` is {radius}: it must be positive"))
    }
}
