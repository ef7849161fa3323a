//! A contact sheet for each effect, and for the clump: every parameter at its least and its greatest,
//! every choice, another colour. The parameters come from the program, so that none is forgotten.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use super::case::{Case, Cell};
use super::sheet::CELL;
use crate::Outcome;

/// `extremes.toml`: what the sheets show the parameters on.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sheets {
    sheet: Vec<Sheet>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sheet {
    /// The effect or section.
    of: String,
    /// What `--set` calls it, where that isn't `of`.
    at: Option<String>,
    /// What `inkstrand render` gets, the preset first.
    args: Vec<String>,
    /// What a parameter needs to be seen: it does nothing where another is not set.
    #[serde(default)]
    with: BTreeMap<String, Vec<String>>,
}

/// A colour that no preset of the sheets has.
const OTHER_COLOR: &str = "D02F8A";

/// The sheets, by `extremes.toml` in `folder` and the program's `schema`.
///
/// # Errors
/// An effect without a sheet, a sheet without an effect, or one that says something of a parameter
/// that isn't there.
pub fn cases(folder: &Path, schema: &Value) -> Outcome<Vec<Case>> {
    let path = folder.join("extremes.toml");
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    sheets(&text, schema).map_err(|error| format!("{}: {error}", path.display()).into())
}

fn sheets(text: &str, schema: &Value) -> Outcome<Vec<Case>> {
    let Sheets { sheet: sheets } = toml::from_str(text)?;
    let list = |name: &str| schema[name].as_array().into_iter().flatten();
    for effect in list("effects") {
        let id = effect["id"].as_str().unwrap_or_default();
        if !sheets.iter().any(|sheet| sheet.of == id) {
            return Err(format!("effect {id} has no sheet").into());
        }
    }
    let mut cases = Vec::new();
    for sheet in &sheets {
        let owner = list("effects")
            .chain(list("sections"))
            .find(|owner| owner["id"] == sheet.of.as_str())
            .ok_or_else(|| format!("there is no effect or section {}", sheet.of))?;
        let parameters = owner["parameters"].as_array().ok_or("no parameters")?;
        let size = format!("--size={CELL}x{CELL}");
        cases.push(Case {
            name: format!("extremes-{}", sheet.of.replace('.', "-")),
            args: sheet.args.iter().cloned().chain([size]).collect(),
            cells: cells(sheet, parameters)?,
        });
    }
    Ok(cases)
}

/// The cells of a sheet: the preset as it is, then the values of each parameter.
fn cells(sheet: &Sheet, parameters: &[Value]) -> Outcome<Vec<Cell>> {
    let name_of = |parameter: &Value| parameter["name"].as_str().unwrap_or_default().to_owned();
    for name in sheet.with.keys() {
        if !parameters
            .iter()
            .any(|parameter| name_of(parameter) == *name)
        {
            return Err(format!("{} has no parameter {name}", sheet.of).into());
        }
    }
    let mut cells = vec![Cell {
        name: "as it is".to_owned(),
        sets: Vec::new(),
        beside: None,
        shows: String::new(),
    }];
    for parameter in parameters {
        let name = name_of(parameter);
        let with = sheet.with.get(&name).cloned().unwrap_or_default();
        let mut beside = 0;
        if !with.is_empty() {
            let same = |cell: &Cell| cell.shows.is_empty() && cell.sets == with;
            beside = cells.iter().position(same).unwrap_or(cells.len());
            if beside == cells.len() {
                cells.push(Cell {
                    name: with.join(" "),
                    sets: with.clone(),
                    beside: None,
                    shows: String::new(),
                });
            }
        }
        for value in values(parameter)? {
            let set = format!("{}.{name}={value}", sheet.at.as_ref().unwrap_or(&sheet.of));
            cells.push(Cell {
                name: set.clone(),
                sets: with.iter().cloned().chain([set]).collect(),
                beside: Some(beside),
                shows: name.clone(),
            });
        }
    }
    Ok(cells)
}

/// What a parameter is tried at: both ends of its range, or all its choices, but not its default.
fn values(parameter: &Value) -> Outcome<Vec<String>> {
    let text = |value: &Value| match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let default = text(&parameter["default"]);
    let all = match parameter["type"].as_str().unwrap_or_default() {
        "number" | "integer" => vec![text(&parameter["min"]), text(&parameter["max"])],
        "choice" => parameter["choices"]
            .as_array()
            .into_iter()
            .flatten()
            .map(text)
            .collect(),
        "texture" => vec![format!("[(0, \"{OTHER_COLOR}\"), (1, \"FFFFFF\")]")],
        "color" | "color or none" => vec![OTHER_COLOR.to_owned()],
        // A file: tests of its own show it.
        "text" => Vec::new(),
        other => return Err(format!("no sheet shows a parameter of type {other:?}").into()),
    };
    Ok(all.into_iter().filter(|value| *value != default).collect())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn schema() -> Value {
        json!({
            "sections": [{ "id": "clump", "parameters": [] }],
            "effects": [{ "id": "hair.fog", "parameters": [
                { "name": "depth", "type": "number", "min": 0.0, "max": 4.0, "default": 1.0 },
                { "name": "count", "type": "integer", "min": 1, "max": 9, "default": 1 },
                { "name": "kind", "type": "choice", "choices": ["thin", "thick"], "default": "thin" },
                { "name": "color", "type": "color or none", "default": "none" },
            ]}],
        })
    }

    const SHEET: &str = "[[sheet]]\nof = 'hair.fog'\nargs = ['a.ron']\n";

    #[test]
    fn every_parameter_has_its_ends() {
        let text = format!("{SHEET}[sheet.with]\ncount = ['hair.fog.kind=thick']\n");
        let cases = sheets(&text, &schema()).unwrap();
        assert_eq!(cases[0].name, "extremes-hair-fog");
        assert_eq!(cases[0].args, ["a.ron", "--size=96x96"]);
        let names: Vec<&str> = cases[0]
            .cells
            .iter()
            .map(|cell| cell.name.as_str())
            .collect();
        let expected = [
            "as it is",
            "hair.fog.depth=0.0",
            "hair.fog.depth=4.0",
            "hair.fog.kind=thick",
            "hair.fog.count=9",
            "hair.fog.kind=thick",
            "hair.fog.color=D02F8A",
        ];
        assert_eq!(names, expected);
        let count = &cases[0].cells[4];
        assert_eq!(count.sets, ["hair.fog.kind=thick", "hair.fog.count=9"]);
        assert_eq!(count.beside, Some(3));
    }

    #[test]
    fn what_is_forgotten_or_misspelt_is_an_error() {
        let misspelt = format!("{SHEET}[sheet.with]\ncuont = ['a.b=1']\n");
        let gone = format!("{SHEET}[[sheet]]\nof = 'hair.gone'\nargs = ['a.ron']\n");
        for (text, complaint) in [
            (
                "[[sheet]]\nof = 'clump'\nargs = ['a.ron']",
                "effect hair.fog has no sheet",
            ),
            (&misspelt, "hair.fog has no parameter cuont"),
            (&gone, "no effect or section hair.gone"),
        ] {
            let error = sheets(text, &schema()).unwrap_err().to_string();
            assert!(error.contains(complaint), "{error}");
        }
    }
}
