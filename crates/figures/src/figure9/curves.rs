//! Errors among the samples near the goal along the line, and near the line.

use anyhow::Context as _;
use experiments::{Distance, TENTHS};
use plot::{Axis, Curve, Curves, Key};

use crate::errors::{BESIDE, ERRORS, FIRST, Series};
use crate::{Csv, Sources};

/// Pixels.
const SIZE: (f64, f64) = (620.0, 400.0);

/// (d) and (e), their key, and their numbers.
pub(super) struct Panels {
    pub(super) along: Curves,
    pub(super) around: Curves,
    pub(super) key: Key,
    pub(super) tables: Vec<Csv>,
}

pub(super) fn panels(sources: &Sources) -> anyhow::Result<Panels> {
    let result = sources.experiment("figure9").context("figure9 was not run")?;
    let series = |distance: Distance| Series {
        result,
        rows: TENTHS.map(|tenths| (f64::from(tenths) / 10.0, distance.row(tenths))).collect(),
        style: FIRST,
    };
    let [along, around] = Distance::BOTH.map(series);
    let (error, learner) = BESIDE[0];
    let beside = |distance: Distance| {
        let rows = TENTHS.map(|tenths| (f64::from(tenths) / 10.0, format!("{}/{learner}", distance.row(tenths))));
        Series { result, rows: rows.collect(), style: FIRST }.curve(error)
    };
    let [beside_along, beside_around] = Distance::BOTH.map(beside);
    let of_beside = (!beside_along.points.is_empty()).then(|| error.entry("", FIRST));
    Ok(Panels {
        along: panel("(d) Samples within d of the goal along the line", "d (rad)", &along, beside_along),
        around: panel("(e) Samples within r of the line", "r (rad)", &around, beside_around),
        key: Key {
            rows: vec![ERRORS.map(|error| error.entry("", FIRST)).into_iter().chain(of_beside).collect()],
            width: 2.0 * SIZE.0,
        },
        tables: vec![along.table("d", "d"), around.table("r", "r")],
    })
}

fn panel(title: &str, x_label: &str, series: &Series<'_>, beside: Curve) -> Curves {
    Curves {
        title: title.to_owned(),
        x_label: x_label.to_owned(),
        y_label: "Normalised error, cumulative".to_owned(),
        y_axis: Axis::Linear,
        x: [0.0, 1.05],
        x_step: 0.2,
        y: [0.0, 1.1],
        lines: series.curves().chain((!beside.points.is_empty()).then_some(beside)).collect(),
        size: SIZE,
    }
}
