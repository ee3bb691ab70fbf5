//! The file: SQLite in WAL mode, which several runs may share and any SQLite tool can read.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rusqlite::{Connection, ErrorCode, OptionalExtension, Transaction, TransactionBehavior, params};

/// What is in the file, for `PRAGMA user_version`.
const VERSION: i32 = 1;
/// Who wrote it, for `PRAGMA application_id`: "snsl".
const APPLICATION: i32 = 0x736e_736c;
/// How long to wait for another run that is writing.
const PATIENCE: Duration = Duration::from_secs(30);
/// And how long before it is tried once more.
const AGAIN: Duration = Duration::from_millis(5);

const TABLES: &str = "
    CREATE TABLE model (
        id INTEGER PRIMARY KEY,
        identity TEXT NOT NULL UNIQUE,
        dimensions TEXT NOT NULL,
        since TEXT NOT NULL DEFAULT (datetime('now'))
    );
    CREATE TABLE answer (
        model INTEGER NOT NULL REFERENCES model (id) ON DELETE CASCADE,
        point BLOB NOT NULL,
        output TEXT NOT NULL,
        value REAL,
        error TEXT,
        PRIMARY KEY (model, point, output)
    ) WITHOUT ROWID;
";

/// What is wrong with a journal.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("journal {}: {fault}", path.display())]
#[non_exhaustive]
pub struct JournalError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub fault: JournalFault,
}

/// What is wrong with a journal.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum JournalFault {
    /// There is no such file.
    #[error("there is no such file")]
    Missing,
    /// The file is something else.
    #[error("this is no journal of sensitol; name another file, or none")]
    NotAJournal,
    /// A later version wrote it.
    #[error("version {found} of the journal was written by a later sensitol; this one reads version {VERSION}")]
    Later {
        /// The version found.
        found: i32,
    },
    /// A file that the model depends on cannot be read.
    #[error("the model's file {} cannot be read: {reason}", file.display())]
    ModelFile {
        /// The file.
        file: PathBuf,
        /// The operating system's words.
        reason: String,
    },
    /// Reading or writing failed; what was stored before stays.
    #[error("{reason}; what it holds already is not touched")]
    Failed {
        /// SQLite's words.
        reason: String,
    },
}

/// One kept answer: a value, or why there is none.
pub type Answer = Result<f64, String>;

/// An open journal.
pub struct Store {
    path: PathBuf,
    connection: Connection,
}

/// A model whose answers are kept.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct KnownModel {
    /// Its number in the file.
    pub id: i64,
    /// What it is known by, as JSON.
    pub identity: String,
    /// Its dimensions, in the order of a point.
    pub dimensions: Vec<String>,
    /// When its first answer was kept.
    pub since: String,
    /// How many points are known.
    pub points: usize,
    /// How many values, and how many reasons for none.
    pub values: usize,
    /// How many reasons for no value.
    pub errors: usize,
}

/// A kept answer with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredAnswer {
    /// The point.
    pub point: Vec<f64>,
    /// The output.
    pub output: String,
    /// What the model said.
    pub answer: Answer,
}

impl Store {
    /// Opens a journal, which is made where there is none.
    ///
    /// # Errors
    /// When the file is something else, of a later version, or cannot be read and written.
    pub fn open(path: &Path) -> Result<Self, JournalError> {
        let store =
            Self { path: path.to_owned(), connection: Connection::open(path).map_err(|error| at(path, &error))? };
        let begun = Instant::now();
        loop {
            match store.prepare() {
                Ok(()) => return Ok(store),
                // SQLite does not wait by itself for another run that is just changing how the file is written.
                Err(Opening::Sqlite(error)) if is_busy(&error) && begun.elapsed() < PATIENCE => {
                    std::thread::sleep(AGAIN);
                }
                Err(Opening::Sqlite(error)) => return Err(at(path, &error)),
                Err(Opening::Fault(fault)) => return Err(JournalError { path: path.to_owned(), fault }),
            }
        }
    }

    /// Opens a journal that must be there.
    ///
    /// # Errors
    /// As [`open`](Self::open), and when there is none.
    pub fn open_existing(path: &Path) -> Result<Self, JournalError> {
        if !path.is_file() {
            return Err(JournalError { path: path.to_owned(), fault: JournalFault::Missing });
        }
        Self::open(path)
    }

    fn prepare(&self) -> Result<(), Opening> {
        let connection = &self.connection;
        connection.busy_timeout(PATIENCE)?;
        // All at one moment: another run may be making the tables, and its mark is not older than they are.
        let look = connection.unchecked_transaction()?;
        let pragma = |name: &str| look.pragma_query_value(None, name, |row| row.get::<_, i32>(0));
        let (application, version) = (pragma("application_id")?, pragma("user_version")?);
        let tables: i64 = look.query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))?;
        look.commit()?;
        if tables > 0 && application != APPLICATION {
            return Err(Opening::Fault(JournalFault::NotAJournal));
        }
        if version > VERSION {
            return Err(Opening::Fault(JournalFault::Later { found: version }));
        }
        connection.pragma_update(None, "journal_mode", "WAL")?;
        // Every commit reaches the operating system: a killed run loses nothing. A power cut may cost the last moments.
        connection.pragma_update(None, "synchronous", "NORMAL")?;
        connection.pragma_update(None, "foreign_keys", true)?;
        if tables == 0 {
            // Another run may be at it too: whoever comes second finds the tables.
            let script = format!(
                "{}; PRAGMA application_id = {APPLICATION}; PRAGMA user_version = {VERSION};",
                TABLES.replace("CREATE TABLE", "CREATE TABLE IF NOT EXISTS").trim().trim_end_matches(';')
            );
            let making = Transaction::new_unchecked(connection, TransactionBehavior::Immediate)?;
            making.execute_batch(&script)?;
            making.commit()?;
        }
        Ok(())
    }

    fn failed<T>(&self, result: rusqlite::Result<T>) -> Result<T, JournalError> {
        result.map_err(|error| at(&self.path, &error))
    }

    /// The number of the model of this identity, which is noted when it is new.
    ///
    /// # Errors
    /// When reading or writing fails.
    pub fn model(&self, identity: &str, dimensions: &[String]) -> Result<i64, JournalError> {
        let dimensions = serde_json::to_string(dimensions).expect("names are JSON");
        let add = "INSERT INTO model (identity, dimensions) VALUES (?1, ?2) ON CONFLICT (identity) DO NOTHING";
        self.failed(self.connection.execute(add, params![identity, dimensions]))?;
        let find = "SELECT id FROM model WHERE identity = ?1";
        self.failed(self.connection.query_row(find, [identity], |row| row.get(0)))
    }

    /// What the model said of one output at one point, if that is known.
    ///
    /// # Errors
    /// When reading fails.
    pub fn answer(&self, model: i64, point: &[f64], output: &str) -> Result<Option<Answer>, JournalError> {
        let find = "SELECT value, error FROM answer WHERE model = ?1 AND point = ?2 AND output = ?3";
        let found = self.connection.prepare_cached(find).and_then(|mut statement| {
            let answer = |row: &rusqlite::Row<'_>| -> rusqlite::Result<Answer> { answer(row.get(0)?, row.get(1)?) };
            statement.query_row(params![model, bytes(point), output], answer).optional()
        });
        self.failed(found)
    }

    /// Keeps answers, all of them or none; the last answer to a point counts.
    ///
    /// # Errors
    /// When writing fails; nothing of these is kept then.
    pub fn keep(&mut self, model: i64, answers: &[StoredAnswer]) -> Result<(), JournalError> {
        let kept = (|| {
            let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            {
                let add =
                    "INSERT OR REPLACE INTO answer (model, point, output, value, error) VALUES (?1, ?2, ?3, ?4, ?5)";
                let mut statement = transaction.prepare_cached(add)?;
                for StoredAnswer { point, output, answer } in answers {
                    let (value, error) = match answer {
                        Ok(value) => (Some(*value), None),
                        Err(error) => (None, Some(error)),
                    };
                    statement.execute(params![model, bytes(point), output, value, error])?;
                }
            }
            transaction.commit()
        })();
        self.failed(kept)
    }

    /// Forgets what is known of these points: answers that are not trusted any more.
    ///
    /// # Errors
    /// When writing fails; nothing of this is forgotten then.
    pub fn withdraw(&mut self, model: i64, points: &[Vec<f64>]) -> Result<(), JournalError> {
        let withdrawn = (|| {
            let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            {
                let mut statement = transaction.prepare_cached("DELETE FROM answer WHERE model = ?1 AND point = ?2")?;
                for point in points {
                    statement.execute(params![model, bytes(point)])?;
                }
            }
            transaction.commit()
        })();
        self.failed(withdrawn)
    }

    /// Every model in the file.
    ///
    /// # Errors
    /// When reading fails.
    pub fn models(&self) -> Result<Vec<KnownModel>, JournalError> {
        let all = "SELECT id, identity, dimensions, since,
                (SELECT count(DISTINCT point) FROM answer WHERE model = id),
                (SELECT count(value) FROM answer WHERE model = id),
                (SELECT count(error) FROM answer WHERE model = id)
            FROM model ORDER BY id";
        let models = self.connection.prepare(all).and_then(|mut statement| {
            let model = |row: &rusqlite::Row<'_>| {
                Ok(KnownModel {
                    id: row.get(0)?,
                    identity: row.get(1)?,
                    dimensions: serde_json::from_str(&row.get::<_, String>(2)?).unwrap_or_default(),
                    since: row.get(3)?,
                    points: row.get::<_, i64>(4)? as usize,
                    values: row.get::<_, i64>(5)? as usize,
                    errors: row.get::<_, i64>(6)? as usize,
                })
            };
            statement.query_map([], model)?.collect()
        });
        self.failed(models)
    }

    /// Every answer of a model, point by point.
    ///
    /// # Errors
    /// When reading fails.
    pub fn answers(&self, model: i64) -> Result<Vec<StoredAnswer>, JournalError> {
        let all = "SELECT point, output, value, error FROM answer WHERE model = ?1";
        let answers = self.connection.prepare(all).and_then(|mut statement| {
            let kept = |row: &rusqlite::Row<'_>| {
                let bytes: Vec<u8> = row.get(0)?;
                let coordinate = |eight: &[u8]| f64::from_le_bytes(eight.try_into().expect("eight bytes"));
                let point = bytes.chunks_exact(8).map(coordinate).collect();
                Ok(StoredAnswer { point, output: row.get(1)?, answer: answer(row.get(2)?, row.get(3)?)? })
            };
            statement.query_map([model], kept)?.collect()
        });
        self.failed(answers)
    }

    /// Forgets a model and its answers, or all of them; says how many answers there were.
    ///
    /// # Errors
    /// When writing fails; nothing is forgotten then.
    pub fn forget(&mut self, model: Option<i64>) -> Result<usize, JournalError> {
        let forgotten = (|| {
            let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            let answers = transaction.execute("DELETE FROM answer WHERE ?1 IS NULL OR model = ?1", [model])?;
            transaction.execute("DELETE FROM model WHERE ?1 IS NULL OR id = ?1", [model])?;
            transaction.commit()?;
            Ok(answers)
        })();
        self.failed(forgotten)
    }
}

fn is_busy(error: &rusqlite::Error) -> bool {
    matches!(error.sqlite_error_code(), Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked))
}

enum Opening {
    Sqlite(rusqlite::Error),
    Fault(JournalFault),
}

impl From<rusqlite::Error> for Opening {
    fn from(error: rusqlite::Error) -> Self {
        Self::Sqlite(error)
    }
}

fn at(path: &Path, error: &rusqlite::Error) -> JournalError {
    let fault = match error.sqlite_error_code() {
        Some(ErrorCode::NotADatabase) => JournalFault::NotAJournal,
        _ => JournalFault::Failed { reason: error.to_string() },
    };
    JournalError { path: path.to_owned(), fault }
}

fn answer(value: Option<f64>, error: Option<String>) -> rusqlite::Result<Answer> {
    Ok(value.ok_or_else(|| error.unwrap_or_default()))
}

/// The exact doubles; 0 has one sign only.
fn bytes(point: &[f64]) -> Vec<u8> {
    point.iter().flat_map(|&x| (x + 0.0).to_le_bytes()).collect()
}
