//! Several numbers at once, for loops in vector registers.
//!
//! | | |
//! |---|---|
//! | [`Lanes`] | eight numbers in memory: as many as the widest register holds, the same on every machine |
//! | [`Register`] | as many numbers as a register of the processor at hand holds |
//! | [`Number`] | the operand of generic computations: one `f64`, or a [`Register`] of them |
//! | [`exp`], [`exp_in_bulk`] | the exponential without calls or branches |
//! | [`sin_cos_all`], [`sin_cos_all_dispatched`] | sines and cosines, likewise; the latter in the widest registers, whatever the caller uses |
//! | [`dispatch_avx2`] | runs an operation compiled for AVX2, and not for wider registers |
//!
//! Code that uses them runs under [`pulp::Arch::dispatch`] and is compiled for a processor only if it is inlined; therefore everything here
//! is `#[inline(always)]`. The same operations in the same order give the same bits for every register width.

#![allow(clippy::inline_always)]
#![allow(clippy::return_self_not_must_use, reason = "numbers: whoever drops one needs no word about it")]

mod dispatch;
mod exponential;
mod group;
mod number;
mod register;
mod scalar;
mod sin_cos;

pub use dispatch::dispatch_avx2;
pub use exponential::{exp, exp_in_bulk};
pub use group::{LANES, Lanes, groups_of, total};
pub use number::Number;
pub use register::Register;
pub use sin_cos::{sin_cos_all, sin_cos_all_dispatched};

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
