#![no_main]
//! `cargo +nightly fuzz run fits --features libfuzzer`

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = fuzz::TARGETS.iter().find(|target| target.name == "fits").expect("a target of this name");
    (target.run)(bytes);
});
