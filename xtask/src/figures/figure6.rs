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
    Figure {
        id: "figure6_left",
        title: "Figure 6, left: error against the amount of data",
        caption: "Errors of the policy π, of what constraints let through of it, Nπ, and of the potential φ, when only so \
                  many percent of 40 movements are learnt from: means over data sets, with bands of one standard deviation \
                  up and by the same factor down. Medians are in the CSV files.",
        beside_paper: Some(
            "In the full run of seed 1 errors fall from 20 % of the movements, where the paper's axis begins, to all of \
                  them: with the narrow bandwidth π from .35 to .027, Nπ from .090 to .011, φ from .11 to .0028. As in the \
                  paper π is on top throughout. There φ is lowest throughout; here it is only with many movements, with the \
                  narrow bandwidth from 40 % on, with the medium one from 80 % on. With fewer, alignment goes wrong in some data \
                  sets, and these make the means: at 20 %, narrow, the median of φ is .0071. The paper does not say which \
                  bandwidth it shows.",
        ),
        differs: Some("the potential’s error φ is the lowest only with many movements, in the paper throughout."),
        experiment: Some("figure6_left"),
        needs: &["figure6_left"],
        draw: draw_left,
    }
}

pub(super) fn right() -> Figure {
    Figure {
        id: "figure6_right",
        title: "Figure 6, right: error against noise",
        caption: "The same errors when recorded positions are noisy, against the truth without noise. Left: potentials \
                  integrated from recorded velocities, which are clean. Right, on another scale: potentials integrated \
                  from displacements, by rule (9). Without noise both rules are the same here.",
        beside_paper: Some(
            "In the full run of seed 1, with velocities (left), errors grow from 2.5 % of noise to 20 % as in the paper: with \
                  the narrow bandwidth π from .023 to .37, Nπ from .0085 to .093, φ from .0039 to .11. As in the paper they \
                  stay below 1, with π on top. φ, lowest there throughout, is lowest here with the narrow bandwidth up to 15 %, \
                  with the medium one up to 5 %. With displacements (right) noise looks like a steady descent, and soon \
                  nothing is left to learn: at 5 % the error of π is 8.4 and 4.2. The paper's curves can hardly come from \
                  that rule.",
        ),
        differs: Some(
            "with much noise φ is no lower than Nπ, in the paper it is throughout; by rule (9) 5 % of noise leave nothing to \
             learn, where the paper’s errors stay below 1.",
        ),
        experiment: Some("figure6_right"),
        needs: &["figure6_right"],
        draw: draw_right,
    }
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
