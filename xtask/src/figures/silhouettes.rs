//! Lines around clumps, and what comes before what: Figures 5.5 to 5.7.

use std::ops::RangeInclusive;

use super::measure::{count, is, rgb};
use super::{Figure, Finding, Shot, claim};
use crate::Outcome;
use crate::picture::Picture;

/// Colours of `order.ron` and `hair.ron`.
const BASE: u32 = 0x3F_C1C0;
const LINE: u32 = 0x12_4A57;
/// Colours of `crossing.ron`.
const GREEN: u32 = 0x6F_BF73;
const BLUE: u32 = 0x4E_86D8;

pub const FIGURES: &[Figure] = &[
    Figure {
        number: "5.5",
        title: "The line's stroke, and the order of strokes",
        text: "(a) A silhouette is the clump's stroke once more, larger and in the line's colour. (b) By depth alone, \
               the larger stroke of what is near lies over the clump's own stroke: only the places nearest to the eye \
               show. (c) All silhouettes first, then all clumps: lines around the whole, none inside. (d) By \
               rank within a strand and by depth among strands: what an artist would draw.",
        shots: &[
            Shot::new("(a) one clump", "order.ron", &["--guides=1"]),
            Shot::new(
                "(b) depth order",
                "order.ron",
                &[
                    "--set=scene.order=shifted",
                    "--set=hair.silhouette.depth_offset=0",
                ],
            ),
            Shot::new(
                "(c) stroke order",
                "order.ron",
                &[
                    "--set=scene.order=shifted",
                    "--set=hair.silhouette.depth_offset=10",
                ],
            ),
            Shot::new("(d) both", "order.ron", &[]),
        ],
        measure: orders,
    },
    Figure {
        number: "5.6",
        title: "Silhouettes behind their strokes",
        text: "Two clumps that pass from before each other to behind. (a) From the side (the eye is on the right): each \
               clump, and thin behind it the depth of its silhouette, which is shifted away from the eye. The \
               source's surfaces are drawn here as strands. (b) From the eye: the green one is in front above, \
               the blue one below. (c) The same in white with black lines: a line ends where the clumps touch, because \
               there the shifted silhouette lies behind both.",
        shots: &[
            Shot::new(
                "(a) from the side",
                "crossing.ron",
                &[
                    "--camera=90,0",
                    "--hair=tests/figures/crossing-side.strands.ron",
                    "--only=hair.base",
                    "--only=hair.cel",
                ],
            ),
            Shot::new("(b) from the eye", "crossing.ron", &[]),
            Shot::new(
                "(c) lines alone",
                "crossing.ron",
                &[
                    "--set=clump.color=FFFFFF",
                    "--set=hair.cel.color=FFFFFF",
                    "--set=hair.silhouette.color=000000",
                ],
            ),
        ],
        measure: crosses,
    },
    Figure {
        number: "5.7",
        title: "The depth shift sets how many lines there are",
        text: "The same hair and the same lines; only how far silhouettes are shifted behind their clumps differs. \
               (a) Very far: the outer boundary alone. (b) A little: some clumps stand out. (c) Not at all: a line \
               around every clump.",
        shots: &[
            Shot::new(
                "(a) 1 head height",
                "hair.ron",
                &[
                    "--only=hair.silhouette",
                    "--only=hair.base",
                    "--set=hair.silhouette.depth_offset=1",
                ],
            ),
            Shot::new(
                "(b) 0.04",
                "hair.ron",
                &[
                    "--only=hair.silhouette",
                    "--only=hair.base",
                    "--set=hair.silhouette.depth_offset=0.04",
                ],
            ),
            Shot::new(
                "(c) 0",
                "hair.ron",
                &[
                    "--only=hair.silhouette",
                    "--only=hair.base",
                    "--set=hair.silhouette.depth_offset=0",
                ],
            ),
        ],
        measure: densities,
    },
];

fn orders(pictures: &[Picture]) -> Outcome<Finding> {
    let [_, depth, stroke, both] = pictures else {
        return Err("four pictures were expected".into());
    };
    let lines = [depth, stroke, both].map(|picture| {
        let (line, base) = (
            count(picture, rgb(LINE)) as f64,
            count(picture, rgb(BASE)) as f64,
        );
        100.0 * line / (line + base).max(1.0)
    });
    claim(
        lines[0] > 70.0 && lines[1] > 1.0 && lines[1] * 1.15 < lines[2] && lines[2] < 35.0,
        format!(
            "line pixels among all: {:.1} % in depth order, {:.1} % in stroke order, {:.1} % in both",
            lines[0], lines[1], lines[2]
        ),
    )
}

/// Which clump the picture's middle column shows, from the top: each change once.
fn down_the_middle(picture: &Picture) -> Vec<&'static str> {
    let mut seen = Vec::new();
    for pixel in picture.column(picture.width / 2) {
        let here = [("green", GREEN), ("blue", BLUE)]
            .into_iter()
            .find(|(_, hex)| is(pixel, rgb(*hex)));
        if let Some((name, _)) = here
            && seen.last() != Some(&name)
        {
            seen.push(name);
        }
    }
    seen
}

fn crosses(pictures: &[Picture]) -> Outcome<Finding> {
    let seen = down_the_middle(&pictures[1]);
    let lines = lines_half_way_down(&pictures[2]);
    let said: Vec<String> = lines.iter().map(|run| format!("{run:?}")).collect();
    claim(
        seen == ["green", "blue"] && are_at_the_outer_sides(&lines, pictures[2].width),
        format!(
            "down the middle one sees {}; half way down, lines are in columns {} of {}",
            seen.join(", then "),
            said.join(" and "),
            pictures[2].width
        ),
    )
}

/// Where the picture's middle row is black: the first and last column of each run of neighbours.
fn lines_half_way_down(picture: &Picture) -> Vec<RangeInclusive<u32>> {
    let mut runs: Vec<RangeInclusive<u32>> = Vec::new();
    for x in 0..picture.width {
        if !is(picture.pixel(x, picture.height / 2), rgb(0)) {
            continue;
        }
        match runs.last_mut() {
            Some(run) if run.end() + 1 == x => *run = *run.start()..=x,
            _ => runs.push(x..=x),
        }
    }
    runs
}

/// One line to each side and none between: where both clumps are equally deep no line parts them. The middle is that of the
/// picture, and a tenth of its width to both sides.
fn are_at_the_outer_sides(lines: &[RangeInclusive<u32>], width: u32) -> bool {
    let (middle, apart) = (width / 2, width / 10);
    match lines {
        [left, right] => left.end() + apart < middle && middle + apart < *right.start(),
        _ => false,
    }
}

fn densities(pictures: &[Picture]) -> Outcome<Finding> {
    let lines: Vec<usize> = pictures
        .iter()
        .map(|picture| count(picture, rgb(LINE)))
        .collect();
    claim(
        lines[0] > 100 && lines[0] * 5 < lines[1] * 4 && lines[1] * 5 < lines[2] * 4,
        format!(
            "line pixels: (a) {}, (b) {}, (c) {}",
            lines[0], lines[1], lines[2]
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// White, with lines in these columns.
    fn lined(columns: &[u32]) -> Picture {
        let mut picture = Picture::blank(360, 3);
        picture.pixels.fill([u16::MAX; 4]);
        for x in columns {
            picture.pixels[(360 + x) as usize] = [0, 0, 0, u16::MAX];
        }
        picture
    }

    #[test]
    fn lines_are_one_to_each_side_and_none_between() {
        for (columns, holds) in [
            (&[116, 117, 118, 119, 240, 241][..], true),
            (&[116, 117, 180, 240], false),
            (&[116, 118, 240], false),
            (&[116, 160], false),
            (&[116, 117], false),
            (&[150, 240], false),
            (&[], false),
        ] {
            let lines = lines_half_way_down(&lined(columns));
            assert_eq!(are_at_the_outer_sides(&lines, 360), holds, "{lines:?}");
        }
        assert_eq!(lines_half_way_down(&lined(&[4, 5, 9])), [4..=5, 9..=9]);
    }
}
