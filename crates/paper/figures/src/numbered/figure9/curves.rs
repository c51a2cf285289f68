//! Errors at samples near the goal, along the line and around it.

use anyhow::Context as _;
use experiments::{Distance, TENTHS};
use plot::{Axis, Curve, Curves};

use crate::errors::{BASELINES, FIRST, Series, axis_down_to};
use crate::{Csv, Sources};

/// Size in pixels, and the part of its width for the names of curves.
const SIZE: (f64, f64) = (620.0, 420.0);
const ROOM: f64 = 95.0;

/// Range of both panels; below it the axis is broken.
const Y: [f64; 2] = [0.01, 2.0];

/// Panels (d) and (e), and their numbers.
pub(super) struct Panels {
    pub(super) along: Curves,
    pub(super) around: Curves,
    pub(super) tables: Vec<Csv>,
}

pub(super) fn panels(sources: &Sources) -> anyhow::Result<Panels> {
    let result = sources.experiment("figure9").context("figure9 was not run")?;
    let series = |distance: Distance| Series {
        result,
        rows: TENTHS.map(|tenths| (f64::from(tenths) / 10.0, distance.row(tenths))).collect(),
        of: "",
        style: FIRST,
    };
    let [along, around] = Distance::BOTH.map(series);
    let (error, learner) = BASELINES[0];
    let baselines = |distance: Distance| {
        let rows = TENTHS.map(|tenths| (f64::from(tenths) / 10.0, format!("{}/{learner}", distance.row(tenths))));
        Series { result, rows: rows.collect(), of: "", style: FIRST }.curve(error)
    };
    let [baselines_along, baselines_around] = Distance::BOTH.map(baselines);
    Ok(Panels {
        along: panel("(d) Samples within d of the goal along the line", "d (rad)", &along, baselines_along),
        around: panel("(e) Samples within r of the line", "r (rad)", &around, baselines_around),
        tables: vec![along.table("d", "d"), around.table("r", "r")],
    })
}

fn panel(title: &str, x_label: &str, series: &Series<'_>, baselines: Curve) -> Curves {
    let lines: Vec<Curve> = series.curves().chain((!baselines.points.is_empty()).then_some(baselines)).collect();
    Curves {
        title: title.to_owned(),
        x_label: x_label.to_owned(),
        y_label: "Normalised error, cumulative".to_owned(),
        x_axis: Axis::Linear,
        y_axis: axis_down_to(&lines, Y[0]),
        x: [0.0, 1.02],
        x_step: 0.2,
        y: Y,
        lines,
        notes: vec![],
        room: ROOM,
        size: SIZE,
    }
}
