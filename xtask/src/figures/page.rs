//! The page of all figures.

use std::fmt::Write as _;

use super::{Figure, Finding, file_name};
use crate::html::{escape, head};

const STYLE: &str = "section { max-width: 1340px; margin: 0 0 3em; } p { max-width: 60em; }
img { display: block; max-width: 100%; } figure { display: inline-block; margin: 0 1em 1em 0; }
.measured { color: #272; } .failed { color: #a22; }";

/// The page: each figure with its text, pictures, and what was measured.
pub fn page(results: &[(&Figure, Result<Finding, String>)]) -> String {
    let mut page = head("The source's figures, drawn by inkstrand", STYLE);
    page += "<h1>The source's figures, drawn by inkstrand</h1>\n\
             <p>Figures of Chang, <cite>Real-time Stylized Line-based Rendering of Animated Hairs</cite> (2012), by \
             their numbers there; of Shin, Haller and Mukundan, <cite>A Stylized Cartoon Hair Renderer</cite> (2006), behind an S, and of \
             a dissertation on cartoon hair in Ogre behind a D. Every picture is one that <code>inkstrand render</code> makes; what a figure \
             claims is measured on it.</p>\n";
    for (figure, finding) in results {
        section(&mut page, figure, finding);
    }
    page
}

fn section(page: &mut String, figure: &Figure, finding: &Result<Finding, String>) {
    let (class, said) = match finding {
        Ok(finding) => ("measured", format!("Measured: {}.", finding.sentence)),
        Err(error) => ("failed", format!("FAILED: {error}")),
    };
    // Writing to a String cannot fail.
    let _ = writeln!(
        page,
        "<section>\n<h2>{} {}</h2>\n<p>{}</p>",
        figure.number,
        escape(figure.title),
        escape(figure.text)
    );
    for (index, shot) in figure.shots.iter().enumerate() {
        if shot.label.is_empty() {
            continue;
        }
        let _ = writeln!(
            page,
            "<figure><img src=\"{}\" alt=\"none\"><figcaption title=\"inkstrand render {}\">{}</figcaption></figure>",
            file_name(figure, index),
            escape(&shot.line().join(" ")),
            escape(shot.label)
        );
    }
    let drawing = finding
        .as_ref()
        .ok()
        .and_then(|finding| finding.drawing.as_deref());
    if let Some(drawing) = drawing {
        let _ = writeln!(page, "<div>{drawing}</div>");
    }
    let _ = writeln!(
        page,
        "<p class=\"{class}\">{}</p>\n</section>",
        escape(&said)
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Shot;

    #[test]
    fn a_figure_has_its_text_pictures_and_measure() {
        const SHOTS: &[Shot] = &[
            Shot::new("shown", "stroke.ron", &[]),
            Shot::new("", "stroke.ron", &[]),
        ];
        let figure = Figure {
            number: "9.9",
            title: "Less < more",
            text: "What is seen.",
            shots: SHOTS,
            measure: |_| Err("never".into()),
        };
        let finding = Finding::new("3 < 4".to_owned());
        let page = page(&[(&figure, Ok(finding)), (&figure, Err("blank".to_owned()))]);
        assert!(page.contains("9.9 Less &lt; more") && page.contains("What is seen."));
        assert!(page.contains("src=\"9.9-1.png\"") && !page.contains("9.9-2.png"));
        assert!(page.contains("Measured: 3 &lt; 4.") && page.contains("FAILED: blank"));
    }
}
