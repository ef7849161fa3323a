//! Paths that an effect makes: finite on any hair, and the same ones in every frame.

use crate::hair::{HEAD_M, strands};
use crate::values::{defaults, extremes};
use effects::{AnyEffect, Hair, HairStrand, LayerProgram, Light, MadePaths};
use glam::{Quat, Vec3};

/// Strand and number of a path, and its points.
pub(crate) type Path = (usize, u32, Vec<Vec3>);

/// Moments of moving hair that are looked at, before the time between two of them is halved.
const MOMENTS: u32 = 64;
/// How often it is.
const HALVINGS: u32 = 16;
/// How far a path may come from one moment to the next without having jumped, metres.
const SMALL_M: f32 = 0.01 * HEAD_M;

/// The paths that are made of strands that rest as `rest` and stand as `now`, lit and seen from the front, and what is wrong with them.
pub(crate) fn made(
    program: &dyn LayerProgram,
    rest: &[Vec<Vec3>],
    now: &[Vec<Vec3>],
) -> Result<Vec<Path>, String> {
    made_at(program, rest, now, 0.0)
}

/// The same, with light and eye as far around the head as they come in that time, 0 to 1.
fn made_at(
    program: &dyn LayerProgram,
    rest: &[Vec<Vec3>],
    now: &[Vec<Vec3>],
    time: f32,
) -> Result<Vec<Path>, String> {
    made_around(program, rest, (now, Vec3::ZERO), time)
}

/// The same, where hair as it stands is around a head that has come to `center`.
fn made_around(
    program: &dyn LayerProgram,
    rest: &[Vec<Vec3>],
    (now, center): (&[Vec<Vec3>], Vec3),
    time: f32,
) -> Result<Vec<Path>, String> {
    made_again(
        program,
        rest,
        (now, center),
        time,
        &mut MadePaths::default(),
    )
}

/// The same, in place of those of a frame before.
fn made_again(
    program: &dyn LayerProgram,
    rest: &[Vec<Vec3>],
    (now, center): (&[Vec<Vec3>], Vec3),
    time: f32,
    paths: &mut MadePaths,
) -> Result<Vec<Path>, String> {
    let around = |degrees: f32| Quat::from_rotation_y(degrees.to_radians());
    let light = around(120.0 * time - 40.0) * Vec3::new(0.0, 0.7, 0.7);
    let eye = center + around(90.0 * time) * Vec3::new(0.0, 0.1, 8.0 * HEAD_M);
    let strands: Vec<HairStrand> = (0..)
        .zip(rest.iter().zip(now))
        .map(|(number, (at_rest, particles))| HairStrand {
            // Ids are not places in the list.
            id: 3 * number + 2,
            particles,
            at_rest,
            size: 15.0,
            is_drawn: true,
        })
        .collect();
    let hair = Hair {
        strands: &strands,
        head_center: center,
        head_center_at_rest: Vec3::ZERO,
        head_height_m: HEAD_M,
        light: Light::Direction(light.normalize()),
        eye,
    };
    paths.clear();
    program.make_paths(&hair, 1, paths);
    if let Some(fault) = paths.fault() {
        return Err(fault.to_owned());
    }
    let points = paths.iter();
    Ok(points
        .map(|path| (path.strand, path.number, path.points.to_vec()))
        .collect())
}

pub(crate) fn check(effect: &dyn AnyEffect) -> Result<(), String> {
    for case in extremes(effect) {
        let program = effect.program(&case.values);
        if !program.has_own_paths() {
            return Ok(());
        }
        for (what, strands) in hostile_hair() {
            let at = || format!("{}, of {what}", case.name);
            let paths = made(&*program, &strands, &strands);
            for (strand, number, points) in paths.map_err(|fault| format!("{}: {fault}", at()))? {
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
    let before = made(&*program, &rest, &rest)?;
    if before.is_empty() {
        return Err("at its defaults it makes no paths of a head of hair".to_owned());
    }
    if before != made(&*program, &rest, &rest)? {
        return Err("made again, the paths are others".to_owned());
    }
    keeps_what_stays(&*program, &rest, &before)?;
    goes_with_the_head(&*program, &rest)?;
    moves_with_the_hair(&*program, &rest)
}

/// Paths that are made after those of a frame in which hair, light and eye were elsewhere are those that are made at first.
fn keeps_what_stays(
    program: &dyn LayerProgram,
    rest: &[Vec<Vec3>],
    at_first: &[Path],
) -> Result<(), String> {
    let blown = |points: &Vec<Vec3>| points.iter().map(|point| blown(*point, 1.0)).collect();
    let elsewhere: Vec<Vec<Vec3>> = rest.iter().map(blown).collect();
    let mut paths = MadePaths::default();
    made_again(
        program,
        rest,
        (&elsewhere, HEAD_M * Vec3::X),
        1.0,
        &mut paths,
    )?;
    if at_first != made_again(program, rest, (rest, Vec3::ZERO), 0.0, &mut paths)? {
        return Err(
            "in the second frame the paths are others than they were in the first: what `MadePaths::once` keeps hangs on the hair at rest"
                .to_owned(),
        );
    }
    Ok(())
}

/// Hair whose head has come some heads away, with eye and light along, has the paths that it had, moved along.
fn goes_with_the_head(program: &dyn LayerProgram, rest: &[Vec<Vec3>]) -> Result<(), String> {
    let away = HEAD_M * Vec3::new(3.0, 1.0, -2.0);
    let moved = |points: &Vec<Vec3>| points.iter().map(|point| *point + away).collect();
    let now: Vec<Vec<Vec3>> = rest.iter().map(moved).collect();
    let here = made(program, rest, rest)?;
    let there = made_around(program, rest, (&now, away), 0.0)?;
    let back = |(strand, number, points): Path| {
        let points = points.iter().map(|point| *point - away).collect();
        (strand, number, points)
    };
    let there: Vec<Path> = there.into_iter().map(back).collect();
    let (distance_m, (strand, number)) = farthest(&here, &there)?;
    if distance_m > SMALL_M {
        return Err(format!(
            "path {number} of strand {strand} is {distance_m} m elsewhere on a head that has moved: what is chosen hangs on the hair and the \
             head's centre at rest"
        ));
    }
    Ok(())
}

/// Hair that is blown aside while light and eye go around it: its paths are the same ones all the while, and none jumps. Where one comes far from one moment to the
/// next, the time between them is halved again and again: what moves fast comes less far then, what jumps doesn't.
fn moves_with_the_hair(program: &dyn LayerProgram, rest: &[Vec<Vec3>]) -> Result<(), String> {
    let hair = |time: f32| -> Vec<Vec<Vec3>> {
        let strand = |points: &Vec<Vec3>| points.iter().map(|p| blown(*p, time)).collect();
        rest.iter().map(strand).collect()
    };
    let paths = |time: f32| made_at(program, rest, &hair(time), time);
    let mut before = paths(0.0)?;
    for moment in 0..MOMENTS {
        let [start, end] = [moment, moment + 1].map(|m| m as f32 / MOMENTS as f32);
        let after = paths(end)?;
        let (mut times, mut jump) = ([start, end], farthest(&before, &after)?);
        let (mut first, mut last) = (before, after.clone());
        for _ in 0..HALVINGS {
            if jump.0 <= SMALL_M {
                break;
            }
            let middle = 0.5 * (times[0] + times[1]);
            let between = paths(middle)?;
            let halves = [farthest(&first, &between)?, farthest(&between, &last)?];
            if halves[0].0 > halves[1].0 {
                (times[1], last, jump) = (middle, between, halves[0]);
            } else {
                (times[0], first, jump) = (middle, between, halves[1]);
            }
        }
        let (distance_m, (strand, number)) = jump;
        if distance_m > SMALL_M {
            let [a, b] = times.map(hair);
            let points = a.iter().flatten().zip(b.iter().flatten());
            let moved_m = points.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
            return Err(format!(
                "path {number} of strand {strand} jumps by {distance_m} m where the hair moves by {moved_m} m: what is chosen hangs on \
                 seed, id and the hair at rest, not on where the hair is"
            ));
        }
        before = after;
    }
    Ok(())
}

/// How far the paths are apart at most, metres, and strand and number of that one.
fn farthest(a: &[Path], b: &[Path]) -> Result<(f32, (usize, u32)), String> {
    let names = |paths: &[Path]| -> Vec<(usize, u32, usize)> {
        let name = |(strand, number, points): &Path| (*strand, *number, points.len());
        paths.iter().map(name).collect()
    };
    if names(a) != names(b) {
        return Err(
            "where the hair moves there are other paths: choose by seed, id and the hair at rest"
                .to_owned(),
        );
    }
    let mut farthest = (0.0, (0, 0));
    for ((strand, number, a), (.., b)) in a.iter().zip(b) {
        let distances = a.iter().zip(b).map(|(a, b)| a.distance(*b));
        let distance_m = distances.fold(0.0, f32::max);
        if distance_m > farthest.0 {
            farthest = (distance_m, (*strand, *number));
        }
    }
    Ok(farthest)
}

/// A point as a wind moves it that rises from 0 to 1.
fn blown(point: Vec3, strength: f32) -> Vec3 {
    let aside = Vec3::new(1.0, (9.0 * point.x).sin(), (7.0 * point.y).cos());
    point + 0.1 * strength * aside
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
