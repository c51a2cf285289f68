//! Errors of learnt policies and potentials, and their summaries.
