//! Processes that tests start and stop.

use std::path::PathBuf;
use std::process::Command;

use crate::repository;

/// Path of the compiled C child of `tests/children`. A C compiler is present, since Rust needs one to link.
pub fn child_in_c() -> String {
    static BUILT: std::sync::OnceLock<PathBuf> = std::sync::OnceLock::new();
    let built = BUILT.get_or_init(|| {
        let program = std::env::temp_dir().join(format!("flips-{}", std::process::id()));
        let source = repository("tests/children/flips.c");
        let done = Command::new("cc").arg("-O1").arg("-o").arg(&program).arg(source).arg("-lm").status();
        assert!(done.is_ok_and(|status| status.success()), "cc compiles tests/children/flips.c");
        program
    });
    built.display().to_string()
}

/// Sends Ctrl-C to a process.
pub fn interrupt(pid: u32) {
    assert!(Command::new("kill").args(["-INT", &pid.to_string()]).status().unwrap().success());
}
