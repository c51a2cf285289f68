//! Fig. 6: errors on the parabola against the amount of data, and against noise.

use anyhow::Context as _;
use plot::{Axis, Curves, Key, Picture};

use super::errors::{ERRORS, FIRST, SECOND, Series, Style};
use super::{Csv, Drawing, Figure, Sources};
use crate::experiments::{BANDWIDTHS, NOISE_PERCENT, RULES, TRAJECTORIES_PERCENT};

/// In the order of [`BANDWIDTHS`].
const STYLES: [Style; 2] = [FIRST, SECOND];

/// Pixels.
const SIZE: (f64, f64) = (600.0, 430.0);

pub(super) fn left() -> Figure {
    Figure::new("figure6_left", Some("figure6_left"), &["figure6_left"], draw_left)
}

pub(super) fn right() -> Figure {
    Figure::new("figure6_right", Some("figure6_right"), &["figure6_right"], draw_right)
}

fn draw_left(sources: &Sources) -> anyhow::Result<Drawing> {
    let series = series(sources, "figure6_left", "", &TRAJECTORIES_PERCENT)?;
    let panel = Curves {
        x_label: "Trajectories learnt from (% of 40)".to_owned(),
        x: [0.0, 105.0],
        x_step: 20.0,
        y: [1e-3, 10.0],
        ..panel("Learning from fewer movements", &series)
    };
    let tables = tables(&series, ["narrow", "medium"], "trajectories_percent");
    Ok(Drawing { picture: Picture::rows(&[&[&panel], &[&key(SIZE.0)]]), tables })
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
    let panels = [
        panel("Potentials from recorded velocities", &velocity, [1e-3, 1.0]),
        panel("Potentials from displacements (9)", &displacement, [1e-3, 1e4]),
    ];
    let mut all = tables(&velocity, ["velocity-narrow", "velocity-medium"], "noise_percent");
    all.extend(tables(&displacement, ["displacement-narrow", "displacement-medium"], "noise_percent"));
    let key = key(2.0 * SIZE.0);
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
        lines: series.iter().flat_map(Series::curves).collect(),
        size: SIZE,
    }
}

fn key(width: f64) -> Key {
    let row =
        |((name, _), style): (&(&str, _), Style)| ERRORS.map(|error| error.entry(&format!(", {name}"), style)).into();
    Key { rows: BANDWIDTHS.iter().zip(STYLES).map(row).collect(), width }
}

fn tables(series: &[Series<'_>], names: [&'static str; 2], varied: &str) -> Vec<Csv> {
    series.iter().zip(names).map(|(series, name)| series.table(name, varied)).collect()
}
