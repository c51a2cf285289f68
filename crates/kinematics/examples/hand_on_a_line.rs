//! Moves the hand of a planar arm along a straight line with resolved-rate control.

#![allow(clippy::print_stdout, reason = "a program")]

use kinematics::{Joint, KinematicsError, ResolvedRate, RobotModel, Workspace};
use nalgebra::{DVector, Matrix3xX, dvector};

const ARM: &str = r#"
<robot name="arm">
  <link name="base"/> <link name="upper"/> <link name="fore"/> <link name="palm"/> <link name="hand"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="1 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3"/></joint>
  <joint name="wrist" type="revolute"><parent link="fore"/><child link="palm"/>
    <origin xyz="1 0 0"/><axis xyz="0 0 1"/><limit lower="-2" upper="2"/></joint>
  <joint name="tip" type="fixed"><parent link="palm"/><child link="hand"/><origin xyz="0.5 0 0"/></joint>
</robot>"#;

fn main() -> Result<(), KinematicsError> {
    let robot = RobotModel::from_urdf(ARM)?;
    let (hand, n) = (robot.link("hand")?, robot.n_joints());
    let limits: Vec<f64> = robot.joints().iter().map(Joint::upper).collect();
    println!("{}: {n} joints, upper limits {limits:?}", robot.name());

    // 0.2 m/s along x for two seconds; no secondary joint velocity is wanted.
    let (task, pull, time_step) = (dvector![0.2, 0.0, 0.0], DVector::zeros(n), 0.01);
    let (mut workspace, mut control) = (Workspace::new(), ResolvedRate::new(1e-3)?);
    let (mut jacobian, mut velocity) = (Matrix3xX::zeros(n), DVector::zeros(n));
    let mut q = dvector![0.3, 0.8, 0.9];
    for step in 0..=200 {
        let poses = robot.forward_kinematics(q.as_view(), &mut workspace)?;
        if step % 50 == 0 {
            let hand = poses.position(hand);
            let seconds = time_step * f64::from(step);
            println!("{seconds:.1} s: hand at x {:.3} m, y {:.3} m; joints {:.2?}", hand.x, hand.y, q.as_slice());
        }
        poses.position_jacobian(hand, &mut jacobian)?;
        control.velocity(&jacobian, task.as_view(), pull.as_view(), velocity.as_view_mut())?;
        q += time_step * &velocity;
    }
    println!("joints beyond their limits: {}", robot.n_beyond_limits(q.as_view())?);
    Ok(())
}
