//! Constraints of the movements.

use constraints::Barrier;
use demo_gen::{Grasp, GraspStart};

/// The constraint of a movement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Constraint {
    /// The wall of the demonstrations; each start has a different gap.
    Gap,
    /// The obstacle that no demonstration contains.
    Obstacle,
    None,
}

impl Constraint {
    pub(super) const ALL: [Self; 3] = [Self::Gap, Self::Obstacle, Self::None];

    pub(super) fn id(self) -> &'static str {
        match self {
            Self::Gap => "gap",
            Self::Obstacle => "obstacle",
            Self::None => "none",
        }
    }

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Gap => "a wall with a gap, as in the demonstrations",
            Self::Obstacle => "an obstacle in the middle, in no demonstration",
            Self::None => "nothing",
        }
    }

    /// The plates of the constraint for a movement from this start.
    pub(super) fn barrier(self, grasp: &Grasp, start: &GraspStart) -> anyhow::Result<Option<Barrier>> {
        Ok(match self {
            Self::Gap => Some(grasp.scene.wall_with_gap(start.gap)?),
            Self::Obstacle => Some(grasp.scene.central_obstacle()?),
            Self::None => None,
        })
    }
}
