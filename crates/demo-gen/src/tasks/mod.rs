//! Movements that perform a task in addition to their policy: A(x) u = b(x), so that u = Nπ + A⁺b. The generators follow the examples of
//! Armesto, Moura, Ivan, Salas and Vijayakumar (RSS 2017), and of the same authors with Erden (IJRR 2018): a limit cycle on the plane,
//! and an arm with seven joints that wipes surfaces of random tilt.

mod cycles;
mod surface;
pub(crate) mod task_constraint;
mod wiping;
mod wiping_policy;

pub use cycles::CyclesWithTask;
pub use surface::Surface;
pub use task_constraint::{LinearTask, TaskConstraint};
pub use wiping::{Contact, Wiping};
pub use wiping_policy::WipingPolicy;
