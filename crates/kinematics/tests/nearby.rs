//! Links near each other: distances that continue below zero, and separating directions.
use crate::two_shapes::{resolver, two_shapes};
use kinematics::{LinkId, Nearby, RobotModel, SelfCollision, Workspace};
use nalgebra::{DVector, Vector3, dvector};
use proptest::prelude::*;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

/// Accuracy of the collision library's distances, metres.
const EXACT: f64 = 5e-5;

fn upper_body() -> (RobotModel, SelfCollision) {
    let robot = RobotModel::from_urdf(include_str!("../../../robots/asimo_upper_body.urdf")).unwrap();
    let mut collision = SelfCollision::new(&robot, |_| None).unwrap();
    collision.disable_srdf(include_str!("../../../robots/asimo_upper_body.srdf")).unwrap();
    (robot, collision)
}

/// The pairs nearer than `within`, each with its gradient.
fn nearby(
    (robot, collision): &(RobotModel, SelfCollision),
    q: &DVector<f64>,
    within: f64,
) -> Vec<(Nearby, DVector<f64>)> {
    let mut workspace = Workspace::new();
    let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
    collision.nearby(&poses, within).into_iter().map(|near| (near, near.gradient(&poses))).collect()
}

fn distance(body: &(RobotModel, SelfCollision), q: &DVector<f64>, links: (LinkId, LinkId)) -> Option<f64> {
    nearby(body, q, 1.0).into_iter().find(|(near, _)| near.links == links).map(|(near, _)| near.distance)
}

proptest! {
    #[test]
    fn agrees_with_clearance_and_collisions(seed in any::<u64>(), within in 0.0..0.3f64) {
        let body = upper_body();
        let (robot, collision) = &body;
        let q = robot.random_configuration(&mut ChaCha8Rng::seed_from_u64(seed));
        let mut workspace = Workspace::new();
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace).unwrap();
        let found = collision.nearby(&poses, within);
        let pairs: Vec<_> = collision.pairs().collect();
        let mut least = within;
        for near in &found {
            prop_assert!(near.distance < within && pairs.contains(&near.links));
            let across = near.points.1 - near.points.0;
            prop_assert!((across - *near.normal * near.distance).amax() < EXACT, "{near:?}");
            least = least.min(near.distance);
        }
        let clearance = collision.clearance(&poses).unwrap().distance;
        prop_assert!((least.max(0.0) - clearance.min(within)).abs() < EXACT, "{least} {clearance}");
        let touching = collision.colliding_pairs(&poses);
        for links in pairs {
            let distance = found.iter().find(|near| near.links == links).map(|near| near.distance);
            if touching.contains(&links) {
                prop_assert!(distance.is_none_or(|distance| distance < EXACT));
                prop_assert!(within < EXACT || distance.is_some());
            } else {
                prop_assert!(distance.is_none_or(|distance| distance > -EXACT));
            }
        }
    }

    /// The gradient is between the slopes to either side, which differ where the nearest point jumps from one
    /// edge to another.
    #[test]
    fn the_gradient_is_the_slope(seed in any::<u64>(), way in proptest::collection::vec(-1.0..1.0f64, 22)) {
        const STEP: f64 = 1e-3;
        let body = upper_body();
        let q = body.0.random_configuration(&mut ChaCha8Rng::seed_from_u64(seed));
        let way = DVector::from_vec(way).normalize();
        for (near, gradient) in nearby(&body, &q, 0.2) {
            let after = distance(&body, &(&q + &way * STEP), near.links);
            let before = distance(&body, &(&q - &way * STEP), near.links);
            let (Some(after), Some(before)) = (after, before) else { continue };
            let slopes = [(near.distance - before) / STEP, (after - near.distance) / STEP];
            let slope = gradient.dot(&way);
            let (low, high) = (slopes[0].min(slopes[1]), slopes[0].max(slopes[1]));
            prop_assert!(low - 0.03 < slope && slope < high + 0.03, "{near:?}: {slope}, by differences {slopes:?}");
        }
    }
}

/// Shapes that extend 0.3 along x, up to one metre apart: results on both sides of contact.
#[test]
fn known_places_and_depths() {
    for (first, second) in [
        (r#"<sphere radius="0.3"/>"#, r#"<sphere radius="0.3"/>"#),
        (r#"<box size="0.6 0.8 0.8"/>"#, r#"<sphere radius="0.3"/>"#),
        (r#"<capsule radius="0.3" length="0.4"/>"#, r#"<box size="0.6 0.8 0.8"/>"#),
        (r#"<cylinder radius="0.3" length="0.9"/>"#, r#"<mesh filename="hull" scale="0.3 0.4 0.4"/>"#),
        (r#"<mesh filename="surface" scale="0.3 0.4 0.4"/>"#, r#"<sphere radius="0.3"/>"#),
    ] {
        let robot = two_shapes(first, second);
        let body = (robot.clone(), SelfCollision::new(&robot, resolver).unwrap());
        for distance in [0.4, 0.05, 1e-3, -1e-3, -0.05] {
            let found = nearby(&body, &dvector![0.6 + distance, 0.0], 0.5);
            let [(near, gradient)] = &found[..] else { panic!("{first} {second} {distance}: {found:?}") };
            assert!((near.distance - distance).abs() < EXACT, "{first} {second} {distance}: {near:?}");
            assert!((*near.normal - Vector3::x()).amax() < 1e-2, "{first} {second} {distance}: {near:?}");
            assert!((gradient - dvector![1.0, 0.0]).amax() < 1e-2, "{first} {second} {distance}: {gradient}");
            assert!((near.points.0.x - 0.3).abs() < 1e-3 && (near.points.1.x - 0.3 - distance).abs() < 1e-3);
        }
        assert!(nearby(&body, &dvector![1.2, 0.0], 0.5).is_empty());
    }
}

/// A point on the link of a mimic joint moves with the followed joint.
#[test]
fn mimic_joints_count_towards_the_followed_joint() {
    let sphere = r#"<collision><geometry><sphere radius="0.1"/></geometry></collision>"#;
    let robot = RobotModel::from_urdf(&format!(
        r#"<robot name="r"><link name="a">{sphere}</link><link name="m"/><link name="b">{sphere}</link>
           <joint name="j" type="prismatic"><parent link="a"/><child link="m"/><limit lower="-9" upper="9"/></joint>
           <joint name="k" type="prismatic"><parent link="m"/><child link="b"/><limit lower="-9" upper="9"/>
             <mimic joint="j" multiplier="2"/></joint></robot>"#
    ))
    .unwrap();
    let body = (robot.clone(), SelfCollision::new(&robot, resolver).unwrap());
    let found = nearby(&body, &dvector![0.1], 0.2);
    assert!((found[0].0.distance - 0.1).abs() < EXACT && (found[0].1[0] - 3.0).abs() < 1e-9, "{found:?}");
}

/// Without a way out, as at the centre of a sphere, the result is some direction or none, never NaN.
#[test]
fn coincident_centres_give_finite_results() {
    for shape in [r#"<sphere radius="0.3"/>"#, r#"<box size="1 1 1"/>"#, r#"<capsule radius="0.1" length="1"/>"#] {
        let robot = two_shapes(shape, shape);
        let body = (robot.clone(), SelfCollision::new(&robot, resolver).unwrap());
        for (near, gradient) in nearby(&body, &dvector![0.0, 0.0], 0.1) {
            assert!(near.distance < 0.0 && gradient.iter().all(|part| part.is_finite()), "{shape}: {near:?}");
        }
    }
}
