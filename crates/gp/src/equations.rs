#![doc = include_str!("../../../docs/slope-gp.md")]
