use super::*;
use proptest::prelude::*;

const EXAMPLE: &str = "// by hand
(
    version: 1,
    strands: [
        (points: [(0, 1.7, 0.0), (0.0, 1.7, 0.1)]),
        /* a pair */
        (size: 14.0, mirror: true, points: [(0.05, 1.7, 0.0), (0.1, 1.6, 0.0)]),
        (id: 40, points: [(0.0, 1.6, -0.1)]),
    ],
    motion: [
        (time: 0.5, strands: [
            [(0.0, 1.7, 0.0), (0.0, 1.7, 0.1)],
            [(0.05, 1.7, 0.0), (0.2, 1.6, 0.0)],
            [(0.0, 1.6, -0.2)],
        ]),
    ],
)
";

#[test]
fn the_example_is_read() {
    let (strands, motion) = from_text(EXAMPLE).unwrap();
    let ids: Vec<u32> = (0..strands.len()).map(|i| strands.id(i)).collect();
    assert_eq!(ids, [0, 1, 1 | MIRROR, 40]);
    assert_eq!(strands.size(0), None);
    assert_eq!((strands.size(1), strands.size(2)), (Some(14.0), Some(14.0)));
    assert_eq!(strands.strand(2)[1], Vec3::new(-0.1, 1.6, 0.0));
    let mut points = vec![Vec3::ZERO; strands.points().len()];
    motion.unwrap().sample(0.5, &mut points);
    assert_eq!(points[3], Vec3::new(0.2, 1.6, 0.0));
    assert_eq!(points[5], Vec3::new(-0.2, 1.6, 0.0));
    assert_eq!(points[6], Vec3::new(0.0, 1.6, -0.2));
}

/// The message for the example with `from` (found once) made `to`.
fn message(from: &str, to: &str) -> String {
    assert_eq!(EXAMPLE.matches(from).count(), 1, "{from}");
    from_text(&EXAMPLE.replace(from, to))
        .unwrap_err()
        .to_string()
}

#[test]
fn errors_tell_the_line_and_the_column() {
    let starts = |from: &str, to: &str, expected: &str| {
        let message = message(from, to);
        assert!(message.starts_with(expected), "{message}");
    };
    starts(
        "(0.1, 1.6",
        "(0.1, NaN",
        "line 7, column 63: strand 1, point 1: the position",
    );
    starts(
        "(0.1, 1.6",
        "(inf, 1.6",
        "line 7, column 63: strand 1, point 1: the position",
    );
    starts(
        "(0, 1.7",
        "(1e999, 1.7",
        "line 5, column 19: strand 0, point 0",
    );
    starts(
        "size: 14.0",
        "size: -1.0",
        "line 7, column 16: strand 1: the size -1",
    );
    starts(
        "size: 14.0",
        "size: NaN",
        "line 7, column 16: strand 1: the size NaN",
    );
    starts(
        "[(0.0, 1.6, -0.1)]",
        "[]",
        "line 8, column 9: strand 40 has no points",
    );
    starts(
        "id: 40",
        "id: 1",
        "line 8, column 9: the id 1 is used twice",
    );
    starts(
        "id: 40",
        "id: 2147483649",
        "line 8, column 9: the id 2147483649 is used twice",
    );
    starts(
        "id: 40",
        "id: -4",
        "line 8, column 15: Integer is out of bounds",
    );
    starts(
        "id: 40",
        "di: 40",
        "line 8, column 10: strands have no `di` here; there are: ",
    );
    starts(
        "motion:",
        "motions:",
        "line 10, column 5: strands have no `motions` here; there are: version, strands, motion",
    );
    starts(
        "time: 0.5",
        "time: NaN",
        "line 11, column 9: the time NaN was found",
    );
    starts(
        "(0.2, 1.6",
        "(-inf, 1.6",
        "line 13, column 32: the position [-inf, 1.6, 0] is not",
    );
    starts(
        "[(0.0, 1.6, -0.2)],",
        "",
        "line 11, column 9: 2 strands were found in the sample, 3",
    );
    starts(
        "(0.0, 1.6, -0.2)",
        "",
        "line 14, column 13: 0 points were found in the sample, the",
    );
    starts("(0.1, 1.6, 0.0)", "(0.1, 1.6)", "line 7, column ");
    starts("version: 1", "version: 0", "line 1, column 1: version 0");
    let newer = "version 7 is newer than this build, which reads up to version 1";
    assert_eq!(message("version: 1", "version: 7"), newer);
    assert_eq!(message("version: 1", "version: 7, curls: 3"), newer);
    let empty = from_text("(version: 1, strands: [])")
        .unwrap_err()
        .to_string();
    assert_eq!(empty, "line 1, column 1: at least one strand was expected");
}

#[test]
fn times_increase() {
    let sample = "(time: 0.5, strands: [[(0,0,0)]])";
    let text =
        format!("(version: 1, strands: [(points: [(0,0,0)])],\nmotion: [{sample}, {sample}])");
    let error = from_text(&text).unwrap_err();
    assert!(
        matches!(
            error,
            StrandsRonError::At {
                line: 2,
                column: 45,
                problem: Problem::Time { .. }
            }
        ),
        "{error}"
    );
}

#[test]
fn every_shorter_text_is_refused() {
    let whole = EXAMPLE.trim_end();
    for end in 0..whole.len() {
        assert!(
            matches!(from_text(&whole[..end]), Err(StrandsRonError::At { .. })),
            "{end}"
        );
    }
}

#[test]
fn deep_nesting_is_refused() {
    for (open, head) in [
        ("(", ""),
        ("[", "(version: 1, strands: ["),
        ("Some(", "(version: 1, motion: ["),
    ] {
        let text = head.to_string() + &open.repeat(100_000);
        assert!(matches!(from_text(&text), Err(StrandsRonError::At { .. })));
    }
}

fn position() -> impl Strategy<Value = Vec3> {
    let number = prop_oneof![
        -2.0f32..2.0,
        any::<f32>().prop_filter("finite", |x| x.is_finite())
    ];
    prop::array::uniform3(number).prop_map(Vec3::from)
}

prop_compose! {
    fn groom()(
        strands in prop::collection::vec((prop::collection::vec(position(), 1..6), prop::option::of(0.0..=Strands::LARGEST_SIZE)), 1..8),
        ids in prop::collection::hash_set(any::<u32>(), 8), numbered: bool,
    ) -> Strands {
        let mut read = Strands::new();
        for (index, ((points, size), id)) in strands.iter().zip(ids).enumerate() {
            read.push(if numbered { id } else { index as u32 }, points, *size).unwrap();
        }
        read
    }
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(
        strands in groom(), times in prop::collection::btree_set(-100i32..1000, 0..4), shift in position(),
    ) {
        let moved = |t: f32| strands.points().iter().map(|p| (*p * 0.5 + shift * 0.25 * t / 1000.0) + 0.0).collect();
        let samples: Vec<_> = times.iter().map(|&t| (t as f32 / 24.0, moved(t as f32))).collect();
        let motion = PointCache::new(samples).ok();
        let text = to_text(&strands, motion.as_ref());
        // As it is written, and as somebody has edited it, which is read as RON.
        prop_assert_eq!(written::read(&text), Some((strands.clone(), motion.clone())));
        let told = format!("// hair: 1 strand\n// step: 0.01\n{text}");
        prop_assert_eq!(written::read(&told), written::read(&text));
        let edited = text.replace(",(", ", (") + "// edited";
        prop_assert_eq!(written::read(&edited), None);
        for text in [text, edited] {
            prop_assert_eq!(from_text(&text).unwrap(), (strands.clone(), motion.clone()));
        }
    }

    /// What is cut short or has another number of anything is no bake as it is written, and RON tells what is wrong with it.
    #[test]
    fn what_is_wrong_in_a_bake_is_told(strands in groom(), at in 0.0..1.0) {
        let samples = [0.0, 0.5].map(|time| (time, strands.points().to_vec()));
        let motion = PointCache::new(samples.to_vec()).unwrap();
        let text = to_text(&strands, Some(&motion));
        // The last line is needed, the end of that isn't.
        let cut = &text[..(at * (text.len() - 3) as f64) as usize];
        prop_assert!(written::read(cut).is_none() && from_text(cut).is_err());
        let from = text.rfind("(time:").unwrap();
        for (part, other) in [("0.5,", "-0.5,"), ("[(", "[(0.0,0.0,0.0),("), ("(time:", "(tide:"), ("[(", "[(inf,0.0,0.0),(")] {
            let wrong = text[..from].to_owned() + &text[from..].replacen(part, other, 1);
            prop_assert!(written::read(&wrong).is_none() && from_text(&wrong).is_err(), "{}", wrong);
        }
        let twice = text.replacen("strands: [", "motion: [], strands: [", 1);
        prop_assert!(written::read(&twice).is_none() && from_text(&twice).is_err());
    }

    /// Of what is no groom as it is written what is read is what RON says of it.
    #[test]
    fn what_is_wrong_in_a_groom_is_told(strands in groom(), at in 0.0..1.0) {
        let text = to_text(&strands, None);
        let cut = &text[..(at * (text.len() - 3) as f64) as usize];
        prop_assert!(written::read(cut).is_none() && from_text(cut).is_err());
        for (part, other) in [
            ("points: [", "points: [(0.0,0.0)"), ("points: [(", "points: [(NaN,0.0,0.0),("), ("version: 1", "version: 2"), ("version: 1", "version: 0"),
            ("(points", "(id: -1, points"), ("(points", "(size: -1.0, points"), ("(points", "(size: 30001.0, points"), ("(points", "(size: inf, points"), ("(points", "(sizes: 1.0, points"), ("points", "size: 1.0, size: 1.0, points"),
        ] {
            let wrong = text.replacen(part, other, 1);
            prop_assert!(wrong == text || written::read(&wrong).is_none() && from_text(&wrong).is_err(), "{}", wrong);
        }
        // Two of one id.
        let first = text.lines().nth(1).unwrap();
        let twice = text.replacen(first, &format!("{first}\n{}", first.replacen('(', &format!("(id: {}, ", strands.id(0)), 1)), 1);
        prop_assert!(first.starts_with("(id") || written::read(&twice).is_none() && from_text(&twice).is_err(), "{}", twice);
    }

    #[test]
    fn altered_texts_never_panic(at in 0usize..700, with in "[-0-9a-z(){}:,.\\[\\]\"/* ]{0,3}") {
        let mut text = EXAMPLE.to_string();
        let at = at.min(text.len() - 1);
        text.replace_range(at..=at, &with);
        let _ = from_text(&text);
    }
}
