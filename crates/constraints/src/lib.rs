//! Pfaffian constraints on motion and their null-space projectors.
