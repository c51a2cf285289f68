//! Simulated demonstrations under constraints, with the truth kept beside what is observed.
