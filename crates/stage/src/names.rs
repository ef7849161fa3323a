//! Names in a preset: several in one text.

use effects::preset::{nearest, suggestion};
use std::iter::once;

/// Names with commas between them; `*` at the end of one stands for anything. Large letters of ASCII are as small ones.
#[derive(Clone, Copy)]
pub(crate) struct Names<'a>(pub &'a str);

impl<'a> Names<'a> {
    pub(crate) fn iter(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let names = self.0.split(',').map(str::trim);
        names.filter(|name| !name.is_empty())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }

    /// Whether `own` is one of them.
    pub(crate) fn have(&self, own: &str) -> bool {
        self.iter().any(|name| is_meant(name, own))
    }

    /// The first that none of `all` is called.
    pub(crate) fn unknown<'m, I: Iterator<Item = &'m str>>(
        &self,
        all: impl Fn() -> I,
    ) -> Option<&'a str> {
        self.iter()
            .find(|name| !all().any(|own| is_meant(name, own)))
    }
}

/// Whether a name of the list means `own`.
pub(crate) fn is_meant(name: &str, own: &str) -> bool {
    match name.strip_suffix('*') {
        Some(start) => own
            .get(..start.len())
            .is_some_and(|own| own.eq_ignore_ascii_case(start)),
        None => own.eq_ignore_ascii_case(name),
    }
}

/// The end of a sentence about a name of the list that nothing of a file has: what it may have meant, as [`suggestion`] says it. Programs put names of several
/// words together (`HairBall_L`, `Mesh.hair.001`), so those count, too, that have a word like the wrong name.
pub(crate) fn meant_name<'a>(wrong: &str, all: impl IntoIterator<Item = &'a str>) -> String {
    let wrong = wrong.trim_end_matches('*');
    let all: Vec<&str> = all.into_iter().collect();
    let with_words = all.iter().flat_map(|name| once(*name).chain(words(name)));
    let Some(near) = nearest(wrong, with_words) else {
        return suggestion(wrong, all);
    };
    let has_it = |name: &&str| once(*name).chain(words(name)).any(|part| part == near);
    let having = || all.iter().copied().filter(has_it);
    let name = nearest(wrong, having()).or(having().next());
    format!(", did you mean `{:.60}`?", name.unwrap_or(near))
}

/// The words of a name: between what is no letter, and where small letters turn large.
fn words(name: &str) -> impl Iterator<Item = &str> {
    let parts = name.split(|c: char| !c.is_alphabetic());
    parts.flat_map(|part| {
        let pairs = part.char_indices().zip(part.chars().skip(1));
        let ends = pairs.filter(|((_, c), next)| c.is_lowercase() && next.is_uppercase());
        let ends = ends.map(|((at, c), _)| at + c.len_utf8());
        let mut from = 0;
        let words = ends.chain(once(part.len())).map(move |end| {
            let word = &part[from..end];
            from = end;
            word
        });
        words.filter(|word| !word.is_empty())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_between_commas_and_a_star_is_any_end() {
        let names = Names("fringe, Tail*, ,");
        assert!(names.have("fringe") && names.have("FRINGE"));
        assert!(names.have("tail") && names.have("tail.left"));
        assert!(!names.have("fringes") && !names.have("tai") && !names.have(""));
        assert!(!names.have("taü") && Names("é*").have("été"));
        assert!(Names(" ,").is_empty() && !names.is_empty() && Names("*").have(""));
    }

    #[test]
    fn a_wrong_name_may_mean_one_with_a_word_like_it() {
        let all = [
            "Face",
            "FaceMesh",
            "thigh.l_Armature",
            "shin.l_Armature",
            "HairBall_L",
            "head_Armature",
            "ÄrmelÜber",
        ];
        for (wrong, near) in [
            ("Fcae", "Face"),
            ("Facemsh", "FaceMesh"),
            ("Hiar", "HairBall_L"),
            ("hiar*", "HairBall_L"),
            ("haed", "head_Armature"),
            ("Ballx", "HairBall_L"),
            ("übre", "ÄrmelÜber"),
        ] {
            assert_eq!(
                meant_name(wrong, all),
                format!(", did you mean `{near}`?"),
                "{wrong}"
            );
        }
        assert_eq!(meant_name("qqq", ["a", "b"]), "; there are: a, b");
        assert_eq!(meant_name("qqq", []), "; there are none");
        let parts: Vec<&str> = words("J_Bip.HairBall001éÈ").collect();
        assert_eq!(parts, ["J", "Bip", "Hair", "Ball", "é", "È"]);
    }
}
