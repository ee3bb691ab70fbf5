//! One child process: its process group, its pipes, and the threads that read and write them.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::descendants::{Mark, VARIABLE};
use super::group::GroupedProcess;
use super::line_reader::{UnfinishedLine, read_line};
use super::protocol::Line;
use crate::settings::Listener;
use sensitol::assembly::{Exit, ProcessFault, Quoted, StderrTail};

/// Greatest length of a line, in bytes. A hundred thousand characteristics fit into it.
pub(super) const LONGEST: usize = 16 << 20;
/// Number of lines of stderr that errors quote.
const TAIL: usize = 5;
/// Greatest number of characters of a quoted line of stderr.
const TAIL_WIDTH: usize = 200;
/// Time for a child to end by itself once its stdin is closed.
const GRACE: Duration = Duration::from_secs(2);

/// Event of the child with this number.
#[derive(Debug)]
pub(super) struct Event {
    pub(super) child: u64,
    pub(super) what: What,
}

#[derive(Debug)]
pub(super) enum What {
    /// Lines that arrived together.
    Lines(Vec<Result<Line, ProcessFault>>),
    /// The child closed its stdout. No more lines follow.
    Closed,
}

pub(super) struct Child {
    pub(super) number: u64,
    /// Ends the child's group if this process ends in any way; None if it cannot be started.
    #[cfg(unix)]
    guard: Option<Guard>,
    process: GroupedProcess,
    /// Mark of its descendants, which ends those that left the group.
    mark: Mark,
    /// Channel to the thread that writes to stdin; None once stdin is closed.
    requests: Option<Sender<Vec<u8>>>,
    /// Time at which stdin was closed; None while it is open.
    closed: Option<Instant>,
    /// Way in which the child ended; None before.
    ended: Option<Exit>,
    stderr: Arc<Mutex<VecDeque<String>>>,
    unfinished: UnfinishedLine,
    readers: Vec<JoinHandle<()>>,
}

/// Starts a thread. Fails if the system has none left.
fn thread<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> std::io::Result<JoinHandle<T>> {
    std::thread::Builder::new().spawn(work)
}

impl Child {
    /// Starts a program in a process group of its own, never through a shell.
    pub(super) fn start(
        argv: &[String],
        folder: &Path,
        number: u64,
        events: &Sender<Event>,
        listener: Option<Listener>,
    ) -> Result<Self, ProcessFault> {
        let program = &argv[0];
        let mark = Mark::new();
        let mut command = Command::new(path(program, folder));
        command.args(&argv[1..]).current_dir(folder).env(VARIABLE, mark.value());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // The whole group ends with its leader, so that no grandchild is left behind.
        let mut process = GroupedProcess::start(command).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound if folder.is_dir() => {
                ProcessFault::NotFound { program: program.clone(), folder: folder.display().to_string() }
            }
            _ => ProcessFault::NotStarted { program: program.clone(), reason: error.to_string() },
        })?;
        let (requests, lines) = channel::<Vec<u8>>();
        let mut stdin = process.take_stdin().expect("stdin is a pipe");
        // A child that never reads its stdin blocks this thread only.
        let write = move || {
            for line in lines {
                if stdin.write_all(&line).and_then(|()| stdin.flush()).is_err() {
                    break;
                }
            }
        };
        let stdout = process.take_stdout().expect("stdout is a pipe");
        let (events, unfinished) = (events.clone(), UnfinishedLine::default());
        let written = unfinished.clone();
        let stderr = Arc::new(Mutex::new(VecDeque::new()));
        let (pipe, tail) = (process.take_stderr().expect("stderr is a pipe"), Arc::clone(&stderr));
        let streams = thread(write).and_then(|_| {
            let out = thread(move || read(stdout, number, &events, &written))?;
            Ok(vec![out, thread(move || listen(pipe, &tail, listener.as_ref()))?])
        });
        let readers = match streams {
            Ok(readers) => readers,
            Err(error) => {
                // The child is killed at once: without threads nothing can be exchanged with it.
                let _ = process.kill();
                let reason = format!("there is no thread for its streams: {error}");
                return Err(ProcessFault::NotStarted { program: program.clone(), reason });
            }
        };
        #[cfg(unix)]
        let guard = Guard::of(process.id(), &mark);
        Ok(Self {
            number,
            #[cfg(unix)]
            guard,
            process,
            mark,
            requests: Some(requests),
            closed: None,
            ended: None,
            stderr,
            unfinished,
            readers,
        })
    }

    /// True if the child wrote at an unfinished line within this time.
    pub(super) fn writes_on(&self, time: Duration) -> bool {
        self.unfinished.grew_within(time)
    }

    /// Sends lines. A failure shows later as the end of the child.
    pub(super) fn send(&self, lines: Vec<u8>) {
        if let Some(requests) = &self.requests {
            let _ = requests.send(lines);
        }
    }

    /// Closes stdin, which announces that no more points follow.
    pub(super) fn close(&mut self) {
        self.requests = None;
        self.closed.get_or_insert_with(Instant::now);
    }

    /// Kills the child and its group at once.
    pub(super) fn kill(&mut self) -> (Exit, StderrTail) {
        self.end(Duration::ZERO)
    }

    /// Ends the child and its group. It has `grace` to end by itself before it is killed.
    fn end(&mut self, grace: Duration) -> (Exit, StderrTail) {
        if self.ended.is_none() {
            self.end_group(grace);
            Mark::kill([&self.mark]);
        }
        self.read_out()
    }

    /// Ends children and their groups together, so that one search finds what left the groups. Each has the usual time to end by itself.
    pub(super) fn end_all(mut children: Vec<Self>) {
        // All are told first, so that they end at the same time.
        children.iter_mut().for_each(Self::close);
        children.iter_mut().for_each(|child| child.end_group(GRACE));
        Mark::kill(children.iter().map(|child| &child.mark));
    }

    /// True if the child has ended, or if its time to end by itself is over.
    pub(super) fn is_at_its_end(&mut self) -> bool {
        let is_over = self.closed.is_some_and(|closed| closed.elapsed() >= GRACE);
        is_over || self.ended.is_some() || matches!(self.process.try_wait(), Ok(Some(_)))
    }

    /// Ends the child and its group, without the processes that left the group.
    fn end_group(&mut self, grace: Duration) {
        if self.ended.is_some() {
            return;
        }
        self.close();
        let begun = self.closed.unwrap_or_else(Instant::now);
        let mut status = self.process.try_wait().ok().flatten();
        while status.is_none() && begun.elapsed() < grace {
            std::thread::sleep(Duration::from_millis(2));
            status = self.process.try_wait().ok().flatten();
        }
        let by_itself = status.is_some();
        // The guard must end before the group's number is free for other processes.
        #[cfg(unix)]
        drop(self.guard.take());
        let status = self.process.kill().or(status);
        self.ended = Some(if by_itself { status.map_or(Exit::Signal(None), exit) } else { Exit::ClosedStdout });
    }

    /// Waits for the last lines of a child that has ended. Returns the way in which it ended, and the end of its stderr.
    fn read_out(&self) -> (Exit, StderrTail) {
        // The pipes are closed now, unless a process left the group. Their last lines are worth a short wait.
        let begun = Instant::now();
        while !self.readers.iter().all(JoinHandle::is_finished) && begun.elapsed() < Duration::from_millis(200) {
            std::thread::sleep(Duration::from_millis(1));
        }
        (self.ended.unwrap_or(Exit::Signal(None)), self.tail())
    }

    pub(super) fn tail(&self) -> StderrTail {
        StderrTail(self.stderr.lock().map(|lines| lines.iter().cloned().collect()).unwrap_or_default())
    }

    /// Waits a moment for a child that closed its stdout to end by itself.
    pub(super) fn ended(&mut self) -> (Exit, StderrTail) {
        self.end(Duration::from_millis(500))
    }
}

/// A shell that waits for the end of a pipe whose other end only this process holds. The pipe closes even when this process is killed. The
/// shell then ends the child's process group, even a busy one, and the descendants that left it. A child that waits for requests would notice the end of its own pipe.
#[cfg(unix)]
struct Guard(std::process::Child);

#[cfg(unix)]
impl Guard {
    fn of(group: u32, mark: &Mark) -> Option<Self> {
        let script = "read -r line; kill -s KILL -- \"-$1\"; \
            for file in /proc/[0-9]*/environ; do \
            if grep -qs -e \"$2:\" \"$file\"; then one=${file#/proc/}; kill -s KILL \"${one%/environ}\"; fi; done";
        let mut command = std::process::Command::new("/bin/sh");
        // A group of its own, since Ctrl-C on a terminal must reach this process first.
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.args(["-c", script, "sensitol-guard", &group.to_string(), mark.text()]);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok().map(Self)
    }
}

#[cfg(unix)]
impl Drop for Guard {
    /// Kills the shell before its pipe closes.
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        if self.ended.is_none() {
            self.end(GRACE);
        }
    }
}

/// Path of a program. One with a folder in its name is relative to the study's folder. Others are searched in the PATH.
fn path(program: &str, folder: &Path) -> std::path::PathBuf {
    let path = Path::new(program);
    if path.components().count() > 1 { folder.join(path) } else { path.to_owned() }
}

fn exit(status: ExitStatus) -> Exit {
    #[cfg(unix)]
    let signal = std::os::unix::process::ExitStatusExt::signal(&status);
    #[cfg(not(unix))]
    let signal = None;
    status.code().map_or(Exit::Signal(signal), Exit::Code)
}

/// Reads stdout until its end or a line that cannot be understood.
fn read(stdout: impl Read, child: u64, events: &Sender<Event>, unfinished: &UnfinishedLine) {
    let mut stdout = BufReader::with_capacity(1 << 16, stdout);
    let mut lines = Vec::new();
    let mut line = Vec::new();
    loop {
        let read = read_line(&mut stdout, LONGEST, &mut line, unfinished);
        let ended = !matches!(read, Ok(read) if read > 0);
        if !ended {
            let oversized = line.len() > LONGEST;
            let parsed = if oversized {
                Err(ProcessFault::Oversized { limit: LONGEST, line: Quoted::of(&line) })
            } else if line.iter().all(u8::is_ascii_whitespace) {
                continue;
            } else {
                Line::parse(&line)
            };
            let stop = parsed.is_err();
            lines.push(parsed);
            if !stop && stdout.buffer().contains(&b'\n') {
                continue;
            }
            if events.send(Event { child, what: What::Lines(std::mem::take(&mut lines)) }).is_err() || stop {
                return;
            }
            continue;
        }
        let _ = events.send(Event { child, what: What::Closed });
        return;
    }
}

/// Keeps the last lines of stderr, and passes every line to the listener.
fn listen(stderr: impl Read, tail: &Mutex<VecDeque<String>>, listener: Option<&Listener>) {
    let mut stderr = BufReader::new(stderr);
    let mut line = Vec::new();
    loop {
        line.clear();
        // A line without end is cut into pieces.
        match (&mut stderr).take(1 << 16).read_until(b'\n', &mut line) {
            Ok(read) if read > 0 => {}
            _ => return,
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end();
        if text.is_empty() {
            continue;
        }
        if let Some(listener) = listener {
            listener(text);
        }
        if let Ok(mut tail) = tail.lock() {
            if tail.len() == TAIL {
                tail.pop_front();
            }
            let clean = |c: char| if c.is_control() { ' ' } else { c };
            tail.push_back(text.chars().take(TAIL_WIDTH).map(clean).collect());
        }
    }
}
