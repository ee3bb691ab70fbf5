//! Connections of clients: every read and write ends in bounded time, and clients without the token give way to others.

use std::collections::VecDeque;
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Greatest number of connections at once: a page has up to six, each with a thread and a descriptor.
const MOST: usize = 64;
/// Connections that are allowed in any case: those of two pages.
const LEAST: usize = 16;
/// Longest pause of a client while it sends or receives.
const PAUSE: Duration = Duration::from_secs(10);
/// Time for a client to receive the end of the response, and to end its own side.
const FAREWELL: Duration = Duration::from_secs(5);
/// Longest pause after a connection that could not be accepted: the system may have descriptors again.
const RETRY: Duration = Duration::from_millis(100);
/// Time after which a listener that only fails counts as ended.
const PATIENCE: Duration = Duration::from_secs(30);
/// Bytes that are read and dropped at once.
const BLOCK: usize = 64 << 10;

/// Connection of a client.
pub(in crate::commands::serve) struct Connection {
    stream: TcpStream,
}

impl Connection {
    fn new(stream: TcpStream) -> Self {
        // Lines of a run are short, and are shown at once.
        let _ = stream.set_nodelay(true);
        Self { stream }
    }

    /// Reads the bytes that have arrived, until this time at the latest. Returns 0 if the client sends no more.
    pub(in crate::commands::serve) fn read(&self, buffer: &mut [u8], end: Instant) -> Result<usize> {
        loop {
            self.stream.set_read_timeout(Some(left(end)?))?;
            match (&self.stream).read(buffer) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                read => return read,
            }
        }
    }

    /// Writes all bytes, until this time at the latest.
    pub(in crate::commands::serve) fn write(&self, mut bytes: &[u8], end: Instant) -> Result<()> {
        while !bytes.is_empty() {
            self.stream.set_write_timeout(Some(left(end)?))?;
            match (&self.stream).write(bytes) {
                Ok(0) => return Err(ErrorKind::WriteZero.into()),
                Ok(written) => bytes = &bytes[written..],
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Ends the response, and drops further bytes of the client: with unread bytes the system would discard the response.
    fn close(&self) {
        let end = Instant::now() + FAREWELL;
        let mut block = vec![0; BLOCK];
        let mut open = self.stream.shutdown(Shutdown::Write).is_ok();
        while open {
            open = self.read(&mut block, end).is_ok_and(|length| length > 0);
        }
    }

    /// Ends the connection at once: reads and writes that wait return.
    fn cut(&self) {
        let _ = self.stream.shutdown(Shutdown::Both);
    }
}

/// Time until the end, at most that of a pause. Fails after the end.
fn left(end: Instant) -> Result<Duration> {
    let left = end.saturating_duration_since(Instant::now()).min(PAUSE);
    if left.is_zero() { Err(ErrorKind::TimedOut.into()) } else { Ok(left) }
}

/// Open connections, at most [`MOST`].
struct Connections {
    open: Mutex<Open>,
    /// Notified when a connection has ended.
    ended: Condvar,
}

struct Open {
    count: usize,
    /// Greatest count, less than [`MOST`] if the system has not enough descriptors.
    most: usize,
    /// Connections that have not shown the token, oldest first.
    strangers: VecDeque<Arc<Connection>>,
}

impl Open {
    /// Ends the oldest connections without the token, until at most `left` are left.
    fn cut_oldest(&mut self, left: usize) {
        let excess = self.count.saturating_sub(left).min(self.strangers.len());
        self.strangers.drain(..excess).for_each(|oldest| oldest.cut());
    }
}

impl Connections {
    fn new() -> Self {
        let open = Open { count: 0, most: MOST, strangers: VecDeque::new() };
        Self { open: Mutex::new(open), ended: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, Open> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Leaves half of the descriptors to the answers: connections have taken them all. Waits for a moment until one is free.
    fn give_back(&self) {
        let mut open = self.lock();
        open.most = (open.count / 2).clamp(LEAST, open.most);
        let most = open.most;
        open.cut_oldest(most);
        let _ = self.ended.wait_timeout(open, RETRY);
    }

    /// Adds a connection. If there are too many, the oldest one without the token ends first.
    fn enter(self: &Arc<Self>, stream: TcpStream) -> Visit {
        let mut open = self.lock();
        let others = open.most - 1;
        open.cut_oldest(others);
        let room = self.ended.wait_while(open, |open| open.count > others);
        let mut open = room.unwrap_or_else(PoisonError::into_inner);
        let connection = Arc::new(Connection::new(stream));
        open.count += 1;
        open.strangers.push_back(Arc::clone(&connection));
        Visit { connection, all: Arc::clone(self) }
    }
}

/// Connection among the others, until it is dropped.
pub(in crate::commands::serve) struct Visit {
    connection: Arc<Connection>,
    all: Arc<Connections>,
}

impl Visit {
    pub(in crate::commands::serve) fn connection(&self) -> &Connection {
        &self.connection
    }

    /// Keeps the connection, whose client has the token, when others come.
    pub(in crate::commands::serve) fn admit(&self) {
        self.all.lock().strangers.retain(|stranger| !Arc::ptr_eq(stranger, &self.connection));
    }

    /// Ends the response.
    pub(in crate::commands::serve) fn close(self) {
        self.connection.close();
    }
}

impl Drop for Visit {
    fn drop(&mut self) {
        self.admit();
        self.all.lock().count -= 1;
        self.all.ended.notify_all();
    }
}

/// Accepts connections, each with a thread of its own. Returns the error of a listener that has ended.
pub(in crate::commands::serve) fn accept(
    listener: &TcpListener,
    answer: impl Fn(Visit) + Clone + Send + 'static,
) -> Error {
    accept_for(PATIENCE, listener, answer)
}

/// Accepts connections until the listener has only failed for `patience`.
fn accept_for(patience: Duration, listener: &TcpListener, answer: impl Fn(Visit) + Clone + Send + 'static) -> Error {
    let connections = Arc::new(Connections::new());
    let mut failing = None;
    loop {
        let error = match listener.accept() {
            Ok((stream, _)) => {
                let (visit, answer) = (connections.enter(stream), answer.clone());
                failing = None;
                // Without a thread the connection ends.
                let _ = std::thread::Builder::new().spawn(move || answer(visit));
                continue;
            }
            Err(error) => error,
        };
        if failing.get_or_insert_with(Instant::now).elapsed() >= patience {
            return error;
        }
        // Most likely all descriptors are in use.
        connections.give_back();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_listener_that_only_fails_has_ended() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        // Accepting then fails whenever nobody has connected.
        listener.set_nonblocking(true).unwrap();
        let error = accept_for(Duration::ZERO, &listener, |_| unreachable!("nobody connects"));
        assert_eq!(error.kind(), ErrorKind::WouldBlock);
    }

    #[test]
    fn strangers_give_way_and_guests_stay() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let at = listener.local_addr().unwrap();
        let connections = Arc::new(Connections::new());
        let mut clients = Vec::new();
        let mut visit = || {
            clients.push(TcpStream::connect(at).unwrap());
            connections.enter(listener.accept().unwrap().0)
        };
        let guest = visit();
        guest.admit();
        let mut strangers: Vec<Visit> = (1..MOST).map(|_| visit()).collect();
        // One that waits for its client is cut, and leaves its room.
        let oldest = strangers.remove(0);
        let waits = std::thread::spawn(move || {
            let read = oldest.connection().read(&mut [0], Instant::now() + PAUSE);
            read.unwrap()
        });
        let last = visit();
        assert_eq!(waits.join().unwrap(), 0);
        assert_eq!(connections.lock().count, MOST);
        assert!(guest.connection().write(b"x", Instant::now() + PAUSE).is_ok());
        drop((guest, strangers, last));
        let open = connections.lock();
        assert_eq!((open.count, open.strangers.len()), (0, 0));
    }
}
