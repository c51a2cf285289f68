//! Learning potential-based policies from constrained motion by aligning local potentials.
