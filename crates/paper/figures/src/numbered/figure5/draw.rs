use plot::{Field, Picture, Plane, PlotError, Relief};

use super::{Levels, Movement};
use crate::state_plane::state_plane;
use crate::{Csv, Drawing, Sources, demonstrated};

/// The region of states that is shown: [−2, 2]².
const EXTENT: f64 = 2.0;

/// The box around the surfaces, with a margin, and its range of heights.
const BOX: f64 = 2.2;
const HEIGHTS: [f64; 2] = [-0.04, 0.4];

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let levels: Levels = sources.document("figure5")?;
    let small = (420.0, 430.0);
    let large = (630.0, 500.0);
    let dots = |title: &str, of: fn(&Movement) -> Option<&Vec<f64>>| {
        let movement = |movement| heights(movement, of(movement));
        Relief { dots: levels.movements.iter().flat_map(movement).collect(), ..relief(title, small) }
    };
    let surface = |title: &str, field: &Field| Relief { surface: Some(field.clone()), ..relief(title, large) };
    let after = format!("(c) After alignment, nMSE {:.4}", levels.alignment_nmse);
    let learnt = format!("(d) Learnt potential, nMSE {:.4}", levels.potential_nmse);
    let picture = Picture::rows(&[
        &[
            &seen(&levels),
            &dots("(b) Local potentials as integrated", |movement| Some(&movement.before)),
            &dots(&after, |movement| movement.after.as_ref()),
        ],
        &[&surface(&learnt, &levels.learnt()?), &surface("(e) True potential", &levels.truth)],
    ]);
    Ok(Drawing { picture, tables: vec![local_potentials(&levels), surfaces(&levels)?] })
}

/// The demonstrations over contours of the potential; discarded ones as crosses.
fn seen(levels: &Levels) -> Plane {
    let movements = levels.movements.iter().map(|movement| (&movement.points[..], movement.after.is_some()));
    let layers = demonstrated::layers(&levels.truth, movements, 1.4);
    state_plane("(a) Movements; light crosses: left out", EXTENT, layers, (420.0, 430.0))
}

fn relief(title: &str, size: (f64, f64)) -> Relief {
    Relief {
        title: title.to_owned(),
        labels: ["x₁", "x₂", "φ"].map(str::to_owned),
        extent: [(-BOX, -BOX, HEIGHTS[0]), (BOX, BOX, HEIGHTS[1])],
        surface: None,
        dots: vec![],
        size,
    }
}

fn heights(movement: &Movement, values: Option<&Vec<f64>>) -> Vec<(f64, f64, f64)> {
    let values = values.into_iter().flatten();
    movement.points.iter().zip(values).map(|(&(x, y), &value)| (x, y, value)).collect()
}

fn local_potentials(levels: &Levels) -> Csv {
    let lines = |(number, movement): (usize, &Movement)| {
        let line = |(sample, &(x, y)): (usize, &(f64, f64))| {
            let after = movement.after.as_ref().map_or(f64::NAN, |after| after[sample]);
            vec![number as f64, sample as f64, x, y, movement.truth[sample], movement.before[sample], after]
        };
        movement.points.iter().enumerate().map(line).collect::<Vec<_>>()
    };
    let header = ["trajectory", "sample", "x1", "x2", "truth", "before", "after"].map(str::to_owned).into();
    Csv { name: "local", header, rows: levels.movements.iter().enumerate().flat_map(lines).collect() }
}

fn surfaces(levels: &Levels) -> Result<Csv, PlotError> {
    let (truth, learnt) = (&levels.truth, levels.learnt()?);
    let places = truth.y().iter().enumerate().flat_map(|y| truth.x().iter().enumerate().map(move |x| (x, y)));
    let line = |((column, &x), (row, &y)): ((usize, &f64), (usize, &f64))| {
        vec![x, y, truth.values()[row][column], learnt.values()[row][column]]
    };
    let header = ["x1", "x2", "truth", "learnt"].map(str::to_owned).into();
    Ok(Csv { name: "surfaces", header, rows: places.map(line).collect() })
}
