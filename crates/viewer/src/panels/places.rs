//! Places on the head: as text, as points on a map of the head, and as numbers.

use super::fold::fold_named;
use crate::controls::{
    Cells, Icon, NumberField, Row, Search, cell_text, drag_value, icon_button, text_line,
};
use crate::edit::{Edit, Place};
use effects::preset::{edit, read_value};
use effects::{ParamKind, Value};
use eframe::egui::{
    Align2, Color32, FontId, Id, Pos2, Rect, RichText, Role, Sense, Shape, Stroke, Ui, WidgetInfo,
    pos2, vec2,
};

/// A field of a style that holds places.
#[derive(Clone, Copy)]
pub(super) struct PlaceField {
    /// Its name in the style.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// How it is written.
    pub form: Written,
    /// What it is at first where the style doesn't say it.
    pub template: &'static str,
    /// Whether it can't be left out.
    pub is_needed: bool,
}

/// How places are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Written {
    /// One, `(longitude, latitude)`.
    Place,
    /// A list of them.
    List,
    /// A list whose longitudes ascend from 0 to 180.
    Hairline,
    /// A list, or `whorl`, `parting` or `hairline(FROM, TO)`.
    Line,
    /// A list of `(longitude, latitude, height)`, two or more.
    Heights,
}

/// Places, as far as they have numbers of their own.
type Points = Vec<[f32; 3]>;

/// What degrees and heights may be.
const LONGITUDE: [f32; 2] = [-360.0, 360.0];
const LATITUDE: [f32; 2] = [-90.0, 90.0];
const HEIGHT: [f32; 2] = [-0.5, 20.0];
/// Radius of a point on the map, and how near the pointer must come to take it.
const POINT: f32 = 4.0;
const REACH: f32 = 7.0;

impl Written {
    /// The points that a field's text has; none where it names a line.
    fn read(self, text: &str) -> Result<Points, String> {
        let text = text.trim();
        match self {
            Self::Place => Ok(vec![pair(text)?]),
            Self::Line if !text.starts_with('[') => named(text).map(|()| Vec::new()),
            Self::Heights => {
                let points = list(text, triple)?;
                match points.len() {
                    0 | 1 => Err("expected two points or more".to_owned()),
                    _ => Ok(points),
                }
            }
            Self::List | Self::Line => list(text, pair),
            Self::Hairline => {
                let points = list(text, pair)?;
                let ascends = points.is_sorted_by(|a, b| a[0] < b[0]);
                let is_half = points.iter().all(|point| (0.0..=180.0).contains(&point[0]));
                match ascends && is_half {
                    true => Ok(points),
                    false => {
                        Err("longitudes must ascend from 0 (forehead) to 180 (nape)".to_owned())
                    }
                }
            }
        }
    }

    /// How few points there may be.
    fn fewest(self) -> usize {
        if self == Self::Heights { 2 } else { 1 }
    }

    fn write(self, [longitude, latitude, height]: [f32; 3]) -> String {
        match self {
            Self::Heights => format!("({longitude}, {latitude}, {height})"),
            _ => format!("({longitude}, {latitude})"),
        }
    }

    /// Where point `i` may be, longitude and latitude.
    fn limits(self, points: &[[f32; 3]], i: usize) -> [[f32; 2]; 2] {
        if self != Self::Hairline {
            return [LONGITUDE, LATITUDE];
        }
        let before = i.checked_sub(1).and_then(|before| points.get(before));
        let from = before.map_or(0.0, |before| before[0] + 0.5);
        let to = points.get(i + 1).map_or(180.0, |after| after[0] - 0.5);
        [[from, to.max(from)], LATITUDE]
    }
}

fn list(text: &str, read: impl Fn(&str) -> Result<[f32; 3], String>) -> Result<Points, String> {
    if !text.starts_with('[') {
        return Err("expected a list of places such as [(-40, 50), (40, 50)]".to_owned());
    }
    let points: Result<Points, String> = edit::items(text, &[]).into_iter().map(read).collect();
    match points {
        Ok(points) if points.is_empty() => Err("expected at least one place".to_owned()),
        points => points,
    }
}

fn pair(text: &str) -> Result<[f32; 3], String> {
    let [min, max] = LONGITUDE;
    let kind = ParamKind::Pair {
        min,
        max,
        default: [0.0; 2],
    };
    match read_value(text, &kind) {
        Ok(Value::Pair([longitude, latitude])) if (-90.0..=90.0).contains(&latitude) => {
            Ok([longitude, latitude, 0.0])
        }
        _ => Err(format!(
            "expected (longitude from -360 to 360, latitude from -90 to 90), found `{text:.40}`"
        )),
    }
}

fn triple(text: &str) -> Result<[f32; 3], String> {
    let [min, max] = LONGITUDE;
    let kind = ParamKind::Triple {
        min,
        max,
        default: [0.0; 3],
    };
    match read_value(text, &kind) {
        Ok(Value::Triple(point))
            if (-90.0..=90.0).contains(&point[1]) && (-0.5..=20.0).contains(&point[2]) =>
        {
            Ok(point)
        }
        _ => Err(format!(
            "expected (longitude from -360 to 360, latitude from -90 to 90, height from -0.5 to 20), \
             found `{text:.40}`"
        )),
    }
}

/// A line that has a name.
fn named(text: &str) -> Result<(), String> {
    let is_named = match text.strip_prefix("hairline") {
        Some(range) => pair_of_longitudes(range.trim()),
        None => ["whorl", "parting"].contains(&text),
    };
    match is_named {
        true => Ok(()),
        false => Err(format!(
            "expected a list of places such as [(-40, 50), (40, 50)], or whorl, parting or \
             hairline(FROM, TO), found `{text:.40}`"
        )),
    }
}

fn pair_of_longitudes(text: &str) -> bool {
    let [min, max] = LONGITUDE;
    let kind = ParamKind::Pair {
        min,
        max,
        default: [0.0; 2],
    };
    read_value(text, &kind).is_ok()
}

/// A field as the text has it.
struct Shown<'a> {
    field: PlaceField,
    text: Option<&'a str>,
    place: Place,
    points: Result<Points, String>,
}

impl Shown<'_> {
    /// The place of one point.
    fn place_of(&self, point: usize) -> Place {
        match self.field.form {
            Written::Place => self.place.clone(),
            _ => self.place.item(point),
        }
    }

    fn points(&self) -> &[[f32; 3]] {
        self.points.as_deref().unwrap_or_default()
    }

    fn is_list(&self) -> bool {
        self.field.form != Written::Place && !self.points().is_empty()
    }

    fn set(&self, i: usize, point: [f32; 3]) -> Edit {
        Edit::Set(self.place_of(i), self.field.form.write(point))
    }

    /// A new point after number `i`.
    fn add(&self, i: usize, point: [f32; 3]) -> Edit {
        Edit::Insert(self.place.clone(), i + 1, self.field.form.write(point))
    }

    fn remove(&self, i: usize) -> Option<Edit> {
        let may = self.is_list() && self.points().len() > self.field.form.fewest();
        may.then(|| Edit::Remove(self.place_of(i)))
    }
}

/// Whether a search finds one of these fields.
pub(super) fn matches(fields: &[PlaceField], owner: &str, search: &Search) -> bool {
    let found = |field: &PlaceField| search.matches(&[field.name, field.doc, owner]);
    fields.iter().any(found)
}

/// Shows fields of the `section` at `place`: their texts, a map of the head, and their points as numbers.
pub(super) fn places(
    ui: &mut Ui,
    owner: &str,
    fields: &[PlaceField],
    section: &str,
    place: &Place,
    search: &Search,
    edits: &mut Vec<Edit>,
) {
    let found = |field: &&PlaceField| search.matches(&[field.name, field.doc, owner]);
    let read = |field: &PlaceField| {
        let text = edit::get(section, &[edit::Step::Field(field.name)]);
        Shown {
            field: *field,
            text,
            place: place.field(field.name),
            points: text.map_or(Ok(Vec::new()), |text| field.form.read(text)),
        }
    };
    let shown: Vec<Shown> = fields.iter().filter(found).map(read).collect();
    for field in &shown {
        text_row(ui, owner, field, edits);
    }
    if shown.iter().all(|field| field.points().is_empty()) {
        return;
    }
    // One point changes a frame, so that numbers of points stay what they are.
    let mut change = map(ui, owner, &shown);
    for field in shown.iter().filter(|field| !field.points().is_empty()) {
        ui.push_id(field.field.name, |ui| {
            let shown = format!("points of {}", field.field.name);
            let name = format!("points of {owner} {}", field.field.name);
            // A search finds fields, not their numbers.
            fold_named(ui, &shown, &name, false, &Search::default(), |ui| {
                let asked = numbers(ui, owner, field);
                change = change.take().or(asked);
            });
        });
    }
    edits.extend(change);
}

fn text_row(ui: &mut Ui, owner: &str, shown: &Shown, edits: &mut Vec<Edit>) {
    let field = &shown.field;
    let row = Row::new(ui, owner, field.name);
    row.show(ui, |ui| {
        let cells = Cells::of(ui);
        let visuals = ui.visuals();
        let wrong = visuals.error_fg_color;
        let color = match (&shown.points, shown.text) {
            (Err(_), _) => wrong,
            (_, Some(_)) => visuals.strong_text_color(),
            _ => visuals.text_color(),
        };
        ui.horizontal(|ui| {
            cell_text(ui, field.name, cells.name, color).on_hover_text(field.doc);
            let text = shown.text.unwrap_or_default();
            let text_color = shown.points.is_err().then_some(wrong);
            let typed = text_line(ui, &row, "", text, cells.control, text_color);
            match typed.as_deref().map(str::trim) {
                None => {}
                Some("") if field.is_needed => row.note(ui, "it can't be left out"),
                Some("") => edits.push(Edit::Remove(shown.place.clone())),
                Some(typed) => match field.form.read(typed) {
                    Ok(_) => edits.push(Edit::Set(shown.place.clone(), typed.to_owned())),
                    Err(message) => row.note(ui, message),
                },
            }
            if shown.text.is_none() {
                let add = format!("add {}", row.name);
                if icon_button(ui, Icon::Add, &add, "Say it in the style").clicked() {
                    edits.push(Edit::Set(shown.place.clone(), field.template.to_owned()));
                }
            } else if !field.is_needed {
                let reset = format!("reset {}", row.name);
                if icon_button(ui, Icon::Reset, &reset, "Back to the default").clicked() {
                    edits.push(Edit::Remove(shown.place.clone()));
                }
            }
        });
        if let Err(message) = &shown.points {
            ui.label(RichText::new(message).small().color(wrong));
        }
    });
}

/// The points of a field as numbers.
fn numbers(ui: &mut Ui, owner: &str, shown: &Shown) -> Option<Edit> {
    let row = Row::new(ui, owner, shown.field.name);
    let points = shown.points();
    let mut change = None;
    for (i, point) in points.iter().enumerate() {
        ui.push_id(i, |ui| {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 3.0;
                let mut new = *point;
                let [longitude, latitude] = shown.field.form.limits(points, i);
                let has_height = shown.field.form == Written::Heights;
                let parts = [
                    ("longitude", longitude, "degrees", 0.5),
                    ("latitude", latitude, "degrees", 0.5),
                    ("height", HEIGHT, "", 0.002),
                ];
                let count = if has_height { 3 } else { 2 };
                for (axis, (part, range, unit, speed)) in parts.into_iter().take(count).enumerate()
                {
                    let field = NumberField {
                        range: range.map(f64::from),
                        default: 0.0,
                        unit,
                        is_whole: false,
                    };
                    let part = format!("point {} {part}", i + 1);
                    let value = f64::from(point[axis]);
                    let (_, number) = drag_value(ui, &row, &part, &field, value, speed, 54.0);
                    if let Some(number) = number {
                        new[axis] = number as f32;
                    }
                }
                if new != *point {
                    change = Some(shown.set(i, new));
                }
                if shown.remove(i).is_some() {
                    let name = row.part(&format!("remove point {}", i + 1));
                    if icon_button(ui, Icon::Remove, &name, "").clicked() {
                        change = shown.remove(i);
                    }
                }
            });
        });
    }
    let last = points.len().saturating_sub(1);
    let name = row.part("add point");
    if shown.is_list() && icon_button(ui, Icon::Add, &name, "Add a point").clicked() {
        change = Some(shown.add(last, next_point(shown.field.form, points)));
    }
    change
}

/// A point that goes on from the last ones.
fn next_point(form: Written, points: &[[f32; 3]]) -> [f32; 3] {
    let [.., last] = points else {
        return [0.0; 3];
    };
    let mut next = match points {
        [.., before, last] => std::array::from_fn(|axis| 2.0 * last[axis] - before[axis]),
        _ => [last[0] + 20.0, last[1], last[2]],
    };
    if form == Written::Hairline && next[0] > 180.0 {
        next[0] = 0.5 * (last[0] + 180.0);
    }
    let limits = [LONGITUDE, LATITUDE, HEIGHT];
    for (number, [min, max]) in next.iter_mut().zip(limits) {
        // Such as sums of tenths leave them.
        *number = ((*number * 1000.0).round() / 1000.0).clamp(min, max);
    }
    next
}

/// A map of the head: longitude from the back over the character's right, face and left to the back again, latitude from
/// the top down.
struct Map {
    rect: Rect,
}

/// A longitude as it is on the map, from -180 to 180, and what was taken off for it.
fn on_map(longitude: f32) -> (f32, f32) {
    if (-180.0..=180.0).contains(&longitude) {
        return (longitude, 0.0);
    }
    let shown = (longitude + 180.0).rem_euclid(360.0) - 180.0;
    (shown, longitude - shown)
}

impl Map {
    fn at(&self, longitude: f32, latitude: f32) -> Pos2 {
        pos2(
            self.rect.left() + (longitude + 180.0) / 360.0 * self.rect.width(),
            self.rect.top() + (90.0 - latitude) / 180.0 * self.rect.height(),
        )
    }

    /// Whole degrees under a point of the screen.
    fn under(&self, at: Pos2) -> [f32; 2] {
        let across = ((at.x - self.rect.left()) / self.rect.width()).clamp(0.0, 1.0);
        let down = ((at.y - self.rect.top()) / self.rect.height()).clamp(0.0, 1.0);
        [
            (360.0 * across - 180.0).round(),
            (90.0 - 180.0 * down).round(),
        ]
    }
}

fn map(ui: &mut Ui, owner: &str, fields: &[Shown]) -> Option<Edit> {
    let id = ui.make_persistent_id(("map", owner));
    let width = ui.available_width();
    let size = vec2(width, (0.42 * width).clamp(80.0, 260.0));
    let (rect, sheet) = ui.allocate_exact_size(size, Sense::CLICK);
    sheet.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("{owner} map")));
    let map = Map {
        rect: rect.shrink(REACH),
    };
    paint_head(ui, &map);

    let mut change = None;
    let colors = [
        ui.visuals().hyperlink_color,
        ui.visuals().warn_fg_color,
        ui.visuals().text_color(),
    ];
    for (shown, color) in fields.iter().zip(colors.into_iter().cycle()) {
        paint_line(ui, &map, shown.points(), color);
        let dragged = drag_points(ui, &map, id.with(shown.field.name), shown, color);
        change = change.or(dragged);
    }
    if let Some(at) = sheet
        .interact_pointer_pos()
        .filter(|_| sheet.double_clicked())
    {
        change = add_near(&map, fields, at);
    }
    sheet.on_hover_text(
        "The head, unrolled: the face in the middle, the back at both sides, the top above. Drag points; \
         a double click adds one, a click of the other button removes it.",
    );
    change
}

fn paint_head(ui: &Ui, map: &Map) {
    let visuals = ui.visuals();
    let painter = ui.painter();
    let corners = visuals.widgets.inactive.corner_radius;
    painter.rect_filled(map.rect.expand(REACH), corners, visuals.extreme_bg_color);
    let grid = Stroke::new(1.0, visuals.widgets.noninteractive.bg_stroke.color);
    for longitude in [-180.0, -90.0, 0.0, 90.0, 180.0] {
        painter.vline(map.at(longitude, 0.0).x, map.rect.y_range(), grid);
    }
    for latitude in [45.0, 0.0, -45.0] {
        painter.hline(map.rect.x_range(), map.at(0.0, latitude).y, grid);
    }
    let weak = visuals.text_color();
    let names = [(-90.0, "right ear"), (0.0, "face"), (90.0, "left ear")];
    for (longitude, name) in names {
        let at = map.at(longitude, -90.0) + vec2(3.0, 0.0);
        painter.text(
            at,
            Align2::LEFT_BOTTOM,
            name,
            FontId::proportional(9.0),
            weak,
        );
    }
}

/// The line through points, also where it goes over the map's sides.
fn paint_line(ui: &Ui, map: &Map, points: &[[f32; 3]], color: Color32) {
    let painter = ui
        .painter()
        .with_clip_rect(map.rect.intersect(ui.clip_rect()));
    let stroke = Stroke::new(1.5, color);
    for turn in [-360.0, 0.0, 360.0] {
        let line = points.iter().map(|point| map.at(point[0] + turn, point[1]));
        painter.add(Shape::line(line.collect(), stroke));
    }
}

fn drag_points(ui: &Ui, map: &Map, id: Id, shown: &Shown, color: Color32) -> Option<Edit> {
    let mut change = None;
    let points = shown.points();
    for (i, point) in points.iter().enumerate() {
        let (longitude, turn) = on_map(point[0]);
        let at = map.at(longitude, point[1]);
        let area = Rect::from_center_size(at, vec2(2.0 * REACH, 2.0 * REACH));
        // Keys go to the list below, not to the map.
        let response = ui.interact(area, id.with(i), Sense::CLICK | Sense::DRAG);
        if let Some(pointer) = response
            .interact_pointer_pos()
            .filter(|_| response.dragged())
        {
            let [longitude, latitude] = map.under(pointer);
            let [[west, east], [south, north]] = shown.field.form.limits(points, i);
            let new = [
                (longitude + turn).clamp(west, east),
                latitude.clamp(south, north),
                point[2],
            ];
            if new != *point {
                change = Some(shown.set(i, new));
            }
        }
        if response.secondary_clicked() {
            change = shown.remove(i);
        }
        let fill = match response.hovered() || response.dragged() {
            true => ui.visuals().strong_text_color(),
            false => color,
        };
        ui.painter().circle_filled(at, POINT, fill);
        response.on_hover_text(format!("{} {}", shown.field.name, i + 1));
    }
    change
}

/// A new point at `at`, after the nearest one of all lists.
fn add_near(map: &Map, fields: &[Shown], at: Pos2) -> Option<Edit> {
    let nearest = fields
        .iter()
        .filter(|shown| shown.is_list() && shown.field.form != Written::Hairline)
        .flat_map(|shown| {
            shown
                .points()
                .iter()
                .enumerate()
                .map(move |point| (shown, point))
        })
        .min_by(|a, b| {
            let distance = |point: &[f32; 3]| map.at(on_map(point[0]).0, point[1]).distance(at);
            distance(a.1.1).total_cmp(&distance(b.1.1))
        });
    let (shown, (i, point)) = nearest?;
    let [longitude, latitude] = map.under(at);
    let turn = on_map(point[0]).1;
    let longitude = (longitude + turn).clamp(LONGITUDE[0], LONGITUDE[1]);
    Some(shown.add(i, [longitude, latitude, point[2]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_read_as_styles_read_them() {
        use Written::{Hairline, Heights, Line, List, Place};
        for (form, text, points) in [
            (Place, "(180, 72)", Some(1)),
            (Place, "(180, 92)", None),
            (Place, "whorl", None),
            (List, "[(0, 1), (-200, 3)]", Some(2)),
            (List, "[]", None),
            (List, "parting", None),
            (Hairline, "[(0, 42), (180, -45)]", Some(2)),
            (Hairline, "[(180, 42), (0, -45)]", None),
            (Line, "parting", Some(0)),
            (Line, "hairline(30, 179)", Some(0)),
            (Line, "hairline(30)", None),
            (Line, "[(0, 1)]", Some(1)),
            (Line, "[(0, 1, 2)]", None),
            (Heights, "[(0, 60, 0), (0, 20, 0.1)]", Some(2)),
            (Heights, "[(0, 60, 0)]", None),
        ] {
            let read = form.read(text).ok().map(|points| points.len());
            assert_eq!(read, points, "{text}");
        }
    }

    #[test]
    fn longitudes_keep_their_turns() {
        for (longitude, shown) in [
            (188.0, -172.0),
            (-190.0, 170.0),
            (300.0, -60.0),
            (180.0, 180.0),
            (-180.0, -180.0),
        ] {
            let (on_map, turn) = on_map(longitude);
            assert_eq!((on_map, on_map + turn), (shown, longitude));
        }
    }

    #[test]
    fn new_points_go_on() {
        let points = [[0.0, 60.0, 0.0], [0.0, 80.0, 0.1]];
        assert_eq!(next_point(Written::List, &points), [0.0, 90.0, 0.2]);
        assert_eq!(next_point(Written::List, &points[..1]), [20.0, 60.0, 0.0]);
        let hairline = [[100.0, 0.0, 0.0], [160.0, -40.0, 0.0]];
        assert_eq!(next_point(Written::Hairline, &hairline)[0], 170.0);
    }
}
