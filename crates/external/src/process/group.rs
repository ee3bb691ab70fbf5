//! Programs that end together with the processes that they started.

use std::io::Result;
use std::process::{ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus};

use process_wrap::std::{ChildWrapper, CommandWrap};

/// A program in a process group of its own, or in a job on Windows. Ctrl-C on the terminal does not reach it.
pub struct GroupedProcess(Box<dyn ChildWrapper>);

impl GroupedProcess {
    /// Starts a program, never through a shell.
    ///
    /// # Errors
    /// Fails if the system does not start it.
    pub fn start(command: Command) -> Result<Self> {
        let mut command = CommandWrap::from(command);
        #[cfg(unix)]
        command.wrap(process_wrap::std::ProcessGroup::leader());
        #[cfg(windows)]
        command.wrap(process_wrap::std::JobObject);
        command.spawn().map(Self)
    }

    /// Number of the program, and of its group.
    pub fn id(&self) -> u32 {
        self.0.id()
    }

    /// Takes the pipe to stdin; None if there is none, or if it was taken.
    pub fn take_stdin(&mut self) -> Option<ChildStdin> {
        self.0.stdin().take()
    }

    /// Takes the pipe from stdout; None if there is none, or if it was taken.
    pub fn take_stdout(&mut self) -> Option<ChildStdout> {
        self.0.stdout().take()
    }

    /// Takes the pipe from stderr; None if there is none, or if it was taken.
    pub fn take_stderr(&mut self) -> Option<ChildStderr> {
        self.0.stderr().take()
    }

    /// Status of the program if it has ended; None while it runs.
    ///
    /// # Errors
    /// Fails if the system does not tell.
    pub fn try_wait(&mut self) -> Result<Option<ExitStatus>> {
        self.0.try_wait()
    }

    /// Kills the program with its whole group, and waits for its end. Returns its status; None if the system does not tell.
    pub fn kill(&mut self) -> Option<ExitStatus> {
        let _ = self.0.start_kill();
        self.0.wait().ok()
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::io::{BufRead, BufReader, Read};
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    /// A process that the program started ends with it.
    #[test]
    fn the_whole_group_ends() {
        let mut command = Command::new("/bin/sh");
        command.args(["-c", "sleep 600 & echo started; wait"]).stdout(Stdio::piped());
        let mut group = GroupedProcess::start(command).unwrap();
        let mut output = BufReader::new(group.take_stdout().unwrap());
        let mut line = String::new();
        output.read_line(&mut line).unwrap();
        assert_eq!((line.as_str(), group.try_wait().unwrap()), ("started\n", None));
        let begun = Instant::now();
        assert!(group.kill().is_some_and(|status| !status.success()));
        // The pipe ends once no process of the group holds it.
        output.read_to_string(&mut line).unwrap();
        assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
    }
}
