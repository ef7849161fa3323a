//! The page that shows how pictures differ from the golden ones.

use std::fmt::Write;

use super::case::Case;
use super::sheet;
use super::verdict::Verdict;
use crate::html::{escape, head};

const STYLE: &str =
    "section { margin: 0 0 2em; } figure { display: inline-block; margin: 0 1em 0 0; }
img { display: block; max-width: 30vw; border: 1px solid #999; image-rendering: pixelated;
  background: repeating-conic-gradient(#fff 0 25%, #ddd 0 50%) 0 0 / 16px 16px; }
.cell { display: inline-block; width: 96px; height: 96px; border: 1px solid #999; }
h2.same { color: #272; } h2.wrong { color: #a22; }";

/// The page of a run. Cases that are wrong come first, then those that are right.
pub fn page<'a>(results: impl Iterator<Item = (&'a Case, &'a Verdict)>) -> String {
    let (same, wrong): (Vec<_>, Vec<_>) = results.partition(|(_, verdict)| verdict.is_good());
    let mut page = head("Golden pictures", STYLE);
    let count = format!("{} passed, {} failed", same.len(), wrong.len());
    push(
        &mut page,
        format_args!("<h1>Golden pictures: {count}</h1>\n"),
    );
    for (case, verdict) in wrong.into_iter().chain(same) {
        section(&mut page, case, verdict);
    }
    page
}

fn section(page: &mut String, case: &Case, verdict: &Verdict) {
    let (class, pictures): (_, &[&str]) = match verdict {
        Verdict::Same => ("same", &["actual"]),
        Verdict::Agrees(_) => ("same", &["expected", "actual"]),
        Verdict::Disagrees(..) => ("wrong", &["expected", "actual", "difference"]),
        Verdict::New => ("wrong", &["actual"]),
        Verdict::Differs { .. } => ("wrong", &["expected", "actual", "difference"]),
        Verdict::Failed(_) => ("wrong", &["expected", "actual"]),
    };
    let name = &case.name;
    let sentence = escape(&verdict.sentence());
    let args = escape(&case.args.join(" "));
    push(
        page,
        format_args!(
            "<section>\n<h2 class=\"{class}\">{name}</h2>\n<pre>{sentence}</pre>\n\
             <p><code>inkstrand render {args}</code></p>\n"
        ),
    );
    for what in pictures {
        push(
            page,
            format_args!(
                "<figure><img src=\"{name}.{what}.png\" alt=\"none\">\
                 <figcaption>{what}</figcaption></figure>\n"
            ),
        );
    }
    let differing: &[String] = match verdict {
        Verdict::Differs { cells, .. } | Verdict::Disagrees(_, cells) => cells,
        _ => &[],
    };
    if !case.cells.is_empty() {
        cells(page, case, pictures, differing);
    }
    page.push_str("</section>\n");
}

/// The cells of a sheet that differ, one a row, cut out of its pictures; all of them where none does.
fn cells(page: &mut String, case: &Case, pictures: &[&str], differing: &[String]) {
    page.push_str("<table>\n");
    for (index, cell) in case.cells.iter().enumerate() {
        if !differing.is_empty() && !differing.contains(&cell.name) {
            continue;
        }
        push(
            page,
            format_args!("<tr><td><code>{}</code></td>", escape(&cell.name)),
        );
        let (x, y) = sheet::corner(index);
        for what in pictures {
            push(
                page,
                format_args!(
                    "<td><span class=\"cell\" title=\"{what}\" \
                     style=\"background: url({}.{what}.png) -{x}px -{y}px\"></span></td>",
                    case.name
                ),
            );
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</table>\n");
}

fn push(page: &mut String, text: std::fmt::Arguments) {
    // Writing to a String cannot fail.
    let _ = page.write_fmt(text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Difference;

    #[test]
    fn wrong_cases_come_first_with_three_pictures() {
        let case = |name: &str| Case {
            name: name.to_owned(),
            args: vec!["presets/<a>.ron".to_owned()],
            cells: Vec::new(),
        };
        let cases = [case("good"), case("bad"), case("undrawn")];
        let differs = Verdict::Differs {
            difference: Difference {
                pixels: 7,
                largest: 514,
            },
            cells: Vec::new(),
        };
        let failed = Verdict::Failed("expected `>` & found `<`".to_owned());
        let verdicts = [Verdict::Same, differs, failed];
        let page = page(cases.iter().zip(&verdicts));

        assert!(page.contains("1 passed, 2 failed"));
        assert!(page.find(">bad<") < page.find(">good<"));
        for what in ["expected", "actual", "difference"] {
            assert!(page.contains(&format!("src=\"bad.{what}.png\"")));
        }
        assert!(!page.contains("good.difference.png"));
        assert!(page.contains("7 pixels, by 2.000/255 at most"));
        assert!(page.contains("presets/&lt;a&gt;.ron"));
        assert!(page.contains("expected `&gt;` &amp; found `&lt;`"));
    }
}
