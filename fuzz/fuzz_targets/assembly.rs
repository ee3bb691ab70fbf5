#![no_main]
//! `cargo +nightly fuzz run assembly --features libfuzzer`

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = fuzz::TARGETS.iter().find(|target| target.name == "assembly").expect("a target of this name");
    (target.run)(bytes);
});
