use nalgebra::{Point2, Point3, Vector3};

/// A half space of the panel's coordinates: the points p with n·p ≤ d.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Half {
    pub(super) normal: Vector3<f64>,
    pub(super) offset: f64,
}

impl Half {
    pub(super) fn behind(point: &Point3<f64>, normal: Vector3<f64>) -> Self {
        Half { normal, offset: normal.dot(&point.coords) }
    }

    /// The other half.
    pub(super) fn reversed(self) -> Self {
        Half { normal: -self.normal, offset: -self.offset }
    }

    /// How far outside a point is.
    pub(super) fn outside(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) - self.offset
    }
}

/// What is round about a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Round {
    /// Only flat faces.
    None,
    /// All points nearer than a radius to the line between two.
    Capsule { ends: [Point3<f64>; 2], radius: f64 },
    /// What ends at this depth.
    Level(f64),
}

/// The side of a convex body that the viewer sees.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Front {
    pub(super) round: Round,
    /// The body is within all of these.
    pub(super) halves: Vec<Half>,
}

/// Points of a capsule's axis at which its surface is looked for.
const ALONG: usize = 32;

/// Faces of which the viewer sees less than this share of their area bound nothing.
const EDGE_ON: f64 = 1e-6;

impl Front {
    /// How near to the viewer the body is where this point of the panel looks at it.
    pub(super) fn nearness(&self, at: &Point2<f64>) -> f64 {
        let facing = self.halves.iter().filter(|half| half.normal.z > EDGE_ON);
        let flat = facing.map(|Half { normal, offset }| (offset - normal.xy().dot(&at.coords)) / normal.z);
        flat.fold(self.round.nearness(at), f64::min)
    }
}

impl Round {
    fn nearness(&self, at: &Point2<f64>) -> f64 {
        match self {
            Round::None => f64::INFINITY,
            Round::Level(depth) => *depth,
            Round::Capsule { ends: [a, b], radius } => {
                let ball = |step: usize| {
                    let centre = a + (b - a) * (step as f64 / ALONG as f64);
                    let height = radius * radius - (at - centre.xy()).norm_squared();
                    // Beside this ball: as far back as the ball's middle, and farther the farther it is.
                    centre.z + if height >= 0.0 { height.sqrt() } else { -(-height).sqrt() }
                };
                (0..=ALONG).map(ball).fold(f64::NEG_INFINITY, f64::max)
            }
        }
    }
}
