//! Joint states in, velocities out: the prediction where the robot may move, and zero with a reason elsewhere.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod models;

use std::sync::OnceLock;
use std::time::Duration;

use models::{slope, toy};
use motion::Policy as _;
use nalgebra::{DVector, dmatrix, dvector};
use policy_align::{ControllerError, Halt, Model, Quantity, VelocityCommand, VelocityController};
use proptest::prelude::*;

/// A model with channels x and y.
fn model() -> &'static Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL.get_or_init(|| slope(&toy(20, 20)))
}

fn words(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn pairs(pairs: &[(&str, &str)]) -> Vec<(String, String)> {
    pairs.iter().map(|&(channel, joint)| (channel.to_owned(), joint.to_owned())).collect()
}

const NOW: Duration = Duration::from_secs(7);
const STALE: f64 = 0.2;

fn controller() -> VelocityController<'static> {
    VelocityController::new(model(), &[], STALE).unwrap()
}

/// The command when x and y are known.
fn at(controller: &mut VelocityController<'_>, [x, y]: [f64; 2]) -> VelocityCommand {
    controller.observe(&words(&["x", "y"]), &[x, y], NOW);
    controller.command(NOW)
}

fn stands(command: &VelocityCommand) -> bool {
    command.halt.is_some() && command.velocities == DVector::zeros(2)
}

/// Coordinates within the data of most movements.
const WITHIN: std::ops::Range<f64> = -0.4..0.4;

proptest! {
    /// Supported states yield the policy's action bit for bit; others stop the robot.
    #[test]
    fn supported_states_give_the_policys_action(x in -4.0..4.0f64, y in -4.0..4.0f64) {
        let (policy, command) = (model().policy(), at(&mut controller(), [x, y]));
        let support = command.support.unwrap();
        if policy.is_supported(dvector![x, y].as_view()) {
            prop_assert_eq!(&command.halt, &None);
            let expected = policy.actions(dmatrix![x; y].as_view());
            prop_assert_eq!(command.velocities.as_slice(), expected.as_slice());
        } else {
            prop_assert!(stands(&command));
            prop_assert_eq!(command.halt, Some(Halt::Outside { support }));
        }
        prop_assert_eq!(command.age, Some(0.0));
    }

    /// Joints are found by name, in any order, among others, and in separate messages.
    #[test]
    fn joints_are_found_in_any_message_order(
        [x, y] in prop::array::uniform2(WITHIN),
        order in Just(vec![("x", 0), ("y", 1), ("grip", 2), ("wrist", 3)]).prop_shuffle(),
        cut in 0..=4usize,
    ) {
        let values = [x, y, 100.0, f64::NAN];
        let expected = at(&mut controller(), [x, y]);
        prop_assert!(expected.halt.is_none() && expected.velocities.norm() > 0.0);
        let mut controller = controller();
        for part in [&order[..cut], &order[cut..]] {
            let names: Vec<&str> = part.iter().map(|(name, _)| *name).collect();
            let positions: Vec<f64> = part.iter().map(|(_, at)| values[*at]).collect();
            controller.observe(&words(&names), &positions, NOW);
        }
        prop_assert_eq!(controller.command(NOW), expected);
    }

    /// The command has the order of the requested joints, whatever their names.
    #[test]
    fn permuted_joints_permute_the_command([x, y] in prop::array::uniform2(WITHIN)) {
        let expected = at(&mut controller(), [x, y]).velocities;
        let mut permuted = VelocityController::new(model(), &pairs(&[("y", "lift"), ("x", "turn")]), STALE).unwrap();
        prop_assert_eq!(permuted.joints(), words(&["lift", "turn"]));
        permuted.observe(&words(&["turn", "lift"]), &[x, y], NOW);
        let command = permuted.command(NOW);
        prop_assert_eq!(command.halt, None);
        prop_assert_eq!(command.velocities, dvector![expected[1], expected[0]]);
    }

    /// The oldest position counts.
    #[test]
    fn stale_states_stop([x, y] in prop::array::uniform2(WITHIN), age in 0.0..0.4f64, later in 0.0..1.0f64) {
        let mut controller = controller();
        controller.observe(&words(&["x", "y"]), &[x, y], NOW);
        let age = Duration::from_secs_f64(age);
        controller.observe(&words(&["x"]), &[x], NOW + age.mul_f64(later));
        let command = controller.command(NOW + age);
        prop_assert_eq!(command.age, Some(age.as_secs_f64()));
        if age > Duration::from_secs_f64(STALE) {
            prop_assert!(stands(&command));
            prop_assert_eq!(command.halt, Some(Halt::Stale { joint: "y".to_owned(), age: age.as_secs_f64() }));
        } else {
            prop_assert_eq!(&command.halt, &None);
            prop_assert_eq!(command.velocities, at(&mut controller, [x, y]).velocities);
        }
        // A new message restarts it.
        controller.observe(&words(&["y", "x"]), &[y, x], NOW + 2 * age);
        prop_assert_eq!(controller.command(NOW + 2 * age).halt, None);
    }

    #[test]
    fn positions_that_are_no_numbers_stop(
        value in prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
        other in WITHIN,
        first in any::<bool>(),
    ) {
        let (name, state) = if first { ("x", [value, other]) } else { ("y", [other, value]) };
        let mut controller = controller();
        let command = at(&mut controller, state);
        prop_assert!(stands(&command));
        match command.halt {
            Some(Halt::NotFinite { quantity: Quantity::Position, joint, value: found }) => {
                prop_assert_eq!(joint, name);
                prop_assert_eq!(found.to_bits(), value.to_bits());
            }
            halt => prop_assert!(false, "{halt:?}"),
        }
        prop_assert_eq!(at(&mut controller, [other, other]).halt, None);
    }

    /// The speed limit is reached in the same direction.
    #[test]
    fn speed_is_limited_by_one_factor([x, y] in prop::array::uniform2(WITHIN), limit in 1e-3..2.0f64) {
        let free = at(&mut controller(), [x, y]).velocities;
        let slowed = at(&mut controller().with_max_speed(limit).unwrap(), [x, y]).velocities;
        if free.amax() <= limit {
            prop_assert_eq!(slowed, free);
        } else {
            prop_assert!((slowed.amax() / limit - 1.0).abs() < 1e-12);
            prop_assert!((free.normalize() - slowed.normalize()).norm() < 1e-12);
        }
    }

    /// Channels in degrees and centimetres are converted to the robot's radians and metres.
    #[test]
    fn units_are_converted([x, y] in prop::array::uniform2(WITHIN)) {
        let mut model = model().clone();
        model.state[0].unit = Some("deg".to_owned());
        model.state[1].unit = Some("cm".to_owned());
        let expected = model.policy().actions(dmatrix![x; y].as_view());
        let mut controller = VelocityController::new(&model, &[], STALE).unwrap();
        let command = at(&mut controller, [x.to_radians(), 0.01 * y]);
        prop_assert_eq!(command.halt, None);
        let expected = dvector![expected[0].to_radians(), 0.01 * expected[1]];
        prop_assert!((command.velocities - &expected).norm() <= 1e-9 * expected.norm());
    }
}

#[test]
fn missing_joints_stop_and_are_named() {
    let mut controller = controller();
    let halt = |controller: &VelocityController<'_>| {
        let command = controller.command(NOW);
        assert!(stands(&command) && command.age.is_none() && command.support.is_none(), "{command:?}");
        command.halt.unwrap()
    };
    assert_eq!(halt(&controller), Halt::NoState);
    assert_eq!(halt(&controller).to_string(), "no joint state received");
    // Names without positions, as in a message with velocities only.
    controller.observe(&words(&["x", "y"]), &[], NOW);
    assert_eq!(halt(&controller), Halt::Missing { joints: words(&["x", "y"]), found: vec![] });
    assert_eq!(halt(&controller).to_string(), "no position of x, y; joints of the last message: none");
    controller.observe(&words(&["grip", "x"]), &[0.1, 0.2], NOW);
    assert_eq!(halt(&controller), Halt::Missing { joints: words(&["y"]), found: words(&["grip", "x"]) });
    assert_eq!(halt(&controller).to_string(), "no position of y; joints of the last message: grip, x");
    controller.observe(&words(&["y"]), &[0.1], NOW);
    assert_eq!(controller.command(NOW).halt, None);
}

#[test]
fn halt_reasons_name_quantity_and_joint() {
    let text = |state: [f64; 2]| at(&mut controller(), state).halt.unwrap().to_string();
    assert_eq!(text([f64::NAN, 0.0]), "the position of x is NaN");
    assert_eq!(text([0.0, f64::INFINITY]), "the position of y is inf");
    assert_eq!(text([90.0, 0.0]), "the state is outside the data (support 0)");
    let mut controller = controller();
    at(&mut controller, [0.1, 0.1]);
    let halt = controller.command(NOW + Duration::from_millis(350)).halt.unwrap();
    assert_eq!((halt.to_string().as_str(), halt.word()), ("the position of x is 0.35 s old", "stale"));
}

#[test]
fn invalid_controllers_are_refused() {
    let error = |joints: &[(&str, &str)], stale| VelocityController::new(model(), &pairs(joints), stale).unwrap_err();
    let texts = [
        (error(&[("x", "a"), ("z", "b")], 0.2), "the model has no channel 'z'; it has x, y"),
        (error(&[("x", "a"), ("x", "b")], 0.2), "'x' is named twice; each channel is one joint"),
        (error(&[("x", "a"), ("y", "a")], 0.2), "'a' is named twice; each channel is one joint"),
        (error(&[("y", "y")], 0.2), "no joint for x; name one for every channel"),
        (error(&[], 0.0), "stale is 0; it must be positive and finite"),
        (error(&[], f64::NAN), "stale is NaN; it must be positive and finite"),
        (controller().with_max_speed(-1.0).unwrap_err(), "max-speed is -1; it must be positive and finite"),
    ];
    for (error, text) in texts {
        assert_eq!(error.to_string(), text);
    }
    let model = Model { context: model().state[..1].to_vec(), ..model().clone() };
    let open = VelocityController::new(&model, &[], STALE).unwrap_err();
    assert_eq!(open, ControllerError::Context { names: words(&["x"]) });
}
