//! The pictures of the pages for those who make looks. The test that follows the pages draws them, as it knows how: this asks it
//! to write in place of comparing.

use crate::Outcome;
use crate::program::{cargo, on_ci, succeed};

/// Writes `docs/images/styling`, `docs/images/gallery` and `docs/images/motion`.
///
/// # Errors
/// A page doesn't hold, or this is a machine that tests by itself: new pictures are to be looked at.
pub fn run() -> Outcome {
    if on_ci() {
        return Err("new pictures are looked at: not where CI=true".into());
    }
    let mut test = cargo(&["test", "--package=inkstrand", "--test=styling"]);
    test.env("INKSTRAND_PICTURES", "draw");
    succeed(test)?;
    println!(
        "  docs/images/styling, docs/images/gallery and docs/images/motion are drawn: look at them before they are kept"
    );
    Ok(())
}
