//! Locally weighted projection regression.
