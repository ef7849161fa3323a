//! What the program says: to people on the standard error, to programs on the standard output.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

/// Says a sentence on the standard error. Where nobody can hear it (a full disk, a closed pipe), the work goes on.
pub(crate) fn say(sentence: impl Display) {
    // In one piece, so that it does not mix with what others say.
    let _ = io::stderr().write_all(format!("{sentence}\n").as_bytes());
}

/// Writes text to the standard output. Who reads it may have seen enough, such as `head`, and that is no error.
pub(crate) fn print(text: &str) -> io::Result<()> {
    let mut output = io::stdout().lock();
    let written = output
        .write_all(text.as_bytes())
        .and_then(|()| output.flush());
    heard(written)
}

/// The result of writing to the standard output, where a closed pipe is no error.
pub(crate) fn heard(written: io::Result<()>) -> io::Result<()> {
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(io::Error::new(
            error.kind(),
            format!("the standard output: {error}"),
        )),
        Ok(()) => Ok(()),
    }
}

/// From now on a panic, which is always a mistake in the program and never one of its user, says so.
pub fn own_up_to_bugs() {
    std::panic::set_hook(Box::new(|bug| {
        let thread = std::thread::current();
        let name = thread.name().unwrap_or("without a name");
        say(format_args!(
            "inkstrand has a bug: thread {name} {bug}\n\
             Please report it, with this message, your command line and the files that it names.",
        ));
        // Where RUST_BACKTRACE asks for it.
        let trace = std::backtrace::Backtrace::capture();
        if trace.status() == std::backtrace::BacktraceStatus::Captured {
            say(trace);
        }
    }));
}

/// A file's name as a shell takes it.
pub(crate) fn shell_word(path: &Path) -> String {
    let name = path.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+,:=@%".contains(c);
    if !name.is_empty() && name.chars().all(is_plain) {
        name
    } else {
        format!("'{}'", name.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_for_a_shell() {
        for (name, word) in [
            ("looks/a-b.ron", "looks/a-b.ron"),
            ("höchst.ron", "höchst.ron"),
            ("my look.ron", "'my look.ron'"),
            ("it's.ron", r"'it'\''s.ron'"),
            ("$HOME.ron", "'$HOME.ron'"),
        ] {
            assert_eq!(shell_word(Path::new(name)), word);
        }
    }

    /// Run by the test below, in a process of its own.
    #[test]
    #[ignore = "it panics: `a_panic_is_told_as_a_bug` runs it"]
    fn a_bug() {
        own_up_to_bugs();
        panic!("one and one is three");
    }

    #[test]
    fn a_panic_is_told_as_a_bug() {
        let run = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "say::tests::a_bug", "--ignored", "--nocapture"])
            .env_remove("RUST_BACKTRACE")
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&run.stderr);
        assert!(!run.status.success());
        for part in [
            "inkstrand has a bug: thread say::tests::a_bug panicked at ",
            "say.rs:",
            "one and one is three",
            "Please report it",
        ] {
            assert!(told.contains(part), "`{part}` in: {told}");
        }
        assert!(!told.contains("RUST_BACKTRACE"), "{told}");
    }
}
