//! The commands for programs that have a window of their own: without a terminal, watched, and to be cancelled.

use crate::cli::{Arguments, Command};
use crate::commands::{self, Progress};
use crate::{Failure, say};
use clap::Parser as _;
use effects::Registry;
use std::path::Path;

/// Does what `inkstrand render` does with these arguments, which begin with `render`. `watch` is told after each frame how far it is, and
/// says whether it goes on. Nothing is printed. What was written, in words.
///
/// # Errors
///
/// What the program would print, also where `watch` wants no more ("cancelled").
///
/// ```no_run
/// let registry = inkstrand::builtin_effects();
/// let arguments = ["render", "look.ron", "--frames", "0-47"].map(String::from);
/// let written = inkstrand::render_with(&arguments, &registry, &mut |progress| {
///     println!("{} of {}", progress.done, progress.all);
///     true
/// });
/// ```
pub fn render_with(
    arguments: &[String],
    registry: &Registry,
    watch: &mut (dyn FnMut(Progress) -> bool + Send),
) -> Result<String, String> {
    let program = ["inkstrand".to_owned()];
    let words = program.iter().chain(arguments);
    let mut arguments = Arguments::try_parse_from(words).map_err(|error| error.to_string())?;
    let Command::Render(options) = &mut arguments.command else {
        return Err("the arguments are not those of `inkstrand render`".to_owned());
    };
    options.quiet = true;
    commands::render(options, registry, Some(watch)).map_err(told)
}

/// Writes what `inkstrand new` writes: a commented preset at `path`, and a hair style beside it.
///
/// # Errors
///
/// What the program would print: one of the files is there, or cannot be written, or the name is none of a preset.
pub fn write_new_look(path: &Path) -> Result<(), String> {
    commands::write_new_look(path).map(drop).map_err(told)
}

/// A word as a shell takes it, in quotes where it needs some.
#[must_use]
pub fn shell_word(word: &str) -> String {
    say::shell_word(Path::new(word))
}

fn told(failure: Failure) -> String {
    match failure {
        Failure::Usage(message) | Failure::Failed(message) => message,
        Failure::Mistakes(mistakes) => mistakes.join("\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As far as the preset, which is not there.
    #[test]
    fn words_are_those_of_the_command_line() {
        let registry = crate::builtin_effects();
        for words in [
            &["render", "gone.ron"][..],
            &["render", "gone.ron", "--quiet"],
            &["render", "-o", "a.png", "--", "gone.ron"],
        ] {
            let words: Vec<String> = words.iter().copied().map(String::from).collect();
            let message = render_with(&words, &registry, &mut |_| true).unwrap_err();
            assert!(message.contains("there is no `gone.ron`"), "{message}");
        }
    }
}
