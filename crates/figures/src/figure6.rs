//! Fig. 6: errors on the parabola against the amount of data, and against noise.

use anyhow::Context as _;
use experiments::{BANDWIDTHS, BESIDE_LEFT, BESIDE_RIGHT, NOISE_PERCENT, RULES, TRAJECTORIES_PERCENT};
use plot::{Axis, Curve, Curves, Entry, Key, Picture};

use super::errors::{BESIDE, ERRORS, FIRST, SECOND, Series, Style};
use super::{Csv, Drawing, Figure, Sources};

/// In the order of [`BANDWIDTHS`].
const STYLES: [Style; 2] = [FIRST, SECOND];

/// Pixels.
const SIZE: (f64, f64) = (640.0, 430.0);

/// No axis reaches farther down: below, errors are those of rounding, and what is to be compared would have no room.
const LOWEST: f64 = 1e-6;

pub(super) fn left() -> Figure {
    Figure::new("figure6_left", Some("figure6_left"), &["figure6_left"], draw_left)
}

pub(super) fn right() -> Figure {
    Figure::new("figure6_right", Some("figure6_right"), &["figure6_right"], draw_right)
}

fn draw_left(sources: &Sources) -> anyhow::Result<Drawing> {
    let series = series(sources, "figure6_left", "", &TRAJECTORIES_PERCENT)?;
    let beside = beside(sources, "figure6_left", BESIDE_LEFT, &TRAJECTORIES_PERCENT)?;
    let panel = with(
        &beside,
        Curves {
            x_label: "Trajectories learnt from (% of 40)".to_owned(),
            x: [0.0, 105.0],
            x_step: 20.0,
            y: [1e-3, 10.0],
            ..panel("Learning from fewer trajectories", &series)
        },
    );
    let tables = tables(&series, ["narrow", "medium"], "trajectories_percent");
    Ok(Drawing { picture: Picture::rows(&[&[&panel], &[&key(SIZE.0, &beside)]]), tables })
}

fn draw_right(sources: &Sources) -> anyhow::Result<Drawing> {
    let [velocity, displacement] = RULES.map(|(rule, _)| series(sources, "figure6_right", rule, &NOISE_PERCENT));
    let (velocity, displacement) = (velocity?, displacement?);
    let panel = |title, series, y| Curves {
        x_label: "Noise on positions (% of their standard deviation)".to_owned(),
        x: [-0.8, 20.8],
        x_step: 5.0,
        y,
        ..panel(title, series)
    };
    let [fused, smoothed] = BESIDE_RIGHT.map(|case| beside(sources, "figure6_right", case, &NOISE_PERCENT));
    let (fused, smoothed) = (fused?, smoothed?);
    let panels = [
        with(&fused, panel("Potentials from recorded velocities", &velocity, [1e-3, 1.0])),
        Curves {
            size: (0.75 * SIZE.0, SIZE.1),
            ..with(&smoothed, panel("For comparison: displacements, eq. (9)", &displacement, [1e-3, 1e4]))
        },
    ];
    let mut all = tables(&velocity, ["velocity-narrow", "velocity-medium"], "noise_percent");
    all.extend(tables(&displacement, ["displacement-narrow", "displacement-medium"], "noise_percent"));
    let key = key(1.75 * SIZE.0, &fused);
    Ok(Drawing { picture: Picture::rows(&[&[&panels[0], &panels[1]], &[&key]]), tables: all })
}

/// One series for each bandwidth.
fn series<'a>(sources: &'a Sources, id: &str, rule: &str, percent: &[f64]) -> anyhow::Result<Vec<Series<'a>>> {
    let result = sources.experiment(id).with_context(|| format!("{id} was not run"))?;
    let prefix = if rule.is_empty() { String::new() } else { format!("{rule}-") };
    let series = BANDWIDTHS.iter().zip(STYLES).map(|((bandwidth, _), style)| Series {
        result,
        rows: percent.iter().map(|&x| (x, format!("{prefix}{bandwidth}-{x}"))).collect(),
        style,
    });
    Ok(series.collect())
}

fn panel(title: &str, series: &[Series<'_>]) -> Curves {
    Curves {
        title: title.to_owned(),
        x_label: String::new(),
        y_label: "Normalised error".to_owned(),
        y_axis: Axis::Logarithmic,
        x: [0.0; 2],
        y: [0.0; 2],
        x_step: 0.0,
        lines: series.iter().zip([true, false]).flat_map(|(series, banded)| curves(series, banded)).collect(),
        size: SIZE,
    }
}

/// The three errors, with or without bands: those of both bandwidths lie on each other.
fn curves(series: &Series<'_>, banded: bool) -> Vec<Curve> {
    let bare = |mut curve: Curve| {
        curve.points.iter_mut().filter(|_| !banded).for_each(|point| point.2 = 0.0);
        curve
    };
    series.curves().map(bare).collect()
}

/// A series for each learner beside PolicyAlign; empty ones where they were not run.
fn beside<'a>(sources: &'a Sources, id: &str, case: &str, percent: &[f64]) -> anyhow::Result<Vec<Series<'a>>> {
    let result = sources.experiment(id).with_context(|| format!("{id} was not run"))?;
    let of = |learner: &str| percent.iter().map(|&x| (x, format!("{case}-{x}/{learner}"))).collect();
    Ok(BESIDE.map(|(_, learner)| Series { result, rows: of(learner), style: FIRST }).into())
}

/// The curves of the learners beside, on an axis that reaches down to them as far as they are above [`LOWEST`]: what is
/// below lies on its edge.
fn with(beside: &[Series<'_>], mut panel: Curves) -> Curves {
    for (series, (error, _)) in beside.iter().zip(BESIDE) {
        let mut curve = series.curve(error);
        let least =
            curve.points.iter().map(|point| point.1).filter(|mean| *mean >= LOWEST).fold(f64::INFINITY, f64::min);
        if least < panel.y[0] {
            panel.y[0] = 10_f64.powf(least.log10().floor());
        }
        for point in curve.points.iter_mut().filter(|point| point.1 < panel.y[0]) {
            (point.1, point.2) = (panel.y[0], 0.0);
        }
        if !curve.points.is_empty() {
            panel.lines.push(curve);
        }
    }
    panel
}

fn key(width: f64, beside: &[Series<'_>]) -> Key {
    let row =
        |((name, _), style): (&(&str, _), Style)| ERRORS.map(|error| error.entry(&format!(", {name}"), style)).into();
    let mut rows: Vec<Vec<Entry>> = BANDWIDTHS.iter().zip(STYLES).map(row).collect();
    if beside.iter().zip(BESIDE).any(|(series, (error, _))| !series.curve(error).points.is_empty()) {
        rows.push(BESIDE.map(|(error, _)| error.entry("", FIRST)).into());
    }
    Key { rows, width }
}

fn tables(series: &[Series<'_>], names: [&'static str; 2], varied: &str) -> Vec<Csv> {
    series.iter().zip(names).map(|(series, name)| series.table(name, varied)).collect()
}
