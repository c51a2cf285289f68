//! All pairs of channels, each in a small picture.

use std::cmp::Reverse;

use maud::{Markup, html};
use nalgebra::{DMatrix, DVectorView, Point3, Vector3};
use page::{Card, Part};
use plot::{Camera, Frame, Item, Space};
use policy_align::{Model, Prepared, StateChannel};
use text::plain;

use crate::cli::lines::short;
use crate::cli::pages::constraint_marks::recorded;
use crate::cli::pages::movements::evenly;
use crate::cli::pages::page_parts::part;
use crate::cli::pages::picture::{DEMONSTRATED, Picture, with_unit};

/// Largest number of channels whose pairs are drawn: those that vary most.
const MOST: usize = 7;
/// Largest number of movements in a picture, evenly selected.
const DRAWN: usize = 24;
/// Largest number of samples of a movement in the spatial picture.
const IN_SPACE: usize = 40;
const SIZE: (f64, f64) = (250.0, 255.0);
const TITLE: &str = "All pairs of channels";

/// A picture for each pair of channels; `None` if one picture shows the whole state.
pub(crate) fn pairs(model: &Model, prepared: &Prepared) -> Option<Part> {
    if model.state.len() < 3 {
        return None;
    }
    let model = &model.in_usual_context();
    let chosen = most_varying(model);
    let movements = recorded(prepared);
    let drawn: Vec<_> = evenly(&movements, DRAWN).cloned().collect();
    let card = |(across, up): (usize, usize)| {
        let (title, dims) = (String::new(), [across, up]);
        let picture = Picture { title, model, dims, demonstrated: drawn.clone(), held: vec![], followed: vec![] };
        let svg = plot::Picture::rows(&[&[&picture.small_plane(SIZE)]]).svg();
        let title = format!("{} and {}", model.state[across].name, model.state[up].name);
        Card { id: &format!("pair-{across}-{up}"), title: &title, caption: "", remark: None, svg: &svg }.under(&title)
    };
    let of_two = (1..chosen.len()).flat_map(|up| (0..up).map(move |across| (across, up)));
    let cards: Vec<Markup> = of_two.map(|(across, up)| card((chosen[across], chosen[up]))).collect();
    let space = (model.state.len() == 3).then(|| in_space(model, &drawn));
    let left = model.state.len() - chosen.len();
    let body = html! {
        p {
            "Blue: the demonstrations, from their dots along their arrowheads. Arrows: the learnt policy in the plane of two channels, with \
             all others at their median. Grey: too far from all demonstrations to predict an action there."
            @if left > 0 { " The " (MOST) " channels of " (model.state.len()) " that vary most; " code { "policy-align plot --dims" } " draws any two." }
            @if drawn.len() < movements.len() { " " (drawn.len()) " of the " (movements.len()) " demonstrations are drawn." }
        }
        div .small-multiples { @for card in space.into_iter().chain(cards) { (card) } }
    };
    Some(part("pairs", TITLE, &body))
}

/// Movements of three channels, (3, N) each, in a spatial picture.
fn in_space(model: &Model, movements: &[DMatrix<f64>]) -> Markup {
    let alike = model.state.iter().all(|channel| channel.scale == model.state[0].scale);
    let factors = model.scales().map(|scale| if alike { 1.0 } else { scale });
    let place = |state: DVectorView<'_, f64>| Point3::from(Vector3::from_fn(|k, _| factors[k] * state[k]));
    let path = |movement: &DMatrix<f64>| {
        let every = movement.ncols().div_ceil(IN_SPACE).max(1);
        let points = movement.column_iter().step_by(every).map(place).collect();
        Item::Path { points, stroke: DEMONSTRATED, label: None }
    };
    let starts = movements.iter().map(|movement| place(movement.column(0))).collect();
    let starts = Item::Dots { points: starts, color: DEMONSTRATED.color, radius: 2.6 };
    let end = |of: fn(&StateChannel) -> f64| Point3::from(Vector3::from_fn(|k, _| factors[k] * of(&model.state[k])));
    // The larger pictures mention missing units; there is no room for it here.
    let label = |k: usize| match &model.state[k] {
        StateChannel { unit: None, name, .. } if factors[k] == 1.0 => plain(name).into_owned(),
        StateChannel { unit: None, name, .. } => plain(&format!("{name} times {}", short(factors[k]))).into_owned(),
        channel => with_unit(channel, factors[k]),
    };
    let labels = [0, 1, 2].map(label);
    let frame = Frame { lowest: end(|channel| channel.low), highest: end(|channel| channel.high), labels };
    let space = Space {
        title: String::new(),
        camera: Camera { azimuth: -55.0, elevation: 25.0 },
        items: movements.iter().map(path).chain([starts]).collect(),
        over: vec![],
        frame: Some(frame),
        extent: None,
        size: (320.0, 320.0),
    };
    let (title, svg) = ("All three channels", plot::Picture::rows(&[&[&space]]).svg());
    Card { id: "space", title, caption: "", remark: None, svg: &svg }.under(title)
}

/// Indices of the channels that vary most in the units in which the policy was learnt, in their original order.
fn most_varying(model: &Model) -> Vec<usize> {
    let mut all: Vec<usize> = (0..model.state.len()).collect();
    let width = |at: usize| (model.state[at].high - model.state[at].low) * model.state[at].scale;
    all.sort_by(|&a, &b| width(b).total_cmp(&width(a)).then(Reverse(b).cmp(&Reverse(a))));
    all.truncate(MOST);
    all.sort_unstable();
    all
}
