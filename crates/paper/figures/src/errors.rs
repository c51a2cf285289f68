//! Curves of errors: mean and spread over data sets against the varied quantity, with the same colours and marks in all
//! figures.

use experiments::measure::Measure;
use experiments::results::{Cell, ExperimentResult};
use plot::{Axis, Curve, Dash, Filling, Mark, Sign, Stroke};

use crate::Csv;

/// An error measure with its name, colour and mark.
#[derive(Debug, Clone, Copy)]
pub(super) struct Error {
    measure: Measure,
    name: &'static str,
    color: &'static str,
    mark: Mark,
}

impl Error {
    fn stroke(self, style: Style) -> Stroke {
        Stroke { color: self.color, width: 1.8, dash: style.dash }
    }

    fn sign(self, style: Style) -> Sign {
        Sign { mark: self.mark, filling: style.filling }
    }
}

/// In descending order of the paper's errors.
pub(super) const ERRORS: [Error; 3] = [
    Error { measure: Measure::Nupe, name: "π (nUPE)", color: "#d55e00", mark: Mark::Circle },
    Error { measure: Measure::Ncpe, name: "Nπ (nCPE)", color: "#0072b2", mark: Mark::Square },
    Error { measure: Measure::PotentialNmse, name: "φ (nMSE)", color: "#4d4d4d", mark: Mark::Up },
];

/// Line style and filling that distinguish the curves of one series from those of another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Style {
    dash: Dash,
    filling: Filling,
}

pub(super) const FIRST: Style = Style { dash: Dash::Solid, filling: Filling::Full };
pub(super) const SECOND: Style = Style { dash: Dash::Dashed, filling: Filling::Hollow };

/// The policy's error for learners other than PolicyAlign, with the names of their rows.
pub(super) const BASELINES: [(Error, &str); 2] = [
    (Error { measure: Measure::Nupe, name: "π, slope GP", color: "#cc79a7", mark: Mark::Down }, "slope_gp"),
    (
        Error { measure: Measure::Nupe, name: "π, slope GP without trend", color: "#7a4b94", mark: Mark::Cross },
        "slope_gp_no_trend",
    ),
];

/// A series of rows of an experiment, and how it is drawn. Rows that were not run are left out.
pub(super) struct Series<'a> {
    pub(super) result: &'a ExperimentResult,
    /// The varied quantity, and the row.
    pub(super) rows: Vec<(f64, String)>,
    /// Suffix of the names of its curves.
    pub(super) of: &'static str,
    pub(super) style: Style,
}

impl Series<'_> {
    /// The curves of the three errors.
    pub(super) fn curves(&self) -> impl Iterator<Item = Curve> {
        ERRORS.into_iter().map(|error| self.curve(error)).filter(|curve| !curve.points.is_empty())
    }

    /// The curve of one error, with a point for each row that has a value.
    pub(super) fn curve(&self, error: Error) -> Curve {
        let point = |(x, row): &(f64, String)| {
            let Cell { mean, sd, .. } = self.cell(row, error.measure)?;
            Some((*x, *mean, sd.unwrap_or(0.0)))
        };
        let points = self.rows.iter().filter_map(point).collect();
        let name = format!("{}{}", error.name, self.of);
        Curve { points, stroke: error.stroke(self.style), sign: Some(error.sign(self.style)), name }
    }

    /// Returns `None` if no data set has a value.
    fn cell(&self, row: &str, measure: Measure) -> Option<&Cell> {
        self.result.rows.iter().find(|result| result.id == row)?.measures.get(&measure)
    }

    /// A table of the varied quantity, and each error's mean, s.d., median and number of data sets.
    pub(super) fn table(&self, name: &'static str, varied: &str) -> Csv {
        let columns = |error: Error| {
            let measure = error.measure.name();
            ["mean", "sd", "median", "n"].map(|column| format!("{measure}_{column}"))
        };
        let header = std::iter::once(varied.to_owned()).chain(ERRORS.into_iter().flat_map(columns)).collect();
        let numbers = |row: &str, error: Error| {
            self.cell(row, error.measure).map_or([f64::NAN, f64::NAN, f64::NAN, 0.0], |cell| {
                [cell.mean, cell.sd.unwrap_or(f64::NAN), cell.median, cell.n() as f64]
            })
        };
        let line = |(x, row): &(f64, String)| {
            std::iter::once(*x).chain(ERRORS.into_iter().flat_map(|error| numbers(row, error))).collect()
        };
        Csv { name, header, rows: self.rows.iter().map(line).collect() }
    }
}

/// A logarithmic axis that begins at `from`, a power of ten, and continues, broken, down to the lowest point of these
/// curves.
pub(super) fn axis_down_to<'c>(curves: impl IntoIterator<Item = &'c Curve>, from: f64) -> Axis {
    let means = curves.into_iter().flat_map(|curve| curve.points.iter().map(|point| point.1));
    Axis::Logarithmic { lowest: means.filter(|mean| *mean > 0.0).fold(from, f64::min) }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use experiments::results::RowResult;

    use super::*;

    #[test]
    fn an_axis_reaches_down_to_all_that_is_above_0() {
        let curve = |means: &[f64]| Curve {
            points: means.iter().map(|&mean| (0.0, mean, 0.0)).collect(),
            stroke: ERRORS[0].stroke(FIRST),
            sign: Some(ERRORS[0].sign(FIRST)),
            name: String::new(),
        };
        let axis = axis_down_to(&[curve(&[0.5, 3.4e-20]), curve(&[0.0, 2.0])], 1e-3);
        assert_eq!(axis, Axis::Logarithmic { lowest: 3.4e-20 });
        assert_eq!(axis_down_to(&[curve(&[0.5, 0.02])], 1e-3), Axis::Logarithmic { lowest: 1e-3 });
    }

    #[test]
    fn rows_that_were_not_run_or_have_no_value_leave_no_point() {
        let values = vec![Some(0.25), None, Some(0.75)];
        let cell = Cell { mean: 0.5, sd: Some(0.2), median: 0.5, values, paper: None, verdict: None };
        let measures = BTreeMap::from([(Measure::Nupe, cell)]);
        let row = |id: &str, measures| RowResult {
            id: id.to_owned(),
            tested_on: String::new(),
            data_sets: 3,
            failed: 0,
            measures,
        };
        let rows = vec![row("d-0.1", BTreeMap::new()), row("d-0.2", measures)];
        let result = ExperimentResult { id: "figure9".to_owned(), section: "4.4".to_owned(), rows };
        let rows = [(0.1, "d-0.1"), (0.2, "d-0.2"), (0.3, "d-0.3")].map(|(x, id)| (x, id.to_owned())).into();
        let series = Series { result: &result, rows, of: ", narrow", style: FIRST };
        let curves: Vec<Curve> = series.curves().collect();
        assert_eq!(curves.len(), 1);
        assert_eq!(curves[0].points, [(0.2, 0.5, 0.2)]);
        assert_eq!(curves[0].name, "π (nUPE), narrow");

        let text = series.table("d", "d").text();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("d,nupe_mean,nupe_sd,nupe_median,nupe_n,ncpe_mean"), "{text}");
        assert_eq!(lines[1..3], ["0.1,,,,0,,,,0,,,,0", "0.2,0.5,0.2,0.5,2,,,,0,,,,0"]);
    }
}
