//! What the reports' pages share.

/// The beginning of a page.
pub fn head(title: &str, style: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{}</title>\n\
         <style>\nbody {{ font: 14px sans-serif; margin: 2em; background: #eee; }}\n{style}\n</style>\n",
        escape(title)
    )
}

/// Text as it may stand in a page, also in an attribute.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
