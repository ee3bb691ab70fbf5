//! Sections of a page below its first screen.

/// Section with a heading and its markup.
pub(super) struct Part {
    id: String,
    title: String,
    body: String,
}

impl Part {
    /// Returns a section. The title is markup.
    pub(super) fn new(id: impl Into<String>, title: impl Into<String>, body: String) -> Self {
        Self { id: id.into(), title: title.into(), body }
    }

    /// Writes the section folded below its heading. Paper has it unfolded.
    pub(super) fn folded(&self) -> String {
        self.written("fold part")
    }

    /// Writes the section folded below its heading. Paper leaves it out.
    pub(super) fn on_screen(&self) -> String {
        self.written("fold part on-screen")
    }

    fn written(&self, class: &str) -> String {
        let Self { id, title, body } = self;
        format!(
            "<section aria-labelledby=\"{id}\">\n<details class=\"{class}\"><summary><h2 id=\"{id}\">{title}</h2></summary>\n{body}</details>\n</section>\n"
        )
    }
}
