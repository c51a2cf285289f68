use kinematics::{Chain, RobotModel, Workspace};
use nalgebra::{DMatrix, DVector, DVectorView, Matrix3xX, Matrix6xX, Point3};

/// The origin of a robot's link as the state moves it. Channels of the state are joints of the same name.
#[derive(Debug, Clone)]
pub(crate) struct LinkPoint {
    chain: Chain,
    n_joints: usize,
    /// For each channel of the state, its joint's place in a configuration.
    places: Vec<usize>,
}

impl LinkPoint {
    /// # Errors
    /// In a sentence: a link that is not there, or a channel that is no joint, or a joint that moves the link and is no
    /// channel.
    pub(crate) fn new(robot: &RobotModel, link: &str, channels: &[String]) -> Result<Self, String> {
        let link = robot.link(link).map_err(|error| error.to_string())?;
        let places = channels.iter().map(|channel| robot.joint(channel).map_err(|error| error.to_string()));
        let places = places.collect::<Result<Vec<_>, _>>()?;
        let mut above = Some(link);
        while let Some(attachment) = above.and_then(|link| robot.attachment(link)) {
            let missing = attachment.joint.filter(|joint| !places.contains(&joint.column));
            if let Some(joint) = missing {
                let name = robot.joints()[joint.column].name();
                return Err(format!("joint '{name}' moves the link and is no channel of the state"));
            }
            above = Some(attachment.parent);
        }
        Ok(LinkPoint { chain: robot.chain(link), n_joints: robot.n_joints(), places })
    }

    /// Where the point is, metres in the root link's frame, and the derivative of that by the state, (3, n).
    ///
    /// # Errors
    /// What the robot says of the configuration.
    pub(crate) fn at(&self, state: DVectorView<'_, f64>) -> Result<(Point3<f64>, DMatrix<f64>), String> {
        let q = self.configuration(state);
        let mut jacobian = Matrix3xX::zeros(self.n_joints);
        let origin = self.chain.position_jacobian(q.as_view(), &mut Workspace::new(), &mut jacobian);
        let origin = origin.map_err(|error| error.to_string())?;
        Ok((origin, DMatrix::from_fn(3, self.places.len(), |row, channel| jacobian[(row, self.places[channel])])))
    }

    /// The derivative of the link's orientation by the state, (3, n): what velocities of the state make of its angular velocity,
    /// in the root link's axes.
    ///
    /// # Errors
    /// What the robot says of the configuration.
    pub(crate) fn turning(&self, state: DVectorView<'_, f64>) -> Result<DMatrix<f64>, String> {
        let q = self.configuration(state);
        let mut jacobian = Matrix6xX::zeros(self.n_joints);
        let pose = self.chain.jacobian(q.as_view(), &mut Workspace::new(), &mut jacobian);
        pose.map_err(|error| error.to_string())?;
        Ok(DMatrix::from_fn(3, self.places.len(), |row, channel| jacobian[(3 + row, self.places[channel])]))
    }

    fn configuration(&self, state: DVectorView<'_, f64>) -> DVector<f64> {
        let mut q = DVector::zeros(self.n_joints);
        for (&place, &x) in self.places.iter().zip(state.iter()) {
            q[place] = x;
        }
        q
    }
}
