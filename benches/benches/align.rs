//! Alignment, from integration to offsets and kept set, on the toy system and on its extension to more dimensions.
//!
//! `RAYON_NUM_THREADS=1 cargo bench -p benches --bench align`; comparison with NumPy: `benches/peers/compare_align.py`.

use align::{Bandwidth, PolicyAlign};
use benches::toy_demonstrations;
use criterion::{Criterion, criterion_group, criterion_main};

fn align(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("align");
    group.sample_size(20);
    for (count, dim) in [(40, 2), (40, 6), (40, 22), (100, 2), (100, 6), (100, 22)] {
        let demonstrations = toy_demonstrations(1, count, count, dim);
        for (name, bandwidth) in [("narrow", Bandwidth::Narrow), ("wide", Bandwidth::Wide)] {
            let learner = PolicyAlign { bandwidth, ..Default::default() };
            group.bench_function(format!("{count}x{count} n={dim} {name}"), |bencher| {
                bencher.iter(|| learner.align(std::hint::black_box(&demonstrations)).expect("sound data"));
            });
        }
    }
}

criterion_group!(benches, align);
criterion_main!(benches);
