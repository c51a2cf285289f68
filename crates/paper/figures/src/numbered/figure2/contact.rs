//! Simulation of a finger with two joints that stretches, and a box that stops its tip.

use constraints::{ConstraintError, PfaffianConstraint, PointConstraint};
use demo_gen::{Parabola, RollOut, hand_jacobian};
use kinematics::{LinkId, RobotModel, Workspace};
use motion::{NegativeGradient, Policy};
use nalgebra::{DMatrix, DVector, DVectorView, dmatrix};
use serde::{Deserialize, Serialize};

use crate::rounded;

/// Lengths of the two links, metres.
const LINKS: [f64; 2] = [0.05, 0.04];

/// Both joints at the start, radians.
const START: [f64; 2] = [1.0, -2.4];

/// The x coordinate of the box's face that stops the tip, metres.
pub(super) const FACE: f64 = 0.07;

/// Steps of 0.1 ms, so that the tip penetrates the box by at most its motion in one step. Eight seconds, until
/// everything is at rest.
const ROLL_OUT: RollOut = RollOut { time_step: 0.05, n_samples: 161, sub_steps: 500 };

/// Two links in the plane, and the policy that stretches the finger.
pub(super) struct Finger {
    robot: RobotModel,
    links: [LinkId; 3],
    pub(super) policy: NegativeGradient<Parabola>,
}

/// A movement, sample by sample.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Movement {
    /// Both joints, radians.
    pub(super) angles: Vec<(f64, f64)>,
    /// Positions of both joints and the tip in the plane, metres.
    pub(super) places: Vec<[(f64, f64); 3]>,
}

/// While the tip is at the face and the policy presses against it, nᵀJ(q) u = 0; otherwise unconstrained.
pub(super) struct Contact<'a> {
    finger: &'a Finger,
    face: Box<dyn PfaffianConstraint>,
}

impl PfaffianConstraint for Contact<'_> {
    fn dim(&self) -> usize {
        2
    }

    fn matrix(&self, state: DVectorView<'_, f64>, time: f64) -> Result<DMatrix<f64>, ConstraintError> {
        let into_box = self.face.matrix(state, time)?;
        let touches = self.finger.places(state).is_ok_and(|[.., tip]| tip.0 >= FACE);
        let presses = (&into_box * self.finger.policy.action(state))[0] > 0.0;
        Ok(if touches && presses { into_box } else { DMatrix::zeros(0, 2) })
    }
}

impl Finger {
    pub(super) fn new() -> anyhow::Result<Self> {
        let [first, second] = LINKS;
        let robot = RobotModel::from_urdf(&format!(
            r#"<robot name="finger"><link name="palm"/><link name="first"/><link name="second"/><link name="tip"/>
            <joint name="knuckle" type="continuous"><parent link="palm"/><child link="first"/><axis xyz="0 0 1"/></joint>
            <joint name="middle" type="continuous"><parent link="first"/><child link="second"/>
              <origin xyz="{first} 0 0"/><axis xyz="0 0 1"/></joint>
            <joint name="end" type="fixed"><parent link="second"/><child link="tip"/><origin xyz="{second} 0 0"/></joint></robot>"#
        ))?;
        let links = [robot.link("first")?, robot.link("second")?, robot.link("tip")?];
        Ok(Finger { robot, links, policy: NegativeGradient(Parabola { weight: 0.5, centre: DVector::zeros(2) }) })
    }

    /// Positions of both joints and the tip, metres.
    pub(super) fn places(&self, q: DVectorView<'_, f64>) -> anyhow::Result<[(f64, f64); 3]> {
        let mut workspace = Workspace::new();
        let poses = self.robot.forward_kinematics(q, &mut workspace)?;
        Ok(self.links.map(|link| (poses.position(link).x, poses.position(link).y)))
    }

    /// The constraint by the box.
    pub(super) fn contact(&self) -> anyhow::Result<Contact<'_>> {
        let jacobian = hand_jacobian(&self.robot, &self.robot.chain(self.links[2]));
        let face = PointConstraint::new(dmatrix![1.0, 0.0, 0.0], 2, jacobian)?;
        Ok(Contact { finger: self, face: Box::new(face) })
    }

    /// The movement from the start under a constraint.
    pub(super) fn movement(&self, constraint: &dyn PfaffianConstraint) -> anyhow::Result<Movement> {
        let recording = ROLL_OUT.record(&self.policy.0, constraint, DVector::from_column_slice(&START).as_view())?;
        let mut movement = Movement::default();
        for q in recording.observed.states().column_iter() {
            movement.angles.push((rounded(q[0], 5), rounded(q[1], 5)));
            movement.places.push(self.places(q)?.map(|(x, y)| (rounded(x, 7), rounded(y, 7))));
        }
        Ok(movement)
    }
}

impl Movement {
    /// Number of samples of each movement.
    pub(super) const SAMPLES: usize = ROLL_OUT.n_samples;

    /// Index of the sample at a time in seconds.
    pub(super) fn sample(time: f64) -> usize {
        (time / ROLL_OUT.time_step).round() as usize
    }

    /// The time of a sample in seconds.
    pub(super) fn time(sample: usize) -> f64 {
        rounded(sample as f64 * ROLL_OUT.time_step, 6)
    }
}

/// Angles at which the tip touches the face, in `steps` evenly spaced directions around zero. Along any ray from zero
/// the tip draws back.
pub(super) fn touching(steps: u32) -> Vec<(f64, f64)> {
    let [first, second] = LINKS;
    let on_ray = |step: u32| {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(step) / f64::from(steps)).sin_cos();
        let (mut inside, mut outside) = (0.0, 1.8);
        for _ in 0..50 {
            let middle = f64::midpoint(inside, outside);
            let (a, b) = (middle * cosine, middle * (sine + cosine));
            if first * a.cos() + second * b.cos() > FACE { inside = middle } else { outside = middle }
        }
        (inside * cosine, inside * sine)
    };
    (0..steps).map(on_ray).collect()
}

#[cfg(test)]
mod tests {
    use constraints::Unconstrained;

    use super::*;

    /// A hundredth of a millimetre.
    const HAIR: f64 = 1e-5;

    fn tips(movement: &Movement) -> Vec<(f64, f64)> {
        movement.places.iter().map(|places| places[2]).collect()
    }

    #[test]
    fn the_tip_slides_along_the_box_and_never_enters_it() {
        let finger = Finger::new().unwrap();
        let movement = finger.movement(&finger.contact().unwrap()).unwrap();
        let tips = tips(&movement);
        let touched = tips.iter().position(|tip| tip.0 > FACE - HAIR).unwrap();
        assert!(Movement::time(touched) < 1.0);
        for (sample, tip) in tips.iter().enumerate() {
            assert!(tip.0 < FACE + HAIR, "{tip:?}");
            assert!(sample < touched || tip.0 > FACE - HAIR, "{tip:?}");
        }
        assert!(tips[touched].1 - tips[160].1 > 0.05);
    }

    #[test]
    fn tip_rests_where_the_policy_is_normal_to_the_face() {
        let finger = Finger::new().unwrap();
        let contact = finger.contact().unwrap();
        let movement = finger.movement(&contact).unwrap();
        let (a, b) = movement.angles[160];
        let q = DVector::from_vec(vec![a, b]);
        let action = finger.policy.action(q.as_view());
        let across = contact.face.matrix(q.as_view(), 0.0).unwrap().transpose().normalize();
        assert!((action.normalize() - across.column(0)).norm() < 0.01);
    }

    #[test]
    fn an_unconstrained_finger_stretches() {
        let finger = Finger::new().unwrap();
        let movement = finger.movement(&Unconstrained { dim: 2 }).unwrap();
        for (sample, (a, b)) in movement.angles.iter().enumerate() {
            let left = (-Movement::time(sample)).exp();
            assert!((a - START[0] * left).abs() < 1e-3 && (b - START[1] * left).abs() < 1e-3);
        }
        let (x, y) = tips(&movement)[160];
        assert!((x - 0.09).abs() < 1e-5 && y.abs() < 1e-4);
    }

    #[test]
    fn the_angles_that_touch_have_the_tip_at_the_face() {
        let finger = Finger::new().unwrap();
        for (a, b) in touching(40) {
            let [.., tip] = finger.places(DVector::from_vec(vec![a, b]).as_view()).unwrap();
            assert!((tip.0 - FACE).abs() < 1e-12);
        }
    }
}
