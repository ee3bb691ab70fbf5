#![no_main]
//! `cargo +nightly fuzz run study_toml --features libfuzzer`

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = fuzz::TARGETS.iter().find(|target| target.name == "study_toml").expect("a target of this name");
    (target.run)(bytes);
});
