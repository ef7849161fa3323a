//! `inkstrand render --pass`: numbers in 16 bits, ids as colours that don't mix.

use assert_cmd::Command;
use predicates::str::contains;
use std::collections::BTreeSet;
use std::fs;
use std::io::BufReader;
use tempfile::TempDir;

const STRANDS: &str = "(version: 1, strands: [
    (size: 60.0, points: [(-0.1, 0.2, 0.0), (-0.1, 0.0, 0.0), (-0.1, -0.2, 0.0)]),
    (size: 60.0, points: [(0.1, 0.2, 0.2), (0.1, 0.0, 0.2), (0.1, -0.2, 0.2)]),
])";
const PRESET: &str = "(
    version: 1,
    hair: (file: \"two.strands.ron\"),
    head: (shape: none),
    scene: (size: (60, 60), samples: 4, background: \"80FF80\"),
    camera: (distance: 6),
    layers: [(effect: \"hair.silhouette\"), (effect: \"hair.base\")],
)";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("two.strands.ron"), STRANDS).unwrap();
    fs::write(folder.path().join("two.ron"), PRESET).unwrap();
    folder
}

fn inkstrand(folder: &TempDir, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.current_dir(folder.path()).args(arguments).assert()
}

/// The pixels of a pass, each as many numbers as it has channels, and how many bits they have.
fn pass(folder: &TempDir, name: &str, more: &[&str]) -> (Vec<Vec<u16>>, png::BitDepth) {
    let arguments = [
        "render", "two.ron", "-o", "a.png", "--pass", name, "--quiet",
    ];
    inkstrand(folder, &[&arguments, more].concat()).success();
    let file = fs::File::open(folder.path().join("a.png")).unwrap();
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let numbers: Vec<u16> = match info.bit_depth {
        png::BitDepth::Sixteen => {
            let (pairs, _) = bytes.as_chunks::<2>();
            pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect()
        }
        _ => bytes.iter().map(|byte| u16::from(*byte)).collect(),
    };
    let channels = info.color_type.samples();
    let pixels = numbers.chunks_exact(channels).map(<[u16]>::to_vec);
    (pixels.collect(), info.bit_depth)
}

#[test]
fn ids_are_colours_that_do_not_mix() {
    let folder = folder();
    for (name, count) in [("strand", 2), ("object", 1), ("layer", 2), ("level", 1)] {
        let (pixels, depth) = pass(&folder, name, &[]);
        assert_eq!(depth, png::BitDepth::Eight);
        let (shown, nothing): (Vec<_>, Vec<_>) = pixels.into_iter().partition(|p| p[3] > 0);
        assert!(shown.len() > 100 && nothing.len() > 300, "{name}");
        assert!(shown.iter().all(|pixel| pixel[3] == 255), "{name}");
        let colors: BTreeSet<Vec<u16>> = shown.into_iter().collect();
        assert_eq!(colors.len(), count, "{name}");
    }
}

/// Ids begin anew in each object, and a mirror image has its original's but for one bit.
#[test]
fn each_strand_has_a_colour_of_its_own() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let colors = || {
        let (pixels, _) = pass(&folder, "strand", &[]);
        let shown = pixels.into_iter().filter(|pixel| pixel[3] > 0);
        shown.collect::<BTreeSet<Vec<u16>>>()
    };
    let alone = colors();
    assert_eq!(alone.len(), 2);

    write("one.ron", PRESET);
    write(
        "two.ron",
        "(
            version: 1,
            scene: (size: (60, 60), samples: 4),
            camera: (distance: 12),
            objects: [(preset: \"one.ron\", at: (-1, 0, 0)), (preset: \"one.ron\", at: (1, 0, 0))],
        )",
    );
    let of_both = colors();
    assert_eq!(of_both.len(), 4);
    assert!(
        of_both.is_superset(&alone),
        "the first object's are as alone"
    );

    write("two.ron", PRESET);
    write(
        "two.strands.ron",
        "(version: 1, strands: [
            (size: 60.0, mirror: true, points: [(-0.1, 0.2, 0.0), (-0.1, 0.0, 0.0), (-0.1, -0.2, 0.0)]),
        ])",
    );
    assert_eq!(colors().len(), 2);
}

#[test]
fn numbers_are_in_16_bits() {
    let folder = folder();
    let (pixels, depth) = pass(&folder, "u", &[]);
    assert_eq!(depth, png::BitDepth::Sixteen);
    // Down the middle of the strand at the left of the head, which is at the right of the picture, it grows from root to tip.
    let shown = |pixels: &[Vec<u16>], x: usize| -> Vec<u16> {
        let column = (0..60).map(|y| &pixels[60 * y + x]);
        column.filter(|p| p[1] > 0).map(|p| p[0]).collect()
    };
    let x = (0..60).max_by_key(|x| shown(&pixels, *x).len()).unwrap();
    let column = shown(&pixels, x);
    assert!(column.len() > 20 && column.is_sorted(), "{column:?}");
    assert!(
        column[0] < 10_000 && column[column.len() - 1] > 60_000,
        "{column:?}"
    );
    assert!(column.iter().any(|u| u % 257 != 0), "8 bits would do");
    // The nearer strand is lighter.
    let (pixels, _) = pass(&folder, "depth", &[]);
    let lights: BTreeSet<u16> = (0..60).flat_map(|x| shown(&pixels, x)).collect();
    let (far, near) = (lights.first().unwrap(), lights.last().unwrap());
    assert!(near - far > 3000, "{far} {near}");
    // Any number of threads draws the same.
    assert_eq!(pass(&folder, "depth", &["--threads", "3"]).0, pixels);
    // The nearer strand is drawn larger, by a sixteenth of a pixel's steps.
    let (pixels, _) = pass(&folder, "pixels", &[]);
    let sizes: BTreeSet<u16> = (0..60).flat_map(|x| shown(&pixels, x)).collect();
    let (far, near) = (sizes.first().unwrap(), sizes.last().unwrap());
    assert!(near > far && *near < 60 * 16 * 4, "{far} {near}");
    for name in ["normal", "s", "v", "w"] {
        let (pixels, depth) = pass(&folder, name, &[]);
        assert_eq!(depth, png::BitDepth::Sixteen, "{name}");
        let all: BTreeSet<&Vec<u16>> = pixels.iter().collect();
        assert!(all.len() > 30, "{name}");
    }
}

#[test]
#[cfg(feature = "gpu")]
#[allow(clippy::print_stderr, reason = "what is skipped is said")]
fn a_graphics_card_tells_what_the_cpu_tells() {
    let folder = folder();
    let by_card = ["--backend", "gpu"];
    let tried = ["render", "two.ron", "-o", "a.png", "--backend", "gpu"];
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    let output = command.current_dir(folder.path()).args(tried).output();
    let told = output.unwrap().stderr;
    if String::from_utf8_lossy(&told).contains("there is no graphics card")
        && std::env::var_os("CI").is_none_or(|ci| ci != "true")
    {
        eprintln!("SKIPPED: no driver for a graphics card");
        return;
    }
    for name in [
        "depth", "normal", "object", "strand", "piece", "layer", "level", "u", "s", "v", "w",
        "pixels",
    ] {
        let (cpu, depth) = pass(&folder, name, &["--backend", "cpu"]);
        let (card, same) = pass(&folder, name, &by_card);
        assert_eq!(depth, same, "{name}");
        // Colours of ids are the same, numbers to a thousandth of the range; but for samples that rounding decides.
        let most = match depth {
            png::BitDepth::Sixteen => 65,
            _ => 0,
        };
        let differs = |(a, b): &(&Vec<u16>, &Vec<u16>)| {
            let mut channels = a.iter().zip(b.iter());
            channels.any(|(a, b)| a.abs_diff(*b) > most)
        };
        let pixels = cpu.iter().zip(&card).filter(differs).count();
        assert!(pixels <= 3, "{name}: {pixels}");
    }
}

#[test]
fn what_has_8_bits_takes_none() {
    let folder = folder();
    let frames = ["render", "two.ron", "--pass", "depth", "--frames", "0-1"];
    inkstrand(&folder, &[&frames[..], &["-o", "a.apng"]].concat())
        .code(2)
        .stderr(contains("16 bits"));
    inkstrand(
        &folder,
        &[&frames[..], &["-o", "a_#.png", "--quiet"]].concat(),
    )
    .success();
    assert!(folder.path().join("a_1.png").is_file());
    inkstrand(&folder, &["render", "two.ron", "--pass", "deph"])
        .code(2)
        .stderr(contains("'depth'"));
}
