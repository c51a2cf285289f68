//! Fig. 6: errors on the parabola against the amount of data, and against noise.

use anyhow::Context as _;
use experiments::{BANDWIDTHS, BASELINES_LEFT, BASELINES_RIGHT, NOISE_PERCENT, RULES, TRAJECTORIES_PERCENT};
use plot::{Axis, Curve, Curves, Note, Picture};

use crate::errors::{BASELINES, FIRST, SECOND, Series, Style, axis_down_to};
use crate::{Csv, Drawing, Sources};

/// In the order of [`BANDWIDTHS`]: line style, and suffix of the curves' names.
const STYLES: [(Style, &str); 2] = [(FIRST, ", narrow"), (SECOND, ", medium")];

/// Size in pixels, and the part of its width for the names of curves.
const SIZE: (f64, f64) = (640.0, 460.0);
const ROOM: f64 = 190.0;

/// Range of the errors that are compared; below it the axis is broken.
const LEFT: [f64; 2] = [1e-3, 4.0];

/// Range of both panels, so that they can be compared. An error of 1 is that of a constant policy, the mean. Curves beyond the
/// range are described in a note, not drawn.
const RIGHT: [f64; 2] = [1e-6, 10.0];

pub(crate) fn draw_left(sources: &Sources) -> anyhow::Result<Drawing> {
    let series = series(sources, "figure6_left", "", &TRAJECTORIES_PERCENT)?;
    let lines = lines(&series, &baselines(sources, "figure6_left", BASELINES_LEFT, &TRAJECTORIES_PERCENT)?);
    let panel = Curves {
        title: "Learning from fewer trajectories".to_owned(),
        x_label: "Trajectories learnt from (% of 40)".to_owned(),
        y_axis: axis_down_to(&lines, LEFT[0]),
        x: [0.0, 102.0],
        x_step: 20.0,
        y: LEFT,
        size: (SIZE.0 + 120.0, SIZE.1),
        ..panel(lines)
    };
    let tables = tables(&series, ["narrow", "medium"], "trajectories_percent");
    Ok(Drawing { picture: Picture::rows(&[&[&panel]]), tables })
}

pub(crate) fn draw_right(sources: &Sources) -> anyhow::Result<Drawing> {
    let [velocity, displacement] =
        RULES.map(|(rule, _)| series(sources, "figure6_right", &format!("{rule}-"), &NOISE_PERCENT));
    let (velocity, displacement) = (velocity?, displacement?);
    let [fused, smoothed] = BASELINES_RIGHT.map(|case| baselines(sources, "figure6_right", case, &NOISE_PERCENT));
    let lines = [lines(&velocity, &fused?), lines(&displacement, &smoothed?)];
    let y_axis = axis_down_to(lines.iter().flatten(), RIGHT[0]);
    let beyond = beyond(&displacement);
    let [velocities, displacements] = lines.map(|lines| Curves {
        x_label: "Noise on positions (% of their standard deviation)".to_owned(),
        y_axis,
        x: [-0.8, 20.8],
        x_step: 5.0,
        y: RIGHT,
        ..panel(lines)
    });
    let panels = [
        Curves { title: "Potentials from recorded velocities".to_owned(), ..velocities },
        Curves {
            title: "For comparison: from displacements, eq. (9)".to_owned(),
            notes: beyond.into_iter().collect(),
            ..displacements
        },
    ];
    let mut all = tables(&velocity, ["velocity-narrow", "velocity-medium"], "noise_percent");
    all.extend(tables(&displacement, ["displacement-narrow", "displacement-medium"], "noise_percent"));
    Ok(Drawing { picture: Picture::rows(&[&[&panels[0], &panels[1]]]), tables: all })
}

/// One series for each bandwidth, whose rows begin with `prefix`.
fn series<'a>(sources: &'a Sources, id: &str, prefix: &str, percent: &[f64]) -> anyhow::Result<Vec<Series<'a>>> {
    let result = sources.experiment(id).with_context(|| format!("{id} was not run"))?;
    let series = BANDWIDTHS.iter().zip(STYLES).map(|((bandwidth, _), (style, of))| Series {
        result,
        rows: percent.iter().map(|&x| (x, format!("{prefix}{bandwidth}-{x}"))).collect(),
        of,
        style,
    });
    Ok(series.collect())
}

/// A curve for each learner other than PolicyAlign that was run.
fn baselines(sources: &Sources, id: &str, case: &str, percent: &[f64]) -> anyhow::Result<Vec<Curve>> {
    let result = sources.experiment(id).with_context(|| format!("{id} was not run"))?;
    let rows_of = |learner: &str| percent.iter().map(|&x| (x, format!("{case}-{x}/{learner}"))).collect();
    let curves = BASELINES
        .map(|(error, learner)| Series { result, rows: rows_of(learner), of: "", style: FIRST }.curve(error))
        .into_iter();
    Ok(curves.filter(|curve| !curve.points.is_empty()).collect())
}

/// The three errors of both bandwidths, and other curves. Those of the second bandwidth have no bands, which would cover those
/// of the first.
fn lines(series: &[Series<'_>], baselines: &[Curve]) -> Vec<Curve> {
    let mut lines = vec![];
    for (series, banded) in series.iter().zip([true, false]) {
        for mut curve in series.curves() {
            curve.points.iter_mut().filter(|_| !banded).for_each(|point| point.2 = 0.0);
            lines.push(curve);
        }
    }
    lines.extend_from_slice(baselines);
    lines
}

fn panel(lines: Vec<Curve>) -> Curves {
    Curves {
        title: String::new(),
        x_label: String::new(),
        y_label: "Normalised error".to_owned(),
        x_axis: Axis::Linear,
        y_axis: Axis::Linear,
        x: [0.0; 2],
        y: [0.0; 2],
        x_step: 0.0,
        lines,
        notes: vec![],
        room: ROOM,
        size: SIZE,
    }
}

/// A note with the range of PolicyAlign's errors at the highest noise level, if all are beyond the axis.
fn beyond(displacement: &[Series<'_>]) -> Option<Note> {
    let noise = NOISE_PERCENT[NOISE_PERCENT.len() - 1];
    let curves: Vec<Curve> = displacement.iter().flat_map(Series::curves).collect();
    let last = curves.iter().flat_map(|curve| &curve.points).filter(|point| point.0 == noise).map(|point| point.1);
    let [least, largest] = [last.clone().reduce(f64::min)?, last.reduce(f64::max)?];
    let text = format!("↑ PolicyAlign: {least:.0} to {largest:.0} at {noise} %");
    (least > RIGHT[1]).then(|| Note { at: (14.2, RIGHT[1] / 5.0), text })
}

fn tables(series: &[Series<'_>], names: [&'static str; 2], varied: &str) -> Vec<Csv> {
    series.iter().zip(names).map(|(series, name)| series.table(name, varied)).collect()
}

#[cfg(test)]
mod tests {
    use experiments::measure::Measure;

    use super::*;
    use crate::beside_paper::records;

    #[test]
    fn no_curve_of_the_committed_run_is_lost_below_its_axis() {
        let sources = records();
        let baselines = baselines(&sources, "figure6_left", BASELINES_LEFT, &TRAJECTORIES_PERCENT).unwrap();
        let lines = lines(&series(&sources, "figure6_left", "", &TRAJECTORIES_PERCENT).unwrap(), &baselines);
        assert_eq!(lines.len(), 8);
        let Axis::Logarithmic { lowest } = axis_down_to(&lines, LEFT[0]) else { panic!("a linear axis") };
        let within = |point: &(f64, f64, f64)| (lowest..=LEFT[1]).contains(&point.1);
        assert!(lines.iter().all(|curve| curve.points.iter().all(within)), "{lowest}");
    }

    #[test]
    fn curves_beyond_the_axis_are_noted() {
        let sources = records();
        let note_of = |rule| beyond(&series(&sources, "figure6_right", &format!("{rule}-"), &NOISE_PERCENT).unwrap());
        assert!(note_of(RULES[0].0).is_none());
        let result = sources.experiment("figure6_right").unwrap();
        let largest =
            &result.rows.iter().find(|row| row.id == "displacement-narrow-20").unwrap().measures[&Measure::Nupe];
        let note = note_of(RULES[1].0).unwrap();
        assert!(note.text.ends_with(&format!(" to {:.0} at 20 %", largest.mean)), "{}", note.text);
    }
}
