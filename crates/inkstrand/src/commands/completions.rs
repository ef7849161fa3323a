//! `inkstrand completions`: what makes a shell complete the command line.

use crate::{Failure, say};
use clap_complete::{Shell, generate};

pub(crate) fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    generate(shell, &mut crate::command(), "inkstrand", &mut script);
    Ok(say::print(&String::from_utf8_lossy(&script))?)
}
