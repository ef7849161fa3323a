//! What controls ask to be done to a document's text.

use effects::preset::edit::{self, EditError, Step};

/// A place in a document: `layers`, item 2, `params`, `width`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Place(Vec<PlaceStep>);

/// One step on the way to a place.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum PlaceStep {
    Field(String),
    Item(usize),
}

impl Place {
    /// The whole document.
    #[must_use]
    pub fn top() -> Self {
        Self::default()
    }

    /// The field of that name in what is here.
    #[must_use]
    pub fn field(&self, name: &str) -> Self {
        self.with(PlaceStep::Field(name.to_owned()))
    }

    /// The item of that number, 0 first, in the list that is here.
    #[must_use]
    pub fn item(&self, index: usize) -> Self {
        self.with(PlaceStep::Item(index))
    }

    fn with(&self, step: PlaceStep) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }

    /// The same for [`effects::preset::edit`].
    #[must_use]
    pub fn steps(&self) -> Vec<Step<'_>> {
        let steps = self.0.iter().map(|step| match step {
            PlaceStep::Field(name) => Step::Field(name),
            PlaceStep::Item(index) => Step::Item(*index),
        });
        steps.collect()
    }
}

/// One change of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edit {
    /// The value there becomes this text; what is not there yet is added.
    Set(Place, String),
    /// The field or item there goes, with its comments.
    Remove(Place),
    /// A new item of a list, before the one of that number or at its end.
    Insert(Place, usize, String),
    /// An item of a list gets another number: from, to.
    Move(Place, usize, usize),
}

impl Edit {
    /// The text after this change.
    ///
    /// # Errors
    ///
    /// When the text can't be read, or has no such place.
    pub fn apply(&self, text: &str) -> Result<String, EditError> {
        match self {
            Self::Set(place, value) => edit::set(text, &place.steps(), value),
            Self::Remove(place) => edit::remove(text, &place.steps()),
            Self::Insert(list, at, item) => edit::insert(text, &list.steps(), *at, item),
            Self::Move(list, from, to) => edit::move_item(text, &list.steps(), *from, *to),
        }
    }
}
