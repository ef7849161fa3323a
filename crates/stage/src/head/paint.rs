//! How a head is painted.

use groom::{Cloth, Ink};

/// How a head is painted. Colours are linear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeadPaint {
    pub light: [f32; 3],
    pub shadow: [f32; 3],
    pub line: [f32; 3],
    pub iris: [f32; 3],
    pub iris_shadow: [f32; 3],
    pub iris_light: [f32; 3],
    pub blush: [f32; 3],
    pub mouth: [f32; 3],
    pub dress: [f32; 3],
    pub dress_shadow: [f32; 3],
    pub dress_line: [f32; 3],
    pub accent: [f32; 3],
    pub accent_shadow: [f32; 3],
    pub tie: [f32; 3],
    pub tie_shadow: [f32; 3],
    /// Between clumps of hair.
    pub scalp: [f32; 3],
    /// 1/300 of the head's height, metres.
    pub unit_m: f32,
    /// Width of the outline in metres; 0 is none.
    pub width_m: f32,
    /// How much nearer than the head's inside hair must be to be seen through an opening, metres.
    pub inside_margin_m: f32,
    /// How much farther than the outline hair may be, metres: hair on the skin covers it, hair behind
    /// the head does not.
    pub outline_margin_m: f32,
    /// The cosine to the light at which light turns to shadow.
    pub threshold: f32,
}

impl HeadPaint {
    /// How much darker its shadow is than its light.
    pub(super) fn shade(&self) -> [f32; 3] {
        [0, 1, 2].map(|i| (self.shadow[i] / self.light[i].max(1e-3)).min(1.0))
    }

    pub(super) fn of(&self, ink: Ink) -> [f32; 3] {
        match ink {
            Ink::Line => self.line,
            Ink::White => [1.0; 3],
            Ink::Iris => self.iris,
            Ink::IrisShadow => self.iris_shadow,
            Ink::IrisLight => self.iris_light,
            // White in the shadow of the skin around it.
            Ink::WhiteShadow => self.shadow.map(|shadow| 0.45 + 0.55 * shadow),
            Ink::SkinShadow => self.shadow,
            Ink::Blush => self.blush,
            Ink::Mouth => self.mouth,
        }
    }

    /// Light, shadow and outline of what a triangle is painted as.
    pub(super) fn of_cloth(&self, cloth: Cloth) -> [[f32; 3]; 3] {
        match cloth {
            Cloth::Skin => [self.light, self.shadow, self.line],
            Cloth::Dress => [self.dress, self.dress_shadow, self.dress_line],
            Cloth::Accent => [self.accent, self.accent_shadow, self.dress_line],
            Cloth::Line => [self.dress_line; 3],
        }
    }
}
