//! Fig. 2: a finger that stretches, free and along a box, and both movements in joint space.

mod contact;

use constraints::{PfaffianConstraint, Unconstrained};
use motion::Policy;
use nalgebra::dvector;
use plot::{Dash, Layer, Mark, Picture, Plane, Stroke};
use serde::{Deserialize, Serialize};

use self::contact::{FACE, Finger, Movement, touching};
use crate::sound::{Sound, as_many, some, within};
use crate::{Agent, Csv, Drawing, Sources, rounded};

/// Seconds at which postures are drawn, and the colours of the free and the stopped finger, darker with time.
const POSTURES: [(f64, &str, &str, &str); 5] = [
    (0.0, "at 0 s", "#d0d0d0", "#c6dbef"),
    (0.35, "0.35 s", "#a8a8a8", "#94c0e0"),
    (0.8, "0.8 s", "#808080", "#539ecd"),
    (1.5, "1.5 s", "#505050", "#0072b2"),
    (8.0, "8 s", "#000000", "#003a5c"),
];

/// Colours as in every figure: the policy is the expert's, and its component along the box is the demonstration.
const FREE: &str = Agent::Expert.color();
const STOPPED: &str = Agent::Demonstration.color();
const BOX: &str = "#3c3c3c";
const TIP: &str = "#009e73";

/// The length of an arrow corresponds to this many seconds of movement.
const ARROW_SECONDS: f64 = 0.17;

/// Shorter arrows, radians as drawn, would consist of the head alone, so they are omitted.
const SHORTEST_ARROW: f64 = 0.14;

#[derive(Serialize, Deserialize)]
pub(crate) struct Shown {
    free: Movement,
    stopped: Movement,
    /// Angles at which the tip touches the box: the boundary of the angles at which it would be inside.
    touching: Vec<(f64, f64)>,
    /// (q₁, q₂, u₁, u₂).
    unconstrained: Vec<(f64, f64, f64, f64)>,
    constrained: Vec<(f64, f64, f64, f64)>,
}

impl Sound for Shown {
    const LARGEST: f64 = 10.0;

    fn check(&self) -> anyhow::Result<()> {
        for Movement { angles, places } in [&self.free, &self.stopped] {
            as_many("angles", angles, Movement::SAMPLES)?;
            as_many("places", places, Movement::SAMPLES)?;
            let places: Vec<f64> = places.iter().flatten().flat_map(|&(x, y)| [x, y]).collect();
            within("places", &places, 1.0)?;
        }
        some("arrows", &self.unconstrained)?;
        some("arrows at the box", &self.constrained)?;
        anyhow::ensure!(self.touching.len() > 2, "angles that touch: {}", self.touching.len());
        Ok(())
    }
}

pub(crate) fn shown() -> anyhow::Result<Shown> {
    let finger = Finger::new()?;
    let contact = finger.contact()?;
    let touching: Vec<_> = touching(72).into_iter().map(|(a, b)| (rounded(a, 4), rounded(b, 4))).collect();
    let action = |(a, b): (f64, f64), constraint: &dyn PfaffianConstraint| {
        let q = dvector![a, b];
        let action = finger.policy.action(q.as_view());
        let left = constraint.null_space_projector(q.as_view(), 0.0)?.project(action.as_view());
        anyhow::Ok((rounded(a, 4), rounded(b, 4), rounded(left[0], 4), rounded(left[1], 4)))
    };
    let grid = (0..81).map(|i| (f64::from(i % 9 - 4) * 0.45, f64::from(i / 9) * 0.45 - 2.35));
    // Slightly inside (by a thousandth), so that the tip touches despite rounding.
    let pressed = touching.iter().step_by(3).map(|(a, b)| (0.999 * a, 0.999 * b));
    Ok(Shown {
        unconstrained: grid.map(|q| action(q, &Unconstrained { dim: 2 })).collect::<anyhow::Result<_>>()?,
        constrained: pressed.map(|q| action(q, &contact)).collect::<anyhow::Result<_>>()?,
        free: finger.movement(&Unconstrained { dim: 2 })?,
        stopped: finger.movement(&contact)?,
        touching,
    })
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let shown: Shown = sources.document("figure2")?;
    let free = POSTURES.map(|(time, label, color, _)| (time, label, color));
    let stopped = POSTURES.map(|(time, label, _, color)| (time, label, color));
    let corners = vec![(FACE, -0.065), (0.108, -0.065), (0.108, 0.06), (FACE, 0.06)];
    let the_box = Layer::Region { corners, color: BOX, opacity: 1.0 };
    let (free, stopped) = (postures(&shown.free, free), postures(&shown.stopped, stopped));
    let panels = [
        place("(a) free", free),
        place("(b) along a box", [the_box].into_iter().chain(stopped).collect()),
        angles(&shown),
    ];
    let [a, b, c] = &panels;
    let tables = vec![table("free", &shown.free), table("along_box", &shown.stopped)];
    Ok(Drawing { picture: Picture::rows(&[&[a, b, c]]), tables })
}

/// A plane with the positions of the finger, metres.
fn place(title: &str, layers: Vec<Layer>) -> Plane {
    let (x, y) = ([-0.015, 0.115], [-0.07, 0.065]);
    Plane {
        title: title.to_owned(),
        x_label: "x (m)".to_owned(),
        y_label: "y (m)".to_owned(),
        x,
        y,
        layers,
        size: (390.0, 440.0),
    }
}

/// The finger at a few times, and the path of its tip.
fn postures(movement: &Movement, times: [(f64, &'static str, &'static str); 5]) -> Vec<Layer> {
    let tip = movement.places.iter().map(|places| places[2]).collect();
    let way = Layer::Path {
        points: tip,
        stroke: Stroke { color: TIP, width: 1.4, dash: Dash::Dotted },
        label: Some("tip".to_owned()),
    };
    let posture = |(time, label, color): (f64, &'static str, &'static str)| {
        let points = movement.places[Movement::sample(time)].to_vec();
        let stroke = Stroke { color, width: 3.5, dash: Dash::Solid };
        [
            Layer::Path { points: points.clone(), stroke, label: Some(str::to_owned(label)) },
            Layer::Dots { points, color, radius: 3.5 },
        ]
    };
    times.into_iter().flat_map(posture).chain([way]).collect()
}

/// Both movements in joint space, radians.
fn angles(shown: &Shown) -> Plane {
    let long = |&&(_, _, u, v): &&(f64, f64, f64, f64), seconds: f64| seconds * u.hypot(v) >= SHORTEST_ARROW;
    let arrows = |arrows: &[_], color, width, seconds, label| Layer::Arrows {
        arrows: arrows.iter().filter(|arrow| long(arrow, seconds)).copied().collect(),
        color,
        scale: seconds,
        width,
        label: Some(str::to_owned(label)),
    };
    let path = |movement: &Movement, color, width, dash, label| Layer::Path {
        points: movement.angles.clone(),
        stroke: Stroke { color, width, dash },
        label: Some(str::to_owned(label)),
    };
    let start = Layer::Marks {
        points: vec![shown.free.angles[0]],
        mark: Mark::Circle,
        color: TIP,
        size: 4.0,
        label: Some("start".to_owned()),
    };
    let inside = Layer::Region { corners: shown.touching.clone(), color: BOX, opacity: 0.25 };
    let layers = vec![
        inside,
        arrows(&shown.unconstrained, FREE, 1.0, ARROW_SECONDS, "policy"),
        path(&shown.free, FREE, 2.0, Dash::Dashed, "free movement"),
        path(&shown.stopped, STOPPED, 3.0, Dash::Solid, "with the box"),
        arrows(&shown.constrained, STOPPED, 1.8, 2.0 * ARROW_SECONDS, "at the box (× 2)"),
        start,
        Layer::Words { at: (-0.3, 0.43), text: "in the box".to_owned() },
    ];
    let (title, x, y) = ("(c) both, in joint space".to_owned(), [-2.0, 2.0], [-2.5, 1.5]);
    Plane {
        title, x_label: "q₁ (rad)".to_owned(), y_label: "q₂ (rad)".to_owned(), x, y, layers, size: (390.0, 440.0)
    }
}

fn table(name: &'static str, movement: &Movement) -> Csv {
    let header = ["seconds", "q1", "q2", "tip_x", "tip_y"].map(str::to_owned).to_vec();
    let row = |sample: usize| {
        let ((a, b), [.., tip]) = (movement.angles[sample], movement.places[sample]);
        vec![Movement::time(sample), a, b, tip.0, tip.1]
    };
    Csv { name, header, rows: (0..movement.angles.len()).map(row).collect() }
}
