//! Integrates e^−x² in vector registers of the processor at hand, and compares the bits with scalar code.

#![allow(clippy::print_stdout, reason = "a program")]

use lanes::{LANES, Lanes, Register, exp, total};
use pulp::{Arch, Simd, WithSimd};

/// Σ e^−x² over groups of eight; also returns the number of lanes of a register.
struct GaussianSum<'a>(&'a [Lanes]);

impl WithSimd for GaussianSum<'_> {
    type Output = (f64, usize);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> (f64, usize) {
        let mut sums = [0.0; LANES];
        for group in self.0 {
            for part in 0..Register::<S>::parts() {
                let x = Register::load(simd, group, part);
                let sum = Register::load(simd, &sums, part);
                (sum + exp(x * x * -1.0)).store(&mut sums, part);
            }
        }
        (total(sums), LANES / Register::<S>::parts())
    }
}

fn main() {
    // Midpoints of 8,000 intervals from −8 to 8.
    let width = 16.0 / 8000.0;
    let midpoint = |i: usize| -8.0 + width * (i as f64 + 0.5);
    let points: Vec<Lanes> = (0..1000).map(|k| std::array::from_fn(|lane| midpoint(LANES * k + lane))).collect();

    let (sum, numbers) = Arch::new().dispatch(GaussianSum(&points));
    println!("a register of this processor holds {numbers} numbers");
    println!("integral of e^−x²  {:.15}", width * sum);
    println!("square root of π   {:.15}", std::f64::consts::PI.sqrt());

    let mut sums = [0.0; LANES];
    for group in &points {
        sums.iter_mut().zip(group).for_each(|(sum, &x)| *sum += exp(-(x * x)));
    }
    println!("plain numbers give the same bits: {}", total(sums).to_bits() == sum.to_bits());
}
