//! Scratch.
#[path = "suite/any_size.rs"]
mod any_size;
#[path = "suite/support.rs"]
#[allow(dead_code)]
mod support;
mod studies {
    pub fn parse(text: &str) -> Result<sensitol::Study, sensitol::StudyError> {
        sensitol::Study::from_toml(text, "study.toml")
    }
}
