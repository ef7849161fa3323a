//! Changes of texts of random layouts.

use crate::writer::{Known, Writer};
use crate::{Way, reads, steps};
use effects::preset::edit::{self, Step, Step::Field, Step::Item};
use proptest::prelude::*;

/// The marks of all comments, in the order of the text.
fn marks(text: &str) -> Vec<String> {
    let starts = text.match_indices('<');
    starts
        .map(|(i, _)| text[i..].split_inclusive('>').next().unwrap().to_owned())
        .collect()
}

fn sorted(mut marks: Vec<String>) -> Vec<String> {
    marks.sort();
    marks
}

/// What is there of these values but `left_out` and what is in it.
fn others<'a>(known: &'a [Known], left_out: &'a [Way]) -> impl Iterator<Item = &'a Known> {
    let apart =
        move |known: &&Known| !known.way.starts_with(left_out) && !left_out.starts_with(&known.way);
    known.iter().filter(apart)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn values_are_found(seed: u64) {
        let (text, known) = Writer::new(seed).preset();
        reads(&text)?;
        for one in &known {
            let way = steps(&one.way);
            prop_assert_eq!(edit::get(&text, &way), Some(&*one.value), "{:?} in {}", way, text);
            let (last, above) = one.way.split_last().unwrap();
            match last {
                Way::Name(name) => {
                    let fields = edit::fields(&text, &steps(above));
                    prop_assert!(fields.contains(&(name, &one.value)));
                }
                Way::Index(index) => {
                    prop_assert_eq!(edit::items(&text, &steps(above))[*index], &*one.value);
                }
            }
        }
    }

    #[test]
    fn a_set_value_is_there_and_nothing_else_is_changed(seed: u64, pick: prop::sample::Index) {
        let (text, known) = Writer::new(seed).preset();
        prop_assume!(!known.is_empty());
        let one = pick.get(&known);
        let way = steps(&one.way);
        let span = edit::span(&text, &way).unwrap();
        for value in ["7.25", "(a: 1, /* ( */ b: [\"]\"])", "\"// )\""] {
            let changed = edit::set(&text, &way, value).unwrap();
            prop_assert_eq!(&changed, &format!("{}{value}{}", &text[..span.start], &text[span.end..]));
            reads(&changed)?;
        }
    }

    #[test]
    fn a_field_is_added_and_removed_again(seed: u64, pick: prop::sample::Index, deep: bool) {
        let (text, known) = Writer::new(seed).preset();
        let mut sections: Vec<&[Way]> = vec![&[]];
        sections.extend(known.iter().filter(|k| k.is_section).map(|k| &k.way[..]));
        let above = pick.get(&sections);
        let mut way = above.to_vec();
        way.push(Way::Name("new".into()));
        let mut whole = way.clone();
        if deep {
            whole.push(Way::Name("inner".into()));
        }
        let added = edit::set(&text, &steps(&whole), "(1, 2)").unwrap();
        reads(&added)?;
        prop_assert_eq!(edit::get(&added, &steps(&whole)), Some("(1, 2)"));
        prop_assert_eq!(marks(&added), marks(&text), "{}\n=>\n{}", text, added);
        let is_on_one_line = !edit::get(&text, &steps(above)).unwrap().contains('\n');
        prop_assert!(!is_on_one_line || added.lines().count() == text.lines().count());
        for other in others(&known, &way) {
            prop_assert_eq!(edit::get(&added, &steps(&other.way)), Some(&*other.value));
        }

        let removed = edit::remove(&added, &steps(&way)).unwrap();
        reads(&removed)?;
        prop_assert_eq!(edit::get(&removed, &steps(&way)), None);
        prop_assert_eq!(marks(&removed), marks(&text), "{}\n=>\n{}\n=>\n{}", text, added, removed);
        for other in others(&known, &way) {
            prop_assert_eq!(edit::get(&removed, &steps(&other.way)), Some(&*other.value));
        }
        prop_assert!(text.contains('\r') || !removed.contains('\r'));
        prop_assert!(!text.contains('\r') || !removed.replace("\r\n", "").contains('\n'));
    }

    #[test]
    fn what_is_removed_goes_with_its_comments_alone(seed: u64, pick: prop::sample::Index) {
        let (text, known) = Writer::new(seed).preset();
        prop_assume!(!known.is_empty());
        let one = pick.get(&known);
        let removed = edit::remove(&text, &steps(&one.way)).unwrap();
        reads(&removed)?;
        let mut left = marks(&text);
        left.retain(|mark| !one.comments.contains(mark));
        prop_assert_eq!(marks(&removed), left, "{:?} of {}\n=>\n{}", &one.way, text, removed);
        let (last, above) = one.way.split_last().unwrap();
        match last {
            Way::Name(name) => {
                prop_assert_eq!(edit::get(&removed, &steps(&one.way)), None);
                let mut fields = edit::fields(&text, &steps(above));
                fields.retain(|(other, _)| other != name);
                prop_assert_eq!(edit::fields(&removed, &steps(above)), fields);
            }
            Way::Index(index) => {
                let mut items = edit::items(&text, &steps(above));
                items.remove(*index);
                prop_assert_eq!(edit::items(&removed, &steps(above)), items);
            }
        }
        for other in others(&known, above).filter(|_| !above.is_empty()) {
            prop_assert_eq!(edit::get(&removed, &steps(&other.way)), Some(&*other.value));
        }
    }

    #[test]
    fn items_are_inserted_and_removed_again(seed: u64, pick: prop::sample::Index, at in 0..5_usize) {
        let (text, known) = Writer::new(seed).preset_with_list();
        let lists: Vec<&Known> = known.iter().filter(|k| k.items.is_some()).collect();
        let list = pick.get(&lists);
        let way = steps(&list.way);
        let inserted = edit::insert(&text, &way, at, "(new: \"[\")").unwrap();
        reads(&inserted)?;
        let before = edit::items(&text, &way);
        let at = at.min(before.len());
        let mut items = before.clone();
        items.insert(at, "(new: \"[\")");
        prop_assert_eq!(edit::items(&inserted, &way), items);
        prop_assert_eq!(marks(&inserted), marks(&text), "{}\n=>\n{}", text, inserted);

        let item: Vec<Step> = way.iter().copied().chain([Item(at)]).collect();
        let removed = edit::remove(&inserted, &item).unwrap();
        prop_assert_eq!(edit::items(&removed, &way), before);
        prop_assert_eq!(marks(&removed), marks(&text), "{}\n=>\n{}\n=>\n{}", text, inserted, removed);
    }

    #[test]
    fn items_move_with_their_comments(seed: u64, pick: prop::sample::Index, picks: [prop::sample::Index; 2]) {
        let (text, known) = Writer::new(seed).preset_with_list();
        let lists: Vec<&Known> = known.iter().filter(|k| k.items > Some(0)).collect();
        let list = pick.get(&lists);
        let way = steps(&list.way);
        let mut items = edit::items(&text, &way);
        let [from, to] = picks.map(|pick| pick.index(items.len()));
        let moved = edit::move_item(&text, &way, from, to).unwrap();
        reads(&moved)?;
        prop_assert_eq!(sorted(marks(&moved)), sorted(marks(&text)), "{}\n=>\n{}", text, moved);
        let item = items.remove(from);
        items.insert(to, item);
        prop_assert_eq!(edit::items(&moved, &way), items, "{}\n=>\n{}", text, moved);
        // Its comments are its own there as well.
        let place: Vec<Way> = list.way.iter().cloned().chain([Way::Index(from)]).collect();
        let own = &known.iter().find(|k| k.way == place).unwrap().comments;
        let there: Vec<Step> = way.iter().copied().chain([Item(to)]).collect();
        let removed = edit::remove(&moved, &there).unwrap();
        let mut left = marks(&moved);
        left.retain(|mark| !own.contains(mark));
        prop_assert_eq!(marks(&removed), left, "{} from {} to {}\n=>\n{}", text, from, to, moved);
        // There and back is the same list.
        let back = edit::move_item(&moved, &way, to, from).unwrap();
        prop_assert_eq!(edit::items(&back, &way), edit::items(&text, &way));
    }

    #[test]
    fn damaged_texts_never_panic(seed: u64, cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<char>(), 0..6_usize), 1..4)) {
        let (mut text, known) = Writer::new(seed).preset();
        for (at, other, sort) in cuts {
            let places: Vec<usize> = text.char_indices().map(|(i, _)| i).collect();
            if places.is_empty() { break; }
            let at = *at.get(&places);
            match sort {
                0 => drop(text.remove(at)),
                1 => text.insert(at, other),
                2 => text.truncate(at),
                n => text.insert(at, [',', ':', '('][n - 3]),
            }
        }
        for one in known.iter().map(|k| &k.way[..]).chain([&[][..]]) {
            let way = steps(one);
            let _ = edit::get(&text, &way);
            let _ = edit::fields(&text, &way);
            let _ = edit::items(&text, &way);
            let field: Vec<Step> = way.iter().copied().chain([Field("new")]).collect();
            for changed in [
                edit::set(&text, &way, "1"),
                edit::set(&text, &field, "1"),
                edit::remove(&text, &way),
                edit::insert(&text, &way, 1, "1"),
                edit::move_item(&text, &way, 0, 1),
            ] {
                match changed {
                    // What came of it has brackets that match.
                    Ok(changed) => prop_assert!(edit::get(&changed, &[]).is_some(), "{} => {}", text, changed),
                    Err(error) => prop_assert!(!error.to_string().is_empty()),
                }
            }
        }
    }
}
