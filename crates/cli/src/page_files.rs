//! Files of a page: the page itself, and its print.

use std::path::{Path, PathBuf};

use crate::chromium::{browser, printed};
use crate::failure::Failure;
use crate::files::Files;
use crate::output::Destination;

/// Files that a page goes into, opened before the work.
#[derive(Default)]
pub(crate) struct PageFiles {
    page: Option<Destination>,
    /// Printed page, and the browser that prints it.
    print: Option<(Destination, PathBuf)>,
}

impl PageFiles {
    /// Opens the files of `--html` and `--pdf`, if they are given. Fails if no browser can print.
    pub(crate) fn open(files: &mut Files, html: Option<&Path>, pdf: Option<&Path>) -> Result<Self, Failure> {
        let page = files.file(html)?;
        let print = match pdf {
            Some(path) => {
                let browser = browser()?;
                files.file(Some(path))?.map(|destination| (destination, browser))
            }
            None => None,
        };
        Ok(Self { page, print })
    }

    /// True if there is a file to write.
    pub(crate) fn is_asked(&self) -> bool {
        self.page.is_some() || self.print.is_some()
    }

    /// Writes the page into all its files. It is built only if there is one.
    pub(crate) fn write(self, page: impl FnOnce() -> String) -> Result<(), Failure> {
        if !self.is_asked() {
            return Ok(());
        }
        let text = page();
        let written = self.page.map_or(Ok(()), |file| file.write(&text));
        let print = |(file, browser): (Destination, PathBuf)| file.write_bytes(&printed(&browser, &text)?);
        written.and(self.print.map_or(Ok(()), print))
    }
}
