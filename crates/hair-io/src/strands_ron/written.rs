//! Strands and their motion as [`to_text`](super::to_text) writes them, line by line: a groom has hundreds of thousands of numbers, a bake millions, which are
//! read much sooner where it is known beforehand how they stand.

use glam::Vec3;
use hair_sim::{PointCache, Strands};
use ron::value::RawValue;
use serde::Deserialize;
use std::collections::HashSet;

use super::{Source, VERSION, mirror, options};

/// Where the list of samples begins.
const MOTION: &str = "\n], motion: [\n";

/// The end of a file without samples.
const END: &str = "\n])\n";

/// What is before the samples.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Strands")]
struct Head<'a> {
    version: u32,
    #[serde(borrow)]
    strands: Vec<&'a RawValue>,
}

/// Strands and motion of a text that is written so, and has no mistake. Of any other, as of one that somebody has edited, nothing: then it is read as RON, which
/// tells what is wrong.
pub(super) fn read(text: &str) -> Option<(Strands, Option<PointCache>)> {
    let Some((head, motion)) = text.split_once(MOTION) else {
        return Some((strands_of(text.strip_suffix(END)?)?, None));
    };
    let (strands, mirrored) = match strands_of(head) {
        Some(strands) => {
            let none = vec![false; strands.len()];
            (strands, none)
        }
        None => edited_strands(head)?,
    };
    let motion = motion_of(motion, &strands, &mirrored)?;
    Some((strands, Some(motion)))
}

/// The strands of lines that are as they were written, maybe after what a bake says of itself.
fn strands_of(mut head: &str) -> Option<Strands> {
    while head.starts_with("//") {
        head = head.split_once('\n')?.1;
    }
    let (first, lines) = head.split_once('\n')?;
    if first != format!("(version: {VERSION}, strands: [") {
        return None;
    }
    let mut strands = Strands::new();
    let mut ids = HashSet::new();
    let mut points = Vec::new();
    for (index, line) in lines.lines().enumerate() {
        let (id, rest) = field("id: ", line.strip_prefix('(')?);
        let (size, rest) = field("size: ", rest);
        let id = id.map_or(Some(index as u32), |id| id.parse().ok())?;
        let size = match size {
            Some(size) => Some(number(size)?),
            None => None,
        };
        points.clear();
        let list = rest.strip_prefix("points: ")?.strip_suffix("),")?;
        push_points(list, &mut points)?;
        if !ids.insert(id) {
            return None;
        }
        strands.push(id, &points, size).ok()?;
    }
    Some(strands)
}

/// The value of a field where it is what comes first, and what comes after it.
fn field<'a>(name: &str, text: &'a str) -> (Option<&'a str>, &'a str) {
    let value = text
        .strip_prefix(name)
        .and_then(|rest| rest.split_once(", "));
    value.map_or((None, text), |(value, rest)| (Some(value), rest))
}

/// The strands before a bake, as somebody has edited them, and of each of their list whether it has a mirror image.
fn edited_strands(head: &str) -> Option<(Strands, Vec<bool>)> {
    let head = format!("{head}\n])");
    let Head { version, strands } = options().from_str(&head).ok()?;
    Source { text: &head }.strands(version, &strands).ok()
}

/// The motion of these strands, of the lines after [`MOTION`].
fn motion_of(text: &str, strands: &Strands, mirrored: &[bool]) -> Option<PointCache> {
    let mut lines = text.lines();
    let mut samples = Vec::new();
    loop {
        let line = lines.next()?;
        if line == "])" {
            break;
        }
        let time = line.strip_prefix("(time: ")?.strip_suffix(", strands: [")?;
        let mut positions: Vec<Vec3> = Vec::with_capacity(strands.points().len());
        let mut index = 0;
        for &is_mirrored in mirrored {
            let first = positions.len();
            push_points(lines.next()?.strip_suffix(',')?, &mut positions)?;
            if positions.len() - first != strands.strand(index).len() {
                return None;
            }
            index += 1;
            if is_mirrored {
                let image = mirror(&positions[first..]);
                positions.extend(image);
                index += 1;
            }
        }
        if lines.next()? != "])," {
            return None;
        }
        samples.push((number(time)?, positions));
    }
    let motion = PointCache::new(samples).ok()?;
    lines.next().is_none().then_some(motion)
}

/// Reads a list of points, `[(x,y,z),(x,y,z)]`.
fn push_points(list: &str, points: &mut Vec<Vec3>) -> Option<()> {
    let list = list.strip_prefix("[(")?.strip_suffix(")]")?;
    for point in list.split("),(") {
        let mut numbers = point.split(',').map(number);
        let (x, y, z) = (numbers.next()??, numbers.next()??, numbers.next()??);
        if numbers.next().is_some() {
            return None;
        }
        points.push(Vec3::new(x, y, z));
    }
    Some(())
}

fn number(text: &str) -> Option<f32> {
    text.parse().ok()
}
