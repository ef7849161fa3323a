//! Blender's Line Art on the same meshes, driven by `crates/bench/peers/line_art.py`; and its rows as they were where it isn't at hand.
//!
//! Line Art draws edges of triangles: those between a front and a back one, creases and borders. It is held against a ray each 3 pixels of these, as ours are held against rays of
//! ours.

use super::subjects::Subject;
use super::{APART_PX, Tally, USUAL, median, pixel};
use crate::BenchError;
use crate::python::Python;
use crate::results::{Row, table};
use glam::DVec3;
use mesh_lines::{
    Beside, Bvh, CREASE_COSINE, Kind, Line, LinePoint, Place, Segment, Surface, View, is_seen,
};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The rows of a run with it, and ours beside them, as `bench lines --peers --store` wrote them.
const STORED: &str = include_str!("../../stored/line-art.csv");
/// What of Blender there is to install, as pip reads it.
const INSTALLED: &str = include_str!("../../peers/line-art-requirements.txt");
const COLUMNS: &str = "scene,method,knob,seconds,error";
/// The methods that are stored.
pub const METHOD: &str = "line-art";
const BESIDE: [&str; 2] = [METHOD, "all"];
/// A place is on a stroke that is no farther away than this share of the mesh's radius: strokes are of f32.
const ON_STROKE: f64 = 1e-4;

/// Blender's Python module.
#[derive(Clone, Debug)]
pub struct LineArt(Python);

/// What it drew for an eye.
struct Drawn {
    seconds: f64,
    strokes: Vec<Vec<DVec3>>,
}

impl LineArt {
    /// That which `python` has, for the project in `root`.
    ///
    /// # Errors
    ///
    /// When it has none: how to install it.
    pub fn new(root: &Path, python: PathBuf) -> Result<Self, BenchError> {
        let programs = [["Blender", "bpy"]];
        Python::new(root, python, &programs, "line-art-requirements.txt").map(Self)
    }

    /// Its row of a mesh from these eyes, of which the first isn't timed; how much it gets wrong is worked out where that `is_asked`.
    ///
    /// # Errors
    ///
    /// When the script fails, a file can't be written or the mesh isn't one.
    pub fn row(
        &self,
        subject: &Subject,
        eyes: &[DVec3],
        is_asked: bool,
        out: &Path,
    ) -> Result<Row, BenchError> {
        let file = out.join(format!("line-art-{}.json", subject.name));
        let degrees = CREASE_COSINE.acos().to_degrees();
        let crease = subject.has_creases.then_some(degrees);
        let mesh = json!({
            "positions": subject.positions.iter().map(|p| p.to_array()).collect::<Vec<_>>(),
            "triangles": subject.topology.triangles(),
            "crease": crease,
            "target": subject.middle.to_array(),
            "eyes": eyes.iter().map(|eye| eye.to_array()).collect::<Vec<_>>(),
        });
        crate::results::write(&file, &mesh.to_string())
            .map_err(|error| format!("{}: {error}", file.display()))?;
        let script = self.0.script("line_art.py");
        let output = self.0.run(&[&script, &file.display().to_string()])?;
        // Blender says things of its own, too.
        let lines = output.lines().filter(|line| line.starts_with('{'));
        let drawn: Option<Vec<Drawn>> = lines.map(read).collect();
        let drawn = drawn.filter(|drawn| drawn.len() == eyes.len());
        let drawn = drawn.ok_or_else(|| format!("{script}: lines that can't be read"))?;
        let times = drawn.iter().skip(1).map(|drawn| drawn.seconds).collect();
        Ok(Row {
            scene: subject.name.clone(),
            method: METHOD.to_owned(),
            knob: USUAL,
            seconds: median(times),
            error: match is_asked {
                true => Some(wrong(subject, eyes, &drawn)?),
                false => None,
            },
        })
    }
}

/// A line that the script printed.
fn read(line: &str) -> Option<Drawn> {
    let value: Value = serde_json::from_str(line).ok()?;
    let point = |point: &Value| {
        let [x, y, z] = [0, 1, 2].map(|axis| point[axis].as_f64());
        Some(DVec3::new(x?, y?, z?))
    };
    let stroke = |stroke: &Value| stroke.as_array()?.iter().map(point).collect();
    let strokes: Option<_> = value["strokes"].as_array()?.iter().map(stroke).collect();
    Some(Drawn {
        seconds: value["seconds"].as_f64()?,
        strokes: strokes?,
    })
}

/// The share of the length of the edges it may draw that is wrongly drawn or left out.
fn wrong(subject: &Subject, eyes: &[DVec3], drawn: &[Drawn]) -> Result<f64, BenchError> {
    let fault = |error: mesh_lines::MeshError| error.to_string();
    let surface = subject.surface(&subject.positions).map_err(fault)?;
    let bvh = Bvh::new(&surface);
    let mut tally = Tally::default();
    for (eye, drawn) in eyes.iter().zip(drawn) {
        let view = View::perspective(eye.as_vec3()).map_err(fault)?;
        for line in edges(subject, &surface, &view) {
            let length = line.image_lengths(&view)[0];
            let samples = (length / (APART_PX * pixel(USUAL))).ceil().max(1.0);
            for sample in 0..samples as usize {
                let along = (sample as f64 + 0.5) / samples;
                let place = line.position(along);
                let is_drawn = drawn.strokes.iter().any(|stroke| {
                    let mut links = stroke.windows(2);
                    links.any(|link| distance(place, link) < ON_STROKE * subject.radius)
                });
                tally.all += length / samples;
                if is_drawn != is_seen(&surface, &bvh, &view, &line, along) {
                    tally.wrong += length / samples;
                }
            }
        }
    }
    Ok(tally.wrong / tally.all.max(f64::MIN_POSITIVE))
}

/// The edges of triangles that may be drawn, each a line.
fn edges(subject: &Subject, surface: &Surface, view: &View) -> Vec<Line> {
    let topology = surface.topology();
    let is_front = |triangle: u32| {
        let [corner, ..] = surface.corners(triangle);
        surface.area_normal(triangle).dot(view.towards(corner)) > 0.0
    };
    let is_drawn = |half_edge: &u32| match topology.beside(*half_edge) {
        Beside::Twin(twin) => {
            let is_edge = is_front(half_edge / 3) != is_front(twin / 3)
                || subject.has_creases && topology.is_sharp(*half_edge);
            *half_edge < twin && is_edge
        }
        _ => true,
    };
    let half_edges = 0..3 * topology.triangles().len() as u32;
    let line = |half_edge: u32| Line {
        kind: Kind::Crease,
        closed: false,
        points: [0.0, 1.0]
            .map(|share| Place::on_edge(half_edge, share))
            .map(|place| LinePoint {
                position: surface.point(place),
                place,
            })
            .to_vec(),
        segments: vec![Segment {
            triangle: half_edge / 3,
            folded: false,
        }],
    };
    half_edges.filter(is_drawn).map(line).collect()
}

/// How far a point is from the way between two.
fn distance(point: DVec3, link: &[DVec3]) -> f64 {
    let way = link[1] - link[0];
    let share = (point - link[0]).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
    point.distance(link[0] + way * share.clamp(0.0, 1.0))
}

/// The file to store of a run: its rows, and ours of the same run beside them.
#[must_use]
pub fn file(rows: &[Row], machine: &[String]) -> String {
    let mut comments = vec![
        "Blender's Line Art, and our lines and tracking in the same run: written by `bench lines --peers --store`; seconds of one thread".to_owned(),
    ];
    comments.push(format!(
        "of {}",
        INSTALLED.lines().last().unwrap_or_default()
    ));
    comments.extend_from_slice(machine);
    let kept = rows
        .iter()
        .filter(|row| BESIDE.contains(&row.method.as_str()));
    let lines = kept.map(|row| {
        let error = row
            .error
            .map_or(String::new(), |error| format!("{error:.3e}"));
        format!(
            "{},{},{},{:.6},{error}",
            row.scene, row.method, row.knob, row.seconds
        )
    });
    table(&comments, COLUMNS, lines)
}

/// The rows that are stored.
///
/// # Errors
///
/// When the file is broken.
pub fn stored() -> Result<Vec<Row>, BenchError> {
    rows_of(STORED)
}

fn rows_of(text: &str) -> Result<Vec<Row>, BenchError> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let row = |line: &str| {
        let parts: Vec<&str> = line.split(',').collect();
        let [scene, method, knob, seconds, error] = parts[..] else {
            return None;
        };
        Some(Row {
            scene: scene.to_owned(),
            method: method.to_owned(),
            knob: knob.parse().ok()?,
            seconds: seconds.parse().ok()?,
            error: match error.is_empty() {
                true => None,
                false => Some(error.parse().ok()?),
            },
        })
    };
    lines
        .map(|line| row(line).ok_or_else(|| format!("broken line of stored rows: {line}").into()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lines::subjects::linked;

    /// Strokes along all edges that rays see are right; without one in two of them half is wrong; and of all, hidden or not, what is hidden.
    #[test]
    fn strokes_are_held_against_rays() {
        let subject = Subject::new("linked", linked(), false).unwrap();
        let eyes: Vec<DVec3> = subject.eyes(2).collect();
        let surface = subject.surface(&subject.positions).unwrap();
        let bvh = Bvh::new(&surface);
        let strokes = |every: usize, is_all: bool| -> Vec<Drawn> {
            let of_eye = |eye: &DVec3| {
                let view = View::perspective(eye.as_vec3()).unwrap();
                let lines = edges(&subject, &surface, &view);
                assert!(lines.len() > 200, "{}", lines.len());
                let seen = lines
                    .iter()
                    .filter(|line| is_all || is_seen(&surface, &bvh, &view, line, 0.5));
                Drawn {
                    seconds: 0.0,
                    strokes: seen
                        .step_by(every)
                        .map(|line| line.points.iter().map(|point| point.position).collect())
                        .collect(),
                }
            };
            eyes.iter().map(of_eye).collect()
        };
        let of = |drawn: &[Drawn]| wrong(&subject, &eyes, drawn).unwrap();
        let [right, half, all] =
            [(1, false), (2, false), (1, true)].map(|(every, is_all)| of(&strokes(every, is_all)));
        assert!(right < 0.03, "{right}");
        assert!(half > 0.1 && half < 0.5, "{half}");
        assert!(all > 0.2 && all < 0.8, "{all}");
    }

    #[test]
    fn lines_of_the_script_and_stored_rows_are_read() {
        let line = r#"{"seconds": 0.25, "strokes": [[[0, 1, 2], [3, 4, 5.5]], []]}"#;
        let drawn = read(line).unwrap();
        assert_eq!(drawn.seconds, 0.25);
        assert_eq!(drawn.strokes[0][1], DVec3::new(3.0, 4.0, 5.5));
        for line in [
            "{}",
            r#"{"seconds": 1, "strokes": [[[0, 1]]]}"#,
            "a warning",
        ] {
            assert!(read(line).is_none(), "{line}");
        }
        let row = |error| Row {
            scene: "cup".to_owned(),
            method: METHOD.to_owned(),
            knob: USUAL,
            seconds: 0.0125,
            error,
        };
        let rows = vec![row(Some(0.03)), row(None)];
        assert_eq!(rows_of(&file(&rows, &[])), Ok(rows));
        assert!(rows_of("columns\ncup,line-art,720\n").is_err());
        assert!(stored().unwrap().iter().any(|row| row.method == METHOD));
    }

    #[test]
    fn without_blender_it_says_how_to_install_it() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let error = LineArt::new(&root, "no-such-python".into()).unwrap_err();
        let error = error.to_string();
        assert!(
            error.starts_with("Blender can't be run: no-such-python"),
            "{error}"
        );
        assert!(error.contains("line-art-requirements.txt"), "{error}");
        for file in ["line-art-requirements.txt", "line_art.py"] {
            assert!(root.join("crates/bench/peers").join(file).exists());
        }
    }
}
