#![no_main]

#[path = "../fuzzed/readers.rs"]
mod readers;

libfuzzer_sys::fuzz_target!(
    init: {
        // The fuzzer aborts at every panic, but panics on damaged files become errors.
        let ends = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !demo_io::catches_panics() {
                ends(panic);
            }
        }));
    },
    |bytes: &[u8]| readers::readers(bytes)
);
