//! Names in a preset: several in one text.

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
}
