//! The program that reads what was made, and what it must hold to.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use crate::Outcome;

/// The memory that the program has, in KiB: of addresses, as `ulimit -v` counts. Inputs have 1 MiB at most.
const MEMORY_KIB: u64 = 1 << 20;
/// The time that one file may take: some seconds at most, and more where others use the machine too.
const TIME: Duration = Duration::from_secs(60);
/// The most bytes that all messages about one file may have.
const LONGEST_MESSAGE: usize = 1 << 16;

/// The program, running.
pub struct Target {
    child: Child,
    input: ChildStdin,
    answers: Receiver<Vec<u8>>,
}

impl Target {
    /// Starts it with a limit on its memory, where the system's shell has one to set.
    pub fn start(program: &Path) -> Outcome<Self> {
        let mut command = if cfg!(unix) {
            let mut shell = Command::new("sh");
            shell.arg("-c");
            shell.arg(format!("ulimit -v {MEMORY_KIB} && exec \"$0\""));
            shell.arg(program);
            shell
        } else {
            Command::new(program)
        };
        let mut child = command
            .env("RUST_BACKTRACE", "0")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let input = child.stdin.take().ok_or("the program has no input")?;
        let output = child.stdout.take().ok_or("the program has no output")?;
        // A thread of its own, because nothing waits for a pipe for a while only.
        let (sender, answers) = mpsc::channel();
        thread::spawn(move || {
            let mut lines = BufReader::new(output).split(b'\n');
            while let Some(Ok(line)) = lines.next() {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Self {
            child,
            input,
            answers,
        })
    }

    /// Lets it read a file: whether it was read, not refused. After an error it reads no more.
    ///
    /// # Errors
    /// What it doesn't hold to.
    pub fn read(&mut self, kind: &str, path: &Path) -> Result<bool, String> {
        // A program that has ended doesn't answer either.
        let _ = writeln!(self.input, "{kind} {}", path.display());
        let answer = match self.answers.recv_timeout(TIME) {
            Ok(answer) => answer,
            Err(RecvTimeoutError::Timeout) => {
                let _ = self.child.kill();
                let _ = self.child.wait();
                return Err(format!("it took more than {} s", TIME.as_secs()));
            }
            Err(RecvTimeoutError::Disconnected) => return Err(self.last_words()),
        };
        let text = String::from_utf8(answer).map_err(|_| "its message is not UTF-8".to_owned())?;
        if text.len() > LONGEST_MESSAGE {
            return Err(format!("its message has {} bytes", text.len()));
        }
        if let Some(control) = text.chars().find(|c| c.is_control()) {
            return Err(format!("its message has the character {control:?}: {text}"));
        }
        Ok(text == "read")
    }

    /// How it ended.
    fn last_words(&mut self) -> String {
        let mut said = Vec::new();
        if let Some(mut errors) = self.child.stderr.take() {
            let _ = errors.read_to_end(&mut said);
        }
        let said = String::from_utf8_lossy(&said);
        match self.child.wait() {
            Ok(status) => format!("it ended ({status}): {}", said.trim()),
            Err(error) => format!("it ended: {error}"),
        }
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// A program of a shell's lines in place of the real one.
    fn answer_of(lines: &str) -> Result<bool, String> {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("program");
        std::fs::write(&program, format!("#!/bin/sh\nread line\n{lines}\n")).unwrap();
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
        let mut target = Target::start(&program).unwrap();
        target.read("obj", Path::new("a.obj"))
    }

    #[test]
    fn what_does_not_hold_is_told() {
        assert_eq!(answer_of("echo read"), Ok(true));
        assert_eq!(answer_of("echo refused: no head"), Ok(false));
        let message = |lines| answer_of(lines).unwrap_err();
        assert_eq!(
            message("echo no memory >&2; exit 101"),
            "it ended (exit status: 101): no memory"
        );
        assert_eq!(message("printf '\\377\\n'"), "its message is not UTF-8");
        assert!(message("printf 'refused \\033[1m\\n'").contains("'\\u{1b}'"));
        assert_eq!(
            message("printf '%070000d\\n' 0"),
            "its message has 70000 bytes"
        );
    }
}
