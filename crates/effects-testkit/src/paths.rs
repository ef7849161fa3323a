//! Paths that an effect makes: finite on any hair, and the same ones in every frame.

use crate::hair::{HEAD_M, strands};
use crate::values::{defaults, extremes};
use effects::{AnyEffect, Hair, HairStrand, LayerProgram, MadePaths};
use glam::Vec3;

/// Strand and number of a path, and its points.
pub(crate) type Path = (usize, u32, Vec<Vec3>);

/// The paths that are made of strands that rest as `rest` and stand as `now`.
pub(crate) fn made(program: &dyn LayerProgram, rest: &[Vec<Vec3>], now: &[Vec<Vec3>]) -> Vec<Path> {
    let strands: Vec<HairStrand> = (0..)
        .zip(rest.iter().zip(now))
        .map(|(number, (at_rest, particles))| HairStrand {
            // Ids are not places in the list.
            id: 3 * number + 2,
            particles,
            at_rest,
            size: 15.0,
        })
        .collect();
    let hair = Hair {
        strands: &strands,
        head_center: Vec3::ZERO,
        head_height_m: HEAD_M,
    };
    let mut paths = MadePaths::default();
    program.make_paths(&hair, 1, &mut paths);
    let points = paths.iter();
    points
        .map(|(strand, number, points)| (strand, number, points.to_vec()))
        .collect()
}

pub(crate) fn check(effect: &dyn AnyEffect) -> Result<(), String> {
    for case in extremes(effect) {
        let program = effect.program(&case.values);
        if !program.has_own_paths() {
            return Ok(());
        }
        for (what, strands) in hostile_hair() {
            let at = || format!("{}, of {what}", case.name);
            for (strand, number, points) in made(&*program, &strands, &strands) {
                if strand >= strands.len() {
                    return Err(format!(
                        "{}: a path of strand {strand}, which is not there",
                        at()
                    ));
                }
                if let Some(point) = points.iter().find(|point| !point.is_finite()) {
                    return Err(format!("{}: path {number} goes through {point}", at()));
                }
            }
        }
    }
    let program = effect.program(&defaults(effect).values);
    let rest = strands();
    let before = made(&*program, &rest, &rest);
    if before.is_empty() {
        return Err("at its defaults it makes no paths of a head of hair".to_owned());
    }
    if before != made(&*program, &rest, &rest) {
        return Err("made again, the paths are others".to_owned());
    }
    let names = |paths: &[Path]| -> Vec<(usize, u32, usize)> {
        let name = |(strand, number, points): &Path| (*strand, *number, points.len());
        paths.iter().map(name).collect()
    };
    let moved: Vec<Vec<Vec3>> = rest
        .iter()
        .map(|strand| strand.iter().map(|point| blown(*point)).collect())
        .collect();
    if names(&before) != names(&made(&*program, &rest, &moved)) {
        return Err(
            "where the hair moves there are other paths: choose by seed, id and the hair at rest"
                .to_owned(),
        );
    }
    Ok(())
}

/// A point as a wind moves it.
fn blown(point: Vec3) -> Vec3 {
    point + 0.1 * Vec3::new(1.0, (9.0 * point.x).sin(), (7.0 * point.y).cos())
}

fn hostile_hair() -> Vec<(&'static str, Vec<Vec<Vec3>>)> {
    vec![
        ("ordinary hair", strands()),
        ("no hair", Vec::new()),
        ("a single strand", strands()[..1].to_vec()),
        (
            "strands of one particle",
            vec![vec![Vec3::Y], vec![Vec3::X]],
        ),
        ("strands of no length", vec![vec![Vec3::ZERO; 8]; 3]),
        (
            "hair of 1000 km",
            vec![
                vec![Vec3::ZERO, Vec3::splat(1e6)],
                vec![Vec3::X, Vec3::splat(-1e6)],
            ],
        ),
    ]
}
