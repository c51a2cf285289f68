#![doc = include_str!("../equations.md")]
