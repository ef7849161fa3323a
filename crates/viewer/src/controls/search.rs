//! What is looked for.

/// The words of a search: what matches has each of them, in upper or lower case, in one of its texts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Search {
    words: Vec<String>,
}

impl Search {
    /// A search for the words of a text; without any everything matches.
    #[must_use]
    pub fn new(text: &str) -> Self {
        let words = text.to_lowercase();
        let words = words.split_whitespace().map(str::to_owned).collect();
        Self { words }
    }

    /// Whether there is something to look for.
    #[must_use]
    pub fn is_active(&self) -> bool {
        !self.words.is_empty()
    }

    /// Whether each word is in one of these texts.
    #[must_use]
    pub fn matches(&self, texts: &[&str]) -> bool {
        let has = |word: &String| texts.iter().any(|text| text.to_lowercase().contains(word));
        self.words.iter().all(has)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_word_is_in_one_of_the_texts() {
        let texts = ["shrink_start", "Where the Strand begins.", "clump"];
        for (search, expected) in [
            ("", true),
            ("  ", true),
            ("CLUMP", true),
            ("strand shrink", true),
            ("strand width", false),
        ] {
            assert_eq!(Search::new(search).matches(&texts), expected, "{search}");
        }
        assert!(!Search::new(" ").is_active());
    }
}
