//! From where the head is seen: turning, moving and zooming a preset's camera.

use stage::CameraSection;

/// Degrees for each point that the pointer is dragged.
const DEGREES_PER_POINT: f32 = 0.4;
/// How much nearer the eye comes for each point of scrolling.
const ZOOM_PER_POINT: f32 = 0.002;
/// Farthest and nearest that the eye goes, head heights.
const DISTANCES: (f32, f32) = (0.5, 100.0);

/// A view with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedView {
    /// Straight at the face.
    Front,
    /// Between the face and its left side.
    ThreeQuarter,
    /// At the left side of the head.
    Profile,
    /// From behind.
    Back,
    /// From above.
    Above,
}

impl NamedView {
    /// All of them, in the order of their keys.
    pub const ALL: [Self; 5] = [
        Self::Front,
        Self::ThreeQuarter,
        Self::Profile,
        Self::Back,
        Self::Above,
    ];

    /// What it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "Front",
            Self::ThreeQuarter => "Three-quarter",
            Self::Profile => "Profile",
            Self::Back => "Back",
            Self::Above => "Above",
        }
    }

    /// Yaw and pitch, degrees.
    fn angles(self) -> (f32, f32) {
        match self {
            Self::Front => (0.0, 4.0),
            Self::ThreeQuarter => (38.0, 8.0),
            Self::Profile => (90.0, 4.0),
            Self::Back => (180.0, 4.0),
            Self::Above => (0.0, 75.0),
        }
    }
}

/// The view that is looked from: the preset's own, or another.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Where it is not the preset's. Its field of view is the preset's in any case.
    own: Option<CameraSection>,
}

impl View {
    /// The view, where it is not the preset's own.
    #[must_use]
    pub fn own(&self) -> Option<&CameraSection> {
        self.own.as_ref()
    }

    /// Looks from where the preset says.
    pub fn follow_preset(&mut self) {
        self.own = None;
    }

    /// The camera, of a preset with this one.
    #[must_use]
    pub fn camera(&self, preset: &CameraSection) -> CameraSection {
        let own = self.own.clone().unwrap_or_else(|| preset.clone());
        CameraSection {
            fov: preset.fov,
            ..own
        }
    }

    fn change(&mut self, preset: &CameraSection) -> &mut CameraSection {
        let own = self.own.get_or_insert_with(|| preset.clone());
        own.fov = preset.fov;
        own
    }

    /// Goes round the head by a drag of so many points to the right and down.
    pub fn orbit(&mut self, preset: &CameraSection, [right, down]: [f32; 2]) {
        let camera = self.change(preset);
        camera.yaw = within_half_turn(camera.yaw - DEGREES_PER_POINT * right);
        camera.pitch = (camera.pitch + DEGREES_PER_POINT * down).clamp(-89.0, 89.0);
    }

    /// Moves with the pointer by so many parts of the picture's height, to the right and down.
    pub fn pan(&mut self, preset: &CameraSection, [right, down]: [f32; 2]) {
        let camera = self.change(preset);
        let seen = 2.0 * camera.distance * (0.5 * camera.fov.to_radians()).tan();
        let (sin_yaw, cos_yaw) = camera.yaw.to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = camera.pitch.to_radians().sin_cos();
        // The eye's right and up at yaw 0 are the world's X and Y.
        let right_of = [cos_yaw, 0.0, -sin_yaw];
        let up_of = [-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch];
        for axis in 0..3 {
            let moved = seen * (down * up_of[axis] - right * right_of[axis]);
            camera.target[axis] = (camera.target[axis] + moved).clamp(-100.0, 100.0);
        }
    }

    /// Comes nearer by so many points of scrolling, or a step of the keyboard's.
    pub fn zoom(&mut self, preset: &CameraSection, points: f32) {
        let camera = self.change(preset);
        let distance = camera.distance * (-ZOOM_PER_POINT * points).exp();
        camera.distance = distance.clamp(DISTANCES.0, DISTANCES.1);
    }

    /// Looks at the head's middle, near enough to see head and shoulders.
    pub fn focus(&mut self, preset: &CameraSection) {
        let camera = self.change(preset);
        camera.target = [0.0, -0.1, 0.0];
        camera.distance = 1.2 / (0.5 * camera.fov.to_radians()).tan();
    }

    /// Looks from a named side, from as far as before.
    pub fn look_from(&mut self, preset: &CameraSection, named: NamedView) {
        let camera = self.change(preset);
        (camera.yaw, camera.pitch) = named.angles();
    }
}

/// An angle in degrees from -180 to 180.
fn within_half_turn(degrees: f32) -> f32 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_stay_within_what_presets_take() {
        let (preset, mut view) = (CameraSection::default(), View::default());
        for step in 0..5_000 {
            let way = if step < 2_500 { 37.0 } else { -51.0 };
            view.orbit(&preset, [way, way]);
            view.zoom(&preset, way);
            view.pan(&preset, [0.3, -0.9]);
        }
        let camera = view.camera(&preset);
        effects::section::Section::check(&camera).unwrap();
        assert!((-180.0..=180.0).contains(&camera.yaw) && camera.pitch == -89.0);
    }

    #[test]
    fn panning_moves_the_target_against_the_pointer() {
        let preset = CameraSection {
            yaw: 90.0,
            pitch: 0.0,
            ..CameraSection::default()
        };
        let mut view = View::default();
        // Seen from its left side (+X), what is right is behind (-Z): a drag to the right shows more of the face (+Z).
        view.pan(&preset, [0.5, 0.0]);
        let target = view.camera(&preset).target;
        assert!(
            target[2] > 0.5 && target[0].abs() < 1e-6 && target[1] == 0.0,
            "{target:?}"
        );
        view.pan(&preset, [0.0, 0.25]);
        assert!(view.camera(&preset).target[1] > 0.2);
    }

    #[test]
    fn a_view_follows_the_preset_until_it_is_turned() {
        let mut view = View::default();
        let preset = |yaw| CameraSection {
            yaw,
            ..CameraSection::default()
        };
        assert_eq!(view.camera(&preset(20.0)), preset(20.0));
        view.look_from(&preset(20.0), NamedView::Profile);
        assert_eq!(view.camera(&preset(30.0)).yaw, 90.0);
        view.follow_preset();
        assert_eq!(view.camera(&preset(30.0)), preset(30.0));
    }
}
