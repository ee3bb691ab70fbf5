//! `--csv DIR`: the tables of a report as files.

use std::path::Path;

use crate::failure::Failure;
use crate::output::Destination;
use sensitol_report::CsvFile;

/// Folder of CSV files, each opened before the analysis and renamed when it is complete.
pub(super) struct CsvFolder(Vec<Destination>);

impl CsvFolder {
    /// Opens files of these names.
    pub(super) fn open(folder: &Path, names: &[String]) -> Result<Self, Failure> {
        Self::make(folder)?;
        names.iter().map(|name| Destination::file(&folder.join(name))).collect::<Result<_, _>>().map(Self)
    }

    /// Creates the folder if it is missing.
    pub(super) fn make(folder: &Path) -> Result<(), Failure> {
        std::fs::create_dir_all(folder).map_err(|error| {
            // The system's error for a file in the way depends on its position in the path.
            let in_the_way = folder.ancestors().find(|path| path.is_file());
            match in_the_way {
                Some(file) => Failure::NoFolder { path: file.to_owned() },
                None => Failure::Unwritable { path: folder.to_owned(), error },
            }
        })
    }

    /// Writes all files, or none if one of them cannot be written.
    pub(super) fn write(self, files: &[CsvFile]) -> Result<(), Failure> {
        Destination::write_all(self.0.into_iter().zip(files.iter().map(|table| table.text.as_str())))
    }
}
