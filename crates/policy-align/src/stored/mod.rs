//! Storage of models in files.

mod canonical;
mod error;
mod model_file;
mod whole_file;

pub use canonical::{sha256, sha256_of_file};
pub use error::ModelError;
pub use model_file::checksum_of;
pub use whole_file::{write_together, write_whole};
