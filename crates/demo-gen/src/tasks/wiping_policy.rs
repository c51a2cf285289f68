use kinematics::{Chain, KinematicsError, Workspace};
use motion::Policy;
use nalgebra::{DVector, DVectorView, DVectorViewMut, Matrix3xX, Vector3};

/// A policy that circles the tool of an arm about a vertical axis, in the manner of resolved-rate control:
/// π(q) = J⁺v(p) + (I − J⁺J) k(q₀ − q), with p the tool's position, J its Jacobian (3, n) and r = (p − c) in the horizontal plane,
/// v = ω [e_z × r + r (R² − |r|²)/(R² + |r|²) + (c_z − p_z) e_z]. It does not depend on the surface that is wiped, and has no potential.
#[derive(Debug, Clone)]
pub struct WipingPolicy {
    /// The joints that lead to the tool.
    pub(super) tool: Chain,
    /// c, in metres in the root link's frame.
    pub(super) centre: Vector3<f64>,
    /// R, in metres.
    pub(super) radius: f64,
    /// ω, in 1/s.
    pub(super) rate: f64,
    /// q₀, (n).
    pub(super) posture: DVector<f64>,
    /// k, in 1/s.
    pub(super) posture_rate: f64,
}

impl WipingPolicy {
    /// v(p), in metres per second.
    pub fn tool_velocity(&self, position: Vector3<f64>) -> Vector3<f64> {
        let away = position - self.centre;
        let (squared, radius) = (away.xy().norm_squared(), self.radius * self.radius);
        let outward = (radius - squared) / (radius + squared);
        self.rate * Vector3::new(outward * away.x - away.y, outward * away.y + away.x, -away.z)
    }

    /// π(q), (n); not finite if the arm is singular.
    fn act(&self, q: DVectorView<'_, f64>) -> Result<DVector<f64>, KinematicsError> {
        let mut jacobian = Matrix3xX::zeros(q.len());
        let position = self.tool.position_jacobian(q, &mut Workspace::new(), &mut jacobian)?;
        let rest = self.posture_rate * (&self.posture - q);
        let missing = self.tool_velocity(position.coords) - &jacobian * &rest;
        let gram = &jacobian * jacobian.transpose();
        let solved = gram.cholesky().map_or(Vector3::repeat(f64::NAN), |factor| factor.solve(&missing));
        Ok(rest + jacobian.transpose() * solved)
    }
}

impl Policy for WipingPolicy {
    fn dim(&self) -> usize {
        self.posture.len()
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        match self.act(state) {
            Ok(acted) => action.copy_from(&acted),
            Err(_) => action.fill(f64::NAN), // the recorder rejects it
        }
    }
}
