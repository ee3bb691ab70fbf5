//! Page of the workbench for a server: its parts are in this program, and the engine is the program itself.

use data_encoding::BASE64;
use sha2::{Digest, Sha256};

const HTML: &str = include_str!("../../../page/page.html");
const STYLE: &str = include_str!("../../../page/page.css");
/// Scripts in the order of `web/assemble.mjs`.
const SCRIPTS: [&str; 5] = [
    include_str!("../../../page/study.js"),
    include_str!("../../../page/engine.js"),
    include_str!("../../../page/serve.js"),
    include_str!("../../../page/page.js"),
    include_str!("../../../page/folder.js"),
];

/// Returns the page without WebAssembly. It asks the server for every result, so that it opens from a server only.
pub(in crate::commands::serve) fn page() -> String {
    let script = SCRIPTS.concat();
    // Only these texts may run and style the page.
    let policy = format!(
        "default-src 'none'; style-src {}; script-src {}; base-uri 'none'; form-action 'none'",
        hash(STYLE),
        hash(&script)
    );
    // Examples are the studies of the folder.
    let parts = [
        ("@POLICY@", policy.as_str()),
        ("@VERSION@", env!("CARGO_PKG_VERSION")),
        ("@STYLE@", STYLE),
        ("@EXAMPLES@", "[]"),
        ("@GLUE@", ""),
        ("@WORKER@", ""),
        ("@ENGINE@", ""),
        // Last, since a script may contain the marks of the others.
        ("@SCRIPT@", script.as_str()),
    ];
    let mut page = HTML.to_owned();
    for (mark, part) in parts {
        page = page.replacen(mark, part, 1);
    }
    page
}

/// Source of a content security policy for a text: its SHA-256 in base64.
fn hash(text: &str) -> String {
    format!("'sha256-{}'", BASE64.encode(&Sha256::digest(text)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SHA-256 of "abc" by FIPS 180-2, appendix B.1, in base64.
    #[test]
    fn hashes_are_those_of_browsers() {
        assert_eq!(hash("abc"), "'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='");
    }

    #[test]
    fn every_mark_has_its_part() {
        let page = page();
        for mark in ["POLICY", "VERSION", "STYLE", "EXAMPLES", "GLUE", "WORKER", "ENGINE", "SCRIPT"] {
            assert!(HTML.contains(&format!("@{mark}@")) && !page.contains(&format!("@{mark}@")), "{mark}");
        }
        // Nothing in a script ends its element or begins a comment.
        assert!(!SCRIPTS.concat().contains("</script") && !SCRIPTS.concat().contains("<!--"));
    }
}
