//! A case beyond the paper, in the plane: the demonstrations, the policy of each learner, and the uncertainty of the
//! slope GP.

use align::{Bandwidth, DirectPolicyLearning, Integration, LwprRegressor, PolicyAlign};
use demo_gen::{Sinusoidal, demonstrations};
use experiments::case_on_the_plane;
use experiments::seed::generator;
use motion::{Learner as _, LearntPolicy, NegativeGradient, Policy as _, Potential as _};
use nalgebra::DVector;
use plot::{Field, Layer, Picture, Plane};
use serde::{Deserialize, Serialize};

use crate::Agent;
use crate::sound::{Sound, field, some};
use crate::state_plane::{Arrow, actions, compared, on_grid, state_plane};
use crate::{Drawing, Sources, demonstrated, rounded};

/// Starts of the movements are drawn from [−2, 2]².
const EXTENT: f64 = 2.0;

/// The length of an arrow corresponds to this many seconds of movement.
const ARROW_SECONDS: f64 = 7.0;

/// Longer actions are cut to this length.
const LONGEST: f64 = 0.2;

/// Half the number of steps of a colour field across the plane.
const STEPS: i32 = 20;

/// Smaller errors are shown as this value.
const LEAST_ERROR: f64 = 1e-9;

/// Sizes in pixels, without and with a colour scale.
const SIZE: (f64, f64) = (330.0, 350.0);
const SIZE_WITH_SCALE: (f64, f64) = (430.0, 350.0);

/// The first data set of ten movements, and the policies learnt from it. Arrows are (x₁, x₂, u₁, u₂).
#[derive(Serialize, Deserialize)]
pub(crate) struct Fields {
    movements: Vec<Vec<(f64, f64)>>,
    contours: Field,
    truth: Vec<Arrow>,
    naive: Vec<Arrow>,
    policy_align: Vec<Arrow>,
    direct_gp: Vec<Arrow>,
    slope_gp: Vec<Arrow>,
    /// log₁₀ of the standard deviation that the slope GP estimates for its policy.
    expected: Field,
    /// log₁₀ of the distance between its policy and the truth.
    error: Field,
}

impl Sound for Fields {
    const LARGEST: f64 = 20.0;

    fn check(&self) -> anyhow::Result<()> {
        some("movements", &self.movements)?;
        self.movements.iter().try_for_each(|movement| some("points of a movement", movement))?;
        let arrows = [&self.truth, &self.naive, &self.policy_align, &self.direct_gp, &self.slope_gp];
        arrows.into_iter().try_for_each(|arrows| some("arrows", arrows))?;
        [&self.contours, &self.expected, &self.error].into_iter().try_for_each(|values| field("field", values))
    }
}

pub(crate) fn fields(seed: u64) -> anyhow::Result<Fields> {
    let (number, system, gaussians) = case_on_the_plane();
    let mut rng = generator(seed, number, 0);
    let recordings = system.record(&mut rng)?;
    let demonstrations = demonstrations(&recordings)?;
    let naive =
        DirectPolicyLearning::default().learn(&demonstrations, &[], &mut rng).map_err(anyhow::Error::from_boxed)?;
    let (bandwidth, integration) = (Bandwidth::Medium, Integration::Velocity);
    let aligned = PolicyAlign { bandwidth, integration, ..PolicyAlign::default() }.align(&demonstrations)?;
    let policy_align = aligned.learn(&LwprRegressor::default(), &mut rng)?;
    let both = gaussians.both(&demonstrations, &[], &mut rng)?;
    let potential = Sinusoidal { amplitude: 0.1 };
    let truth = NegativeGradient(&potential);
    let error = |x: &DVector<f64>| (both.slope().action(x.as_view()) - truth.action(x.as_view())).norm();
    let expected = |x: &DVector<f64>| {
        let mut deviation = DVector::zeros(2);
        both.slope().action_sd_into(x.as_view(), deviation.as_view_mut());
        deviation.norm()
    };
    let points = |recording: &demo_gen::Recording| {
        recording.observed.states().column_iter().map(|x| (rounded(x[0], 4), rounded(x[1], 4))).collect()
    };
    let logarithm = |value: f64| rounded(value.max(LEAST_ERROR).log10(), 3);
    Ok(Fields {
        movements: recordings.iter().map(points).collect(),
        contours: on_grid(EXTENT, STEPS, |x| rounded(potential.value(x.as_view()), 5))?,
        truth: actions(&truth, LONGEST),
        naive: actions(&*naive, LONGEST),
        policy_align: actions(&policy_align, LONGEST),
        direct_gp: actions(both.direct(), LONGEST),
        slope_gp: actions(both.slope(), LONGEST),
        expected: on_grid(EXTENT, STEPS, |x| logarithm(expected(x)))?,
        error: on_grid(EXTENT, STEPS, |x| logarithm(error(x)))?,
    })
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let fields: Fields = sources.document("beyond_fields")?;
    let movements = || fields.movements.iter().map(|movement| (&movement[..], true));
    let plane = |title: &str, layers| state_plane(title, EXTENT, layers, SIZE);
    let learnt = |title: &str, learnt: &[Arrow], agent: Agent| {
        plane(title, compared(&fields.truth, learnt, agent, ARROW_SECONDS))
    };
    let range = range_of([&fields.expected, &fields.error]);
    let sure = |title: &str, values: &Field| {
        let name = "log₁₀ (1/s)".to_owned();
        let colors = Layer::Colors { field: values.clone(), name, range: Some(range) };
        let inside = |(x, y): &(f64, f64)| x.abs() <= EXTENT && y.abs() <= EXTENT;
        let ways = movements().map(|(points, _)| Layer::Path {
            points: points.iter().copied().filter(inside).collect(),
            stroke: Agent::Demonstration.stroke(1.4),
            label: None,
        });
        state_plane(title, EXTENT, std::iter::once(colors).chain(ways).collect(), SIZE_WITH_SCALE)
    };
    let panels: [Plane; 7] = [
        plane("(a) Ten constrained movements", demonstrated::layers(&fields.contours, movements(), 1.6)),
        learnt("(b) Naive", &fields.naive, Agent::Naive),
        learnt("(c) PolicyAlign", &fields.policy_align, Agent::PolicyAlign),
        learnt("(d) Direct GP", &fields.direct_gp, Agent::DirectGp),
        learnt("(e) Slope GP", &fields.slope_gp, Agent::SlopeGp),
        sure("(f) Slope GP: error it expects", &fields.expected),
        sure("(g) Slope GP: true error", &fields.error),
    ];
    let [a, b, c, d, e, f, g] = &panels;
    Ok(Drawing { picture: Picture::rows(&[&[a, b, c, d], &[e, f, g]]), tables: vec![] })
}

/// Smallest and largest value of all fields, for a common colour scale.
fn range_of<'f>(fields: impl IntoIterator<Item = &'f Field>) -> [f64; 2] {
    let values = fields.into_iter().flat_map(|field| field.values().iter().flatten());
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| [low.min(value), high.max(value)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_scale_holds_both_fields() {
        let field = |values: [f64; 2]| Field::new(vec![0.0, 1.0], vec![0.0, 1.0], vec![values.to_vec(); 2]).unwrap();
        assert_eq!(range_of([&field([-6.7, -2.5]), &field([-8.0, -2.9])]), [-8.0, -2.5]);
    }
}
