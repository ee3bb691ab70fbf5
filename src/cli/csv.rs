//! `--csv DIR`: the tables of a report as files.

use std::path::Path;

use super::failure::Failure;
use super::output::Destination;
use crate::characteristic::Characteristic;
use crate::problem::Problem;
use crate::report::{Report, csv_file_names, csv_files};

/// A folder of files, each opened before the work and renamed when it is whole.
pub(super) struct CsvFolder(Vec<Destination>);

impl CsvFolder {
    pub(super) fn open(folder: &Path, problem: &Problem) -> Result<Self, Failure> {
        std::fs::create_dir_all(folder).map_err(|error| {
            // What the system says of a file in the way depends on where in the path it is.
            let in_the_way = folder.ancestors().find(|path| path.is_file());
            match in_the_way {
                Some(file) => Failure::NoFolder { path: file.to_owned() },
                None => Failure::Unwritable { path: folder.to_owned(), error },
            }
        })?;
        let names = csv_file_names(problem.characteristics().iter().map(Characteristic::name));
        names.iter().map(|name| Destination::file(&folder.join(name))).collect::<Result<_, _>>().map(Self)
    }

    pub(super) fn write(self, report: &Report) -> Result<(), Failure> {
        self.0.into_iter().zip(csv_files(report)).try_for_each(|(file, table)| file.write(&table.text))
    }
}
