//! File of the journal: SQLite in WAL mode. Several runs may share it, and any SQLite tool can read it.

use std::cell::RefCell;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rusqlite::{Connection, ErrorCode, OptionalExtension, Transaction, TransactionBehavior, params};

use super::checksum;
use super::claims::{self, Claimant};
pub use super::content::Answer;
use super::content::VERSION;
use super::error::{JournalError, JournalFault};
use sensitol::assembly::DamagedJournal;

/// Mark of the writer, in `PRAGMA application_id`: "snsl".
const APPLICATION: i32 = 0x736e_736c;
/// Longest wait for another run that is writing.
const PATIENCE: Duration = Duration::from_secs(30);
/// Pause between two attempts to open the file.
const AGAIN: Duration = Duration::from_millis(5);

/// Tables of version 1.
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
        stage INTEGER,
        PRIMARY KEY (model, point, output)
    ) WITHOUT ROWID;
";
/// Later additions, which earlier versions ignore: stages without a confirmation by replay, claims, derivatives, and models that flip.
const LATER: &str = "
    CREATE TABLE IF NOT EXISTS stage (
        id INTEGER PRIMARY KEY AUTOINCREMENT,
        model INTEGER NOT NULL REFERENCES model (id) ON DELETE CASCADE
    );
    CREATE TABLE IF NOT EXISTS claim (
        run INTEGER PRIMARY KEY AUTOINCREMENT,
        model INTEGER NOT NULL REFERENCES model (id) ON DELETE CASCADE,
        beat INTEGER NOT NULL,
        host TEXT NOT NULL,
        pid INTEGER NOT NULL,
        points BLOB NOT NULL
    );
    CREATE TABLE IF NOT EXISTS gradient (
        model INTEGER NOT NULL REFERENCES model (id) ON DELETE CASCADE,
        point BLOB NOT NULL,
        output TEXT NOT NULL,
        slopes BLOB NOT NULL,
        PRIMARY KEY (model, point, output)
    ) WITHOUT ROWID;
    CREATE TABLE IF NOT EXISTS flip (
        model INTEGER PRIMARY KEY REFERENCES model (id) ON DELETE CASCADE,
        since TEXT NOT NULL DEFAULT (datetime('now'))
    );
    CREATE TRIGGER IF NOT EXISTS forget_gradient AFTER DELETE ON answer BEGIN
        DELETE FROM gradient WHERE model = OLD.model AND point = OLD.point AND output = OLD.output;
    END;
";

/// An open journal.
pub struct Store {
    path: PathBuf,
    connection: Connection,
    /// Stage of the answers that are kept now; None if they need no confirmation.
    stage: Option<i64>,
    /// Claim of this run; None if it has none.
    claim: Option<i64>,
    durable: bool,
    /// Point and output of every answer whose checksum does not agree.
    damaged: RefCell<HashSet<(Vec<u8>, String)>>,
}

/// An answer from the journal, with its stage if that has no confirmation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Recalled {
    pub(super) answer: Answer,
    pub(super) unconfirmed: Option<i64>,
}

/// A model whose answers are kept.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct KnownModel {
    /// Number of the model in the file.
    pub id: i64,
    /// The key of the model, as JSON.
    pub identity: String,
    /// Names of the dimensions, in the order of a point.
    pub dimensions: Vec<String>,
    /// Time at which the model was first noted, in UTC.
    pub since: String,
    /// Number of points with an answer.
    pub points: usize,
    /// Number of values.
    pub values: usize,
    /// Number of points and outputs without a value, with a reason.
    pub errors: usize,
    /// Number of points whose run ended before their check. The next run checks them before it uses them.
    pub unconfirmed: usize,
    /// Number of values and reasons whose checksum does not agree. They count as unknown.
    pub damaged: usize,
    /// True if answers were found to depend on the points before them, so that each is replayed.
    pub flips: bool,
}

/// An answer with its point and output.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredAnswer {
    /// The point.
    pub point: Vec<f64>,
    /// The output.
    pub output: String,
    /// Answer of the model.
    pub answer: Answer,
}

impl Store {
    /// Opens a journal. A missing file is made.
    ///
    /// # Errors
    /// Fails if the file is not a journal, is of a later version, or cannot be read and written.
    pub fn open(path: &Path) -> Result<Self, JournalError> {
        let connection = Connection::open(path).map_err(|error| at(path, &error))?;
        let store = Self {
            path: path.to_owned(),
            connection,
            stage: None,
            claim: None,
            durable: false,
            damaged: RefCell::default(),
        };
        let begun = Instant::now();
        loop {
            match store.prepare() {
                Ok(()) => return Ok(store),
                // SQLite does not wait by itself for another run that is switching the file to WAL mode.
                Err(Opening::Sqlite(error)) if is_busy(&error) && begun.elapsed() < PATIENCE => {
                    std::thread::sleep(AGAIN);
                }
                Err(Opening::Sqlite(error)) => return Err(at(path, &error)),
                Err(Opening::Fault(fault)) => return Err(JournalError { path: path.to_owned(), fault }),
            }
        }
    }

    /// Opens an existing journal.
    ///
    /// # Errors
    /// Fails like [`open`](Self::open), or if the file does not exist.
    pub fn open_existing(path: &Path) -> Result<Self, JournalError> {
        if !path.is_file() {
            return Err(JournalError { path: path.to_owned(), fault: JournalFault::Missing });
        }
        Self::open(path)
    }

    fn prepare(&self) -> Result<(), Opening> {
        let connection = &self.connection;
        connection.busy_timeout(PATIENCE)?;
        // One transaction for all reads: another run may be making the tables at this moment.
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
        // Every commit reaches the operating system, so a killed run loses nothing. A power cut may cost the last moments.
        connection.pragma_update(None, "synchronous", "NORMAL")?;
        connection.pragma_update(None, "foreign_keys", true)?;
        if tables == 0 {
            // Another run may make the tables at the same time. The second one finds them.
            let script = format!(
                "{}; PRAGMA application_id = {APPLICATION}; PRAGMA user_version = {VERSION};",
                TABLES.replace("CREATE TABLE", "CREATE TABLE IF NOT EXISTS").trim().trim_end_matches(';')
            );
            let making = Transaction::new_unchecked(connection, TransactionBehavior::Immediate)?;
            making.execute_batch(&script)?;
            making.commit()?;
        }
        self.complete()?;
        Ok(())
    }

    /// Adds the tables and columns that an earlier version did not make.
    fn complete(&self) -> rusqlite::Result<()> {
        let is_complete = |connection: &Connection| -> rusqlite::Result<bool> {
            let tables = "SELECT count(*) FROM sqlite_schema WHERE name IN ('stage', 'claim', 'gradient', 'flip', 'forget_gradient')";
            let tables: i64 = connection.query_row(tables, [], |row| row.get(0))?;
            Ok(tables == 5 && missing_columns(connection)?.is_empty())
        };
        if is_complete(&self.connection)? {
            return Ok(());
        }
        let making = Transaction::new_unchecked(&self.connection, TransactionBehavior::Immediate)?;
        making.execute_batch(LATER)?;
        // Another run may have added the columns meanwhile, or an earlier version.
        for (table, column) in missing_columns(&making)? {
            making.execute_batch(&format!("ALTER TABLE {table} ADD COLUMN {column} INTEGER"))?;
        }
        making.commit()
    }

    fn failed<T>(&self, result: rusqlite::Result<T>) -> Result<T, JournalError> {
        result.map_err(|error| at(&self.path, &error))
    }

    /// Number of the model with this identity. A new one is added.
    ///
    /// # Errors
    /// Fails if reading or writing fails.
    pub fn model(&self, identity: &str, dimensions: &[String]) -> Result<i64, JournalError> {
        let dimensions = serde_json::to_string(dimensions).expect("names are JSON");
        let add = "INSERT INTO model (identity, dimensions) VALUES (?1, ?2) ON CONFLICT (identity) DO NOTHING";
        self.failed(self.connection.execute(add, params![identity, dimensions]))?;
        let find = "SELECT id FROM model WHERE identity = ?1";
        self.failed(self.connection.query_row(find, [identity], |row| row.get(0)))
    }

    /// Answer of the model for one output at one point. Returns None if it is not known.
    ///
    /// # Errors
    /// Fails if reading fails.
    pub fn answer(&self, model: i64, point: &[f64], output: &str) -> Result<Option<Answer>, JournalError> {
        Ok(self.recall(model, point, output)?.map(|recalled| recalled.answer))
    }

    /// Like [`answer`](Self::answer), with the stage of an answer without a confirmation.
    pub(super) fn recall(&self, model: i64, point: &[f64], output: &str) -> Result<Option<Recalled>, JournalError> {
        let find = "SELECT (SELECT id FROM stage WHERE id = answer.stage), value, error, checksum FROM answer
            WHERE model = ?1 AND point = ?2 AND output = ?3";
        let point = bytes(point);
        let found = self.connection.prepare_cached(find).and_then(|mut statement| {
            let recalled = |row: &rusqlite::Row<'_>| -> rusqlite::Result<Option<Recalled>> {
                let unconfirmed = row.get(0)?;
                Ok(self.checked(&point, output, row, 1)?.map(|answer| Recalled { answer, unconfirmed }))
            };
            statement.query_row(params![model, point, output], recalled).optional()
        });
        Ok(self.failed(found)?.flatten())
    }

    /// True if the journal has an answer of the model.
    pub(super) fn has_answers(&self, model: i64) -> Result<bool, JournalError> {
        let find = "SELECT EXISTS (SELECT 1 FROM answer WHERE model = ?1)";
        self.failed(self.connection.query_row(find, [model], |row| row.get(0)))
    }

    /// Number that changes when another run writes to the file.
    pub(super) fn version(&self) -> Result<i64, JournalError> {
        self.failed(self.connection.pragma_query_value(None, "data_version", |row| row.get(0)))
    }

    /// Keeps the derivatives of one output by all dimensions at one point.
    pub(super) fn keep_gradient(
        &self,
        model: i64,
        point: &[f64],
        output: &str,
        slopes: &[f64],
    ) -> Result<(), JournalError> {
        let add =
            "INSERT OR REPLACE INTO gradient (model, point, output, slopes, checksum) VALUES (?1, ?2, ?3, ?4, ?5)";
        let slopes: Vec<u8> = slopes.iter().flat_map(|slope| slope.to_le_bytes()).collect();
        let point = bytes(point);
        let checksum = checksum::of_slopes(&point, output, &slopes);
        self.failed(self.connection.execute(add, params![model, point, output, slopes, checksum]).map(drop))
    }

    /// Derivatives of one output at one point. Returns None if none were kept, or if they are damaged.
    pub(super) fn gradient(&self, model: i64, point: &[f64], output: &str) -> Result<Option<Vec<f64>>, JournalError> {
        let find = "SELECT slopes, checksum FROM gradient WHERE model = ?1 AND point = ?2 AND output = ?3";
        let point = bytes(point);
        let kept = |row: &rusqlite::Row<'_>| Ok((row.get(0)?, row.get(1)?));
        let found = self.connection.query_row(find, params![model, point, output], kept).optional();
        let Some((slopes, kept)) = self.failed::<Option<(Vec<u8>, Option<i64>)>>(found)? else { return Ok(None) };
        if kept.is_some_and(|kept| kept != checksum::of_slopes(&point, output, &slopes)) {
            self.damaged.borrow_mut().insert((point, output.to_owned()));
            return Ok(None);
        }
        Ok(Some(slopes.chunks_exact(8).map(number).collect()))
    }

    /// Opens a stage: answers from now on belong to it and have no confirmation yet.
    pub(super) fn open_stage(&mut self, model: i64) -> Result<(), JournalError> {
        self.failed(self.connection.execute("INSERT INTO stage (model) VALUES (?1)", [model]))?;
        self.stage = Some(self.connection.last_insert_rowid());
        Ok(())
    }

    /// Closes the stage. Without a confirmation its answers stay marked as unconfirmed.
    pub(super) fn close_stage(&mut self, confirmed: bool) -> Result<(), JournalError> {
        match self.stage.take().filter(|_| confirmed) {
            Some(stage) => self.failed(self.connection.execute("DELETE FROM stage WHERE id = ?1", [stage]).map(drop)),
            None => Ok(()),
        }
    }

    /// Removes the mark of answers that a fresh process confirmed: those to these points, for these outputs. Stages without a marked answer
    /// end.
    pub(super) fn confirm(
        &mut self,
        model: i64,
        points: &[Vec<f64>],
        outputs: &[&str],
        stages: &[i64],
    ) -> Result<(), JournalError> {
        if points.is_empty() {
            return Ok(());
        }
        let confirmed = (|| {
            let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            {
                let unmark = "UPDATE answer SET stage = NULL WHERE model = ?1 AND point = ?2 AND output = ?3";
                let mut statement = transaction.prepare_cached(unmark)?;
                for point in points {
                    for output in outputs {
                        statement.execute(params![model, bytes(point), output])?;
                    }
                }
            }
            let end = "DELETE FROM stage WHERE id = ?1 AND NOT EXISTS (SELECT 1 FROM answer WHERE stage = ?1)";
            for stage in stages {
                transaction.execute(end, [stage])?;
            }
            transaction.commit()
        })();
        self.failed(confirmed)
    }

    /// True if answers of the model were found to depend on the points before them.
    pub(super) fn flips(&self, model: i64) -> Result<bool, JournalError> {
        let find = "SELECT EXISTS (SELECT 1 FROM flip WHERE model = ?1)";
        self.failed(self.connection.query_row(find, [model], |row| row.get(0)))
    }

    /// Keeps the finding that answers of the model depend on the points before them. All its answers are marked: each needs its own
    /// confirmation from now on.
    pub(super) fn note_flips(&mut self, model: i64) -> Result<(), JournalError> {
        let noted = (|| {
            let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            // Another run may have noted it already, and has confirmed answers since then.
            if transaction.execute("INSERT OR IGNORE INTO flip (model) VALUES (?1)", [model])? > 0 {
                transaction.execute("INSERT INTO stage (model) VALUES (?1)", [model])?;
                let stage = transaction.last_insert_rowid();
                transaction.execute("UPDATE answer SET stage = ?2 WHERE model = ?1", params![model, stage])?;
            }
            transaction.commit()
        })();
        self.failed(noted)
    }

    /// Path of the file and number of its answers that were found to be damaged; None if no answer was damaged.
    pub fn damaged(&self) -> Option<DamagedJournal> {
        let answers = self.damaged.borrow().len();
        (answers > 0).then(|| DamagedJournal::new(self.path.clone(), answers))
    }

    /// Answer of a row, if its checksum agrees. A damaged answer counts as unknown and is noted.
    fn checked(
        &self,
        point: &[u8],
        output: &str,
        row: &rusqlite::Row<'_>,
        first: usize,
    ) -> rusqlite::Result<Option<Answer>> {
        let (value, error): (Option<f64>, Option<String>) = (row.get(first)?, row.get(first + 1)?);
        let kept: Option<i64> = row.get(first + 2)?;
        let answer = value.ok_or_else(|| error.unwrap_or_default());
        // Answers of earlier versions have no checksum.
        if kept.is_none_or(|kept| kept == checksum::of_answer(point, output, &answer)) {
            return Ok(Some(answer));
        }
        self.damaged.borrow_mut().insert((point.to_vec(), output.to_owned()));
        Ok(None)
    }

    /// Deletes all answers of a model. Returns their number.
    pub(super) fn forget_answers(&mut self, model: i64) -> Result<usize, JournalError> {
        self.failed(self.connection.execute("DELETE FROM flip WHERE model = ?1", [model]))?;
        self.failed(self.connection.execute("DELETE FROM answer WHERE model = ?1", [model]))
    }

    /// Claims the points that no other run has claimed. Returns true for each point that is now claimed by this run. Claims of the runs
    /// `gone` are deleted.
    pub(super) fn claim(&mut self, model: i64, points: &[Vec<f64>], gone: &[i64]) -> Result<Vec<bool>, JournalError> {
        let own = self.claim;
        let claimed = (|| {
            let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            for run in gone {
                transaction.execute("DELETE FROM claim WHERE run = ?1", [run])?;
            }
            let claimed =
                claims::claim(&transaction, model, own, &points.iter().map(|point| bytes(point)).collect::<Vec<_>>())?;
            transaction.commit()?;
            Ok(claimed)
        })();
        let (run, mine) = self.failed(claimed)?;
        self.claim = run;
        Ok(mine)
    }

    /// Counts up the beat of this run's claim.
    pub(super) fn beat(&self) -> Result<(), JournalError> {
        let Some(run) = self.claim else { return Ok(()) };
        self.failed(self.connection.execute("UPDATE claim SET beat = beat + 1 WHERE run = ?1", [run]).map(drop))
    }

    /// Deletes the claim of this run.
    pub(super) fn release(&mut self) -> Result<(), JournalError> {
        match self.claim.take() {
            Some(run) => self.failed(self.connection.execute("DELETE FROM claim WHERE run = ?1", [run]).map(drop)),
            None => Ok(()),
        }
    }

    /// Other runs with claims on points of this model.
    pub(super) fn claimants(&self, model: i64) -> Result<Vec<Claimant>, JournalError> {
        self.failed(claims::claimants(&self.connection, model, self.claim))
    }

    /// Sets whether every commit reaches the disk. If not, it only reaches the operating system, and a power cut may cost the last answers.
    ///
    /// # Errors
    /// Fails if the file cannot be read.
    pub fn set_durable(&mut self, durable: bool) -> Result<(), JournalError> {
        if self.durable != durable {
            let synchronous = if durable { "FULL" } else { "NORMAL" };
            self.failed(self.connection.pragma_update(None, "synchronous", synchronous))?;
            self.durable = durable;
        }
        Ok(())
    }

    /// True if every commit reaches the disk.
    pub fn is_durable(&self) -> bool {
        self.connection
            .pragma_query_value(None, "synchronous", |row| row.get::<_, i64>(0))
            .is_ok_and(|level| level >= 2)
    }

    /// Keeps all of these answers or none. A later answer to a point replaces an earlier one.
    ///
    /// # Errors
    /// Fails if writing fails. Nothing is kept then.
    pub fn keep(&mut self, model: i64, answers: &[StoredAnswer]) -> Result<(), JournalError> {
        let stage = self.stage;
        let kept = (|| {
            let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            {
                let add = "INSERT OR REPLACE INTO answer (model, point, output, value, error, stage, checksum)
                    VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)";
                let mut statement = transaction.prepare_cached(add)?;
                for StoredAnswer { point, output, answer } in answers {
                    let (value, error) = match answer {
                        Ok(value) => (Some(*value), None),
                        Err(error) => (None, Some(error)),
                    };
                    let point = bytes(point);
                    let checksum = checksum::of_answer(&point, output, answer);
                    statement.execute(params![model, point, output, value, error, stage, checksum])?;
                }
            }
            transaction.commit()
        })();
        self.failed(kept)
    }

    /// Deletes the answers to these points, which are not trusted any more.
    ///
    /// # Errors
    /// Fails if writing fails. Nothing is deleted then.
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

    /// All models in the file.
    ///
    /// # Errors
    /// Fails if reading fails.
    pub fn models(&self) -> Result<Vec<KnownModel>, JournalError> {
        let all = "SELECT id, identity, dimensions, since,
                (SELECT count(DISTINCT point) FROM answer WHERE model = id),
                (SELECT count(value) FROM answer WHERE model = id),
                (SELECT count(error) FROM answer WHERE model = id),
                (SELECT count(DISTINCT point) FROM answer JOIN stage ON stage.id = answer.stage WHERE answer.model = model.id),
                EXISTS (SELECT 1 FROM flip WHERE flip.model = model.id)
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
                    unconfirmed: row.get::<_, i64>(7)? as usize,
                    damaged: 0,
                    flips: row.get(8)?,
                })
            };
            statement.query_map([], model)?.collect::<rusqlite::Result<Vec<KnownModel>>>()
        });
        let mut models = self.failed(models)?;
        for model in &mut models {
            model.damaged = model.values + model.errors - self.answers(model.id)?.len();
        }
        Ok(models)
    }

    /// All answers of a model, point by point, without damaged ones.
    ///
    /// # Errors
    /// Fails if reading fails.
    pub fn answers(&self, model: i64) -> Result<Vec<StoredAnswer>, JournalError> {
        self.stored("SELECT point, output, value, error, checksum FROM answer WHERE model = ?1", model)
    }

    /// Answers of a model that state that there is no value, point by point.
    ///
    /// # Errors
    /// Fails if reading fails.
    pub fn failures(&self, model: i64) -> Result<Vec<StoredAnswer>, JournalError> {
        let find = "SELECT point, output, value, error, checksum FROM answer WHERE model = ?1 AND value IS NULL";
        self.stored(find, model)
    }

    /// Answers that a query of one model selects: point, output, value, error and checksum.
    fn stored(&self, query: &str, model: i64) -> Result<Vec<StoredAnswer>, JournalError> {
        let answers = self.connection.prepare(query).and_then(|mut statement| {
            let kept = |row: &rusqlite::Row<'_>| {
                let (bytes, output): (Vec<u8>, String) = (row.get(0)?, row.get(1)?);
                let answer = self.checked(&bytes, &output, row, 2)?;
                let point = bytes.chunks_exact(8).map(number).collect();
                Ok(answer.map(|answer| StoredAnswer { point, output, answer }))
            };
            statement.query_map([model], kept)?.filter_map(Result::transpose).collect()
        });
        self.failed(answers)
    }

    /// Deletes a model with its answers, or all models. Returns the number of deleted answers.
    ///
    /// # Errors
    /// Fails if writing fails. Nothing is deleted then.
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

/// Columns that a journal of an earlier version lacks, with their tables.
fn missing_columns(connection: &Connection) -> rusqlite::Result<Vec<(&'static str, &'static str)>> {
    let mut missing = Vec::new();
    for (table, column) in [("answer", "stage"), ("answer", "checksum"), ("gradient", "checksum")] {
        let find = "SELECT count(*) FROM pragma_table_info(?1) WHERE name = ?2";
        if connection.query_row(find, [table, column], |row| row.get::<_, i64>(0))? == 0 {
            missing.push((table, column));
        }
    }
    Ok(missing)
}

/// Number from its eight bytes.
fn number(eight: &[u8]) -> f64 {
    f64::from_le_bytes(eight.try_into().expect("eight bytes"))
}

/// Bytes of the exact doubles of a point. Adding 0 removes the sign of a negative zero.
fn bytes(point: &[f64]) -> Vec<u8> {
    point.iter().flat_map(|&x| (x + 0.0).to_le_bytes()).collect()
}
