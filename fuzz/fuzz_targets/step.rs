#![no_main]
//! `cargo +nightly fuzz run step --features libfuzzer`

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = fuzz::TARGETS.iter().find(|target| target.name == "step").expect("a target of this name");
    (target.run)(bytes);
});
