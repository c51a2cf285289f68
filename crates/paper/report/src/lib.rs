//! What a run says, beside the paper and beside another seed's run: in words, tables and a page.
//!
//! - [`terminal`]: the printed cells. [`markdown()`]: everything; [`printed`]: the printed cells. [`page()`]: everything with its figures.
//! - [`learners()`]: learners side by side. [`Tally`]: how many printed cells got which verdict.
//!
//! It is given experiments, results and drawn figures; to read and write is up to whoever asks.

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
