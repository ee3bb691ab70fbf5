#![no_main]
//! `cargo +nightly fuzz run command_line --features libfuzzer`

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let target = fuzz::TARGETS.iter().find(|target| target.name == "command_line").expect("a target of this name");
    (target.run)(bytes);
});
