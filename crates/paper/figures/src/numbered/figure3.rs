//! Fig. 3: projections of a policy by constraints, why averaging them is misleading, and which component remains
//! unknown.

use constraints::NullSpaceProjector;
use nalgebra::{DVector, Point3, dmatrix, dvector};
use plot::{Camera, Dash, Item, Paint, Picture, Space, Stroke};
use serde::{Deserialize, Serialize};

use crate::Agent;
use crate::sound::Sound;
use crate::{Drawing, Sources, rounded};

/// A policy's action: forwards, towards the reader, upwards.
const POLICY: [f64; 3] = [0.8, -0.6, 0.7];

/// The action of another policy, which moves up less.
const OTHER: [f64; 3] = [0.8, -0.6, 0.3];

/// Corners of the vertical and the horizontal plane.
const VERTICAL: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.9], [0.0, 0.0, 0.9]];
const HORIZONTAL: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, -0.8, 0.0], [0.0, -0.8, 0.0]];

const GREY: &str = "#5a5a5a";

/// The other policy's colour, distinct from those of [`Agent`].
const PURPLE: &str = "#9a4a7c";

/// Velocities from one point.
#[derive(Serialize, Deserialize)]
pub(crate) struct Vectors {
    policy: [f64; 3],
    /// Its projections by the vertical and the horizontal constraint.
    seen: [[f64; 3]; 2],
    /// The mean of both projections, and the projections of that mean.
    mean: [f64; 3],
    mean_seen: [[f64; 3]; 2],
    other: [f64; 3],
    /// The projection of the other policy by the horizontal constraint.
    other_seen: [f64; 3],
}

impl Sound for Vectors {
    const LARGEST: f64 = 10.0;
}

pub(crate) fn vectors() -> anyhow::Result<Vectors> {
    let vertical = NullSpaceProjector::new(&dmatrix![0.0, 1.0, 0.0])?;
    let horizontal = NullSpaceProjector::new(&dmatrix![0.0, 0.0, 1.0])?;
    let [policy, other] = [POLICY, OTHER].map(|[x, y, z]| dvector![x, y, z]);
    let seen = |policy: &DVector<f64>| [&vertical, &horizontal].map(|projector| projector.project(policy.as_view()));
    let both = seen(&policy);
    let mean = (&both[0] + &both[1]) / 2.0;
    let plain = |vector: &DVector<f64>| [0, 1, 2].map(|dimension| rounded(vector[dimension], 6));
    Ok(Vectors {
        mean_seen: seen(&mean).each_ref().map(plain),
        other_seen: plain(&seen(&other)[1]),
        seen: both.each_ref().map(plain),
        policy: plain(&policy),
        mean: plain(&mean),
        other: plain(&other),
    })
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let Vectors { policy, seen: [first, second], mean, mean_seen, other, other_seen } = sources.document("figure3")?;
    let (expert, shown, naive) = (Agent::Expert.color(), Agent::Demonstration.color(), Agent::Naive.color());
    let observed = [arrow(first, shown, 3.0), arrow(second, shown, 3.0)];
    let names = [name(first, "x₁", (-4.0, -12.0), shown), name(second, "x₂", (6.0, 8.0), shown)];
    let seen = [
        arrow(policy, expert, 2.4),
        name(policy, "π", (6.0, -8.0), expert),
        down(policy, first, shown),
        down(policy, second, shown),
    ];
    let mut averaged = vec![arrow(policy, GREY, 1.2), name(policy, "π", (-2.0, -9.0), GREY)];
    averaged.extend([arrow(mean, naive, 2.4), name(mean, "mean of both", (8.0, 7.0), naive)]);
    averaged.extend(mean_seen.map(|end| down(mean, end, naive)));
    averaged.push(Item::Dots { points: mean_seen.map(Point3::from).to_vec(), color: naive, radius: 4.0 });
    let alike = [
        arrow(other_seen, shown, 3.0),
        name(other_seen, "x₂", (6.0, 8.0), shown),
        down(policy, other, shown),
        down(other, other_seen, shown),
        arrow(policy, expert, 2.4),
        name(policy, "π", (6.0, -8.0), expert),
        arrow(other, PURPLE, 2.4),
        name(other, "π′", (7.0, 4.0), PURPLE),
    ];
    let both = || vec![plane(VERTICAL), plane(HORIZONTAL)];
    let planes = [
        name([0.0, 0.0, 0.83], "vertical", (4.0, 6.0), GREY),
        name([0.0, -0.78, 0.0], "horizontal", (8.0, -2.0), GREY),
    ];
    let panels = [
        space("(a) two observations of one policy", both(), [&planes[..], &observed, &names, &seen].concat()),
        space("(b) their mean explains neither", both(), [&planes[..], &observed, &names, &averaged].concat()),
        space("(c) two policies, one observation", vec![plane(HORIZONTAL)], [&planes[1..], &alike].concat()),
    ];
    let [a, b, c] = &panels;
    Ok(Drawing { picture: Picture::rows(&[&[a, b, c]]), tables: vec![] })
}

fn space(title: &str, items: Vec<Item>, over: Vec<Item>) -> Space {
    Space {
        title: title.to_owned(),
        camera: Camera { azimuth: -70.0, elevation: 30.0 },
        items,
        over,
        frame: None,
        extent: Some([Point3::new(0.0, -0.8, 0.0), Point3::new(1.0, 0.0, 0.9)]),
        size: (370.0, 330.0),
    }
}

fn plane(corners: [[f64; 3]; 4]) -> Item {
    Item::Plate { corners: corners.map(Point3::from).to_vec(), paint: Paint { color: "#9a9a9a", opacity: 0.3 } }
}

/// A vector from the origin.
fn arrow(to: [f64; 3], color: &'static str, width: f64) -> Item {
    Item::Arrow { from: Point3::origin(), to: to.into(), stroke: Stroke { color, width, dash: Dash::Solid } }
}

/// A line from the end of a vector to the end of its projection.
fn down(from: [f64; 3], to: [f64; 3], color: &'static str) -> Item {
    let stroke = Stroke { color, width: 1.2, dash: Dash::Dashed };
    Item::Path { points: vec![from.into(), to.into()], stroke, label: None }
}

fn name(end: [f64; 3], text: &str, shift: (f64, f64), color: &'static str) -> Item {
    Item::Note { at: end.into(), text: text.to_owned(), shift, color }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constraints_project_onto_their_planes() {
        let Vectors { policy, seen, other, other_seen, .. } = vectors().unwrap();
        assert_eq!(seen, [[policy[0], 0.0, policy[2]], [policy[0], policy[1], 0.0]]);
        assert!(policy != other && other_seen == seen[1]);
    }

    #[test]
    fn the_mean_explains_neither() {
        let Vectors { seen, mean_seen, .. } = vectors().unwrap();
        for (seen, of_mean) in seen.into_iter().zip(mean_seen) {
            assert!((Point3::from(seen) - Point3::from(of_mean)).norm() > 0.2);
        }
    }
}
