//! Claims of points that a run is evaluating. Another run at the same journal waits for their answers instead of evaluating them too.
//!
//! A run notes the points of a batch before it sends the first one. It removes the note when all are answered and confirmed. In between it
//! counts up a number twice a second. A killed run leaves its note behind. Another run recognises that on the same machine by the missing
//! process, and on another machine by a number that stands still.

use std::collections::{HashMap, HashSet};
use std::time::{Duration, Instant};

use rusqlite::{Connection, params};

/// Time between two beats of a run.
pub(super) const BEAT: Duration = Duration::from_millis(500);
/// Time without a beat after which a run counts as gone: six beats, for a machine that is busy. A run that is taken for gone by mistake
/// costs a second evaluation of its points, and nothing else.
const SILENT: Duration = Duration::from_secs(3);

/// Another run that has claimed points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Claimant {
    pub(super) run: i64,
    beat: i64,
    host: String,
    pid: u32,
}

/// Beats of the other runs, to find those that are gone.
#[derive(Debug, Default)]
pub(super) struct Watch(HashMap<i64, (i64, Instant)>);

impl Watch {
    /// Number of runs under watch.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// Ends the watch of all other runs.
    pub(super) fn keep(&mut self, claimants: &[Claimant]) {
        self.0.retain(|run, _| claimants.iter().any(|one| one.run == *run));
    }

    /// True if a run is gone: its process does not exist, or its beat has stood still for too long.
    pub(super) fn is_gone(&mut self, claimant: &Claimant) -> bool {
        if claimant.host == host() && std::path::Path::new("/proc/self").exists() {
            let process = std::path::Path::new("/proc").join(claimant.pid.to_string());
            if !process.exists() {
                return true;
            }
        }
        let now = Instant::now();
        let seen = self.0.entry(claimant.run).or_insert((claimant.beat, now));
        if seen.0 != claimant.beat {
            *seen = (claimant.beat, now);
        }
        seen.1.elapsed() > SILENT
    }
}

/// Identifier of this machine since its start; empty if the system has none.
fn host() -> String {
    std::fs::read_to_string("/proc/sys/kernel/random/boot_id").map(|id| id.trim().to_owned()).unwrap_or_default()
}

/// Claims the points that no other run has claimed. Returns the number of the claim, and true for each point that is now claimed by this
/// run.
pub(super) fn claim(
    connection: &Connection,
    model: i64,
    own: Option<i64>,
    points: &[Vec<u8>],
) -> rusqlite::Result<(Option<i64>, Vec<bool>)> {
    let mut others: HashSet<[u8; 8]> = HashSet::new();
    let find = "SELECT points FROM claim WHERE model = ?1 AND run IS NOT ?2";
    let mut statement = connection.prepare_cached(find)?;
    let mut rows = statement.query(params![model, own])?;
    while let Some(row) = rows.next()? {
        let hashes: Vec<u8> = row.get(0)?;
        others.extend(hashes.chunks_exact(8).map(|eight| <[u8; 8]>::try_from(eight).unwrap_or_default()));
    }
    let hashes: Vec<[u8; 8]> = points.iter().map(|point| hash(point)).collect();
    let mine: Vec<bool> = hashes.iter().map(|hash| !others.contains(hash)).collect();
    let claimed: Vec<u8> = hashes.iter().zip(&mine).filter(|(_, mine)| **mine).flat_map(|(hash, _)| *hash).collect();
    if let Some(run) = own {
        connection.execute("DELETE FROM claim WHERE run = ?1", [run])?;
    }
    if claimed.is_empty() {
        return Ok((None, mine));
    }
    let add = "INSERT INTO claim (model, beat, host, pid, points) VALUES (?1, 0, ?2, ?3, ?4)";
    connection.execute(add, params![model, host(), std::process::id(), claimed])?;
    Ok((Some(connection.last_insert_rowid()), mine))
}

/// Other runs with claims on points of this model.
pub(super) fn claimants(connection: &Connection, model: i64, own: Option<i64>) -> rusqlite::Result<Vec<Claimant>> {
    let find = "SELECT run, beat, host, pid FROM claim WHERE model = ?1 AND run IS NOT ?2";
    let mut statement = connection.prepare_cached(find)?;
    let claimant = |row: &rusqlite::Row<'_>| {
        Ok(Claimant { run: row.get(0)?, beat: row.get(1)?, host: row.get(2)?, pid: row.get(3)? })
    };
    statement.query_map(params![model, own], claimant)?.collect()
}

/// Hash FNV-1a, 64 bits. Two points with the same hash cost a needless wait only.
fn hash(bytes: &[u8]) -> [u8; 8] {
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step).to_le_bytes()
}
