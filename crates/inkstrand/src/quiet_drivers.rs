//! Graphics drivers that complain where there is no desktop.

/// Starts the program anew, in this process, with `XDG_RUNTIME_DIR` set, where it is not.
///
/// While Vulkan looks for graphics cards, a layer of Mesa's asks the Wayland desktop which one it draws on; without that
/// variable, as over ssh, in containers and on farms, libwayland writes "error: XDG_RUNTIME_DIR is invalid" to the
/// standard error, which scripts take for a failure of ours. Nothing but the environment stops it, and that can be
/// changed safely only for a program that is about to start. Under /dev/null no socket can be, nor be put by another:
/// the layer finds no desktop, as before, and says nothing. Where starting fails, the noise is all that comes of it.
#[cfg(all(feature = "gpu", target_os = "linux"))]
pub fn start_without_noise() {
    use std::env::{args_os, current_exe, var_os};
    use std::os::unix::process::CommandExt as _;
    use std::path::Path;

    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    // libwayland takes absolute paths alone.
    if var_os(VARIABLE).is_some_and(|folder| Path::new(&folder).is_absolute()) {
        return;
    }
    let mut arguments = args_os();
    if let (Ok(program), Some(own_name)) = (current_exe(), arguments.next()) {
        // Started by a loader (`ld-linux.so ./inkstrand`), the process's program is the loader, which would take our arguments for its.
        if program.file_name() != Path::new(&own_name).file_name() {
            return;
        }
        // It returns only where it fails.
        let _ = std::process::Command::new(program)
            .arg0(own_name)
            .args(arguments)
            .env(VARIABLE, "/dev/null")
            .exec();
    }
}

/// Elsewhere drivers have nothing to say.
#[cfg(not(all(feature = "gpu", target_os = "linux")))]
pub fn start_without_noise() {}
