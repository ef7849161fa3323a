//! Motion as [`to_text`](super::to_text) writes it, line by line: a bake has millions of numbers, which are read much sooner where it is known
//! beforehand how they stand.

use glam::Vec3;
use hair_sim::{PointCache, Strands};
use ron::value::RawValue;
use serde::Deserialize;

use super::{Source, mirror, options};

/// Where the list of samples begins.
const MOTION: &str = "\n], motion: [\n";

/// What is before it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Strands")]
struct Head<'a> {
    version: u32,
    #[serde(borrow)]
    strands: Vec<&'a RawValue>,
}

/// Strands and motion of a text that is written so, and has no mistake. Of any other, as of one that somebody has edited, nothing: then it is read as RON, which
/// tells what is wrong.
pub(super) fn read(text: &str) -> Option<(Strands, PointCache)> {
    let (head, motion) = text.split_once(MOTION)?;
    let head = format!("{head}\n])");
    let Head {
        version,
        strands: list,
    } = options().from_str(&head).ok()?;
    let (strands, mirrored) = Source { text: &head }.strands(version, &list).ok()?;
    let mut lines = motion.lines();
    let mut samples = Vec::new();
    loop {
        let line = lines.next()?;
        if line == "])" {
            break;
        }
        let time = line.strip_prefix("(time: ")?.strip_suffix(", strands: [")?;
        let mut positions: Vec<Vec3> = Vec::with_capacity(strands.points().len());
        let mut index = 0;
        for &is_mirrored in &mirrored {
            let first = positions.len();
            push_points(lines.next()?, &mut positions)?;
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
    lines.next().is_none().then_some((strands, motion))
}

/// Reads a line of points, `[(x,y,z),(x,y,z)],`.
fn push_points(line: &str, points: &mut Vec<Vec3>) -> Option<()> {
    let list = line.strip_prefix("[(")?.strip_suffix(")],")?;
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
