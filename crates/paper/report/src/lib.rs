//! Reports on a run, compared with the paper and with a run from another seed: as text, tables and a page.
//!
//! - [`terminal`]: the printed cells. [`markdown()`]: everything; [`printed`]: the printed cells. [`page()`]: everything with its figures.
//! - [`learners()`]: learners side by side. [`Tally`]: how many printed cells got which verdict.
//!
//! The crate receives experiments, results and drawn figures; the caller reads and writes files.

mod compared;
mod comparisons;
mod learners;
mod legend;
mod markdown;
mod page;
mod tally;
mod terminal;

pub use self::page::{Contents, page};
pub use learners::{learners, on_new_movements};
pub use markdown::{Section, markdown, printed};
pub use tally::Tally;
pub use terminal::terminal;
