//! The marks of tools: made by code and a seed, as coverage along a stroke (`x`, 0 to 1) and across it (`y`, 0 to 1).

use super::noise::{Noise, smooth};
use super::{BrushSection, Fit, Tool};
use crate::texture::Image;
use crate::wgsl::hash;

/// Texels along a stroke and across it.
const SIZE: [usize; 2] = [512, 64];

/// Of so many pictures of a tool's marks each strand has one, so that neighbours differ also where they are stretched.
const VARIANTS: u32 = 4;

/// Teeth at each edge of a zigzag's picture: strokes show as many of them as fit.
const TEETH: u32 = 12;

impl Tool {
    /// The head heights that one of its marks covers: a tooth, or a whole copy.
    pub(super) fn length(self) -> f32 {
        match self {
            Self::Solid | Self::Pencil => 0.4,
            Self::Zigzag => 0.1,
            Self::Charcoal | Self::Crayon => 0.6,
            Self::DryInk | Self::Watercolour => 1.2,
        }
    }

    /// How many marks a copy is made of, each of which begins and ends alike.
    pub(super) fn parts(self) -> u32 {
        match self {
            Self::Zigzag => TEETH,
            _ => 1,
        }
    }
}

/// The pictures of a tool's marks.
pub(super) fn marks(section: &BrushSection) -> impl Iterator<Item = Image> {
    (0..VARIANTS).map(|variant| mark(section, variant))
}

fn mark(section: &BrushSection, variant: u32) -> Image {
    let paper = Paper {
        seed: hash(section.seed ^ hash(variant ^ 0x0062_7275)),
        grain: section.grain,
        dry: section.dry,
        opens: section.fit() == Fit::Stretch,
    };
    let [width, height] = SIZE;
    let covers = paper.covers(section.kind);
    let rows = (0..height).flat_map(|row| {
        let y = (row as f32 + 0.5) / height as f32;
        (0..width).map(move |column| [(column as f32 + 0.5) / width as f32, y])
    });
    let coverage: Vec<f32> = rows.map(|place| covers(place).clamp(0.0, 1.0)).collect();
    Image::of_coverage(SIZE, &coverage).expect("its size is that of a texture")
}

/// What a tool is drawn over, and how.
#[derive(Clone, Copy)]
struct Paper {
    seed: u32,
    grain: f32,
    dry: f32,
    /// Whether the tool runs out from root to tip.
    opens: bool,
}

impl Paper {
    /// Noise with cells of so many texels.
    fn noise(&self, number: u32, [along, across]: [f32; 2]) -> Noise {
        let cell = [
            along * self.grain / SIZE[0] as f32,
            across * self.grain / SIZE[1] as f32,
        ];
        Noise::new(self.seed, number, cell)
    }

    /// The coverage that a tool leaves at a place.
    fn covers(self, tool: Tool) -> Box<dyn Fn([f32; 2]) -> f32> {
        match tool {
            Tool::Solid => Box::new(|_| 1.0),
            Tool::Pencil => Box::new(self.pencil()),
            Tool::Charcoal => Box::new(self.charcoal()),
            Tool::DryInk => Box::new(self.dry_ink()),
            Tool::Watercolour => Box::new(self.watercolour()),
            Tool::Crayon => Box::new(self.crayon()),
            Tool::Zigzag => Box::new(self.zigzag()),
        }
    }

    /// Graphite stays on the tooth of the paper; the line is soft at its edges, and the hand presses now more, now less.
    fn pencil(self) -> impl Fn([f32; 2]) -> f32 {
        let fine = self.noise(1, [6.0, 4.5]);
        let tooth = self.noise(2, [15.0, 10.0]);
        let hand = Noise::new(self.seed, 3, [0.12, 4.0]);
        let sway = Noise::new(self.seed, 4, [0.2, 4.0]);
        move |[x, y]| {
            let from_middle = (2.0 * y - 1.0 + 0.3 * (sway.at([x, 0.5]) - 0.5)).abs();
            let pressure = 1.1 - 0.85 * smooth(0.3, 1.05, from_middle);
            let pressure = pressure * (0.8 + 0.4 * hand.at([x, 0.5]));
            let valley = 0.5 * tooth.at([x, y]) + 0.5 * fine.at([x, y]);
            let bare = 0.45 + 0.75 * self.dry;
            smooth(-0.24, 0.24, pressure - bare * (0.45 + valley))
        }
    }

    /// Coal catches on the ridges alone and crumbles towards its edges, where dust lies beside.
    fn charcoal(self) -> impl Fn([f32; 2]) -> f32 {
        let dust = self.noise(1, [5.0, 4.0]);
        let tooth = self.noise(2, [15.0, 10.0]);
        let drag = self.noise(3, [80.0, 8.0]);
        let hand = Noise::new(self.seed, 4, [0.1, 4.0]);
        move |[x, y]| {
            let from_middle = (2.0 * y - 1.0).abs();
            let pressure =
                1.05 - 0.7 * smooth(0.15, 1.1, from_middle) + 0.3 * (hand.at([x, 0.5]) - 0.5);
            let valley = 0.4 * tooth.at([x, y]) + 0.35 * dust.at([x, y]) + 0.25 * drag.at([x, y]);
            let bare = 0.5 + 0.65 * self.dry;
            smooth(-0.13, 0.13, pressure - bare * (0.4 + valley))
        }
    }

    /// Each hair of the brush draws a streak of its own, and runs out of ink at a place of its own: first the streaks open, then few of them are left.
    fn dry_ink(self) -> impl Fn([f32; 2]) -> f32 {
        let hair = Noise::new(self.seed, 1, [1.0, self.grain * 3.5 / SIZE[1] as f32]);
        let tuft = Noise::new(self.seed, 2, [0.5, self.grain * 15.0 / SIZE[1] as f32]);
        let skips = self.noise(3, [48.0, 3.5]);
        let grain = self.noise(4, [7.0, 3.5]);
        let sway = Noise::new(self.seed, 5, [0.25, 4.0]);
        move |[x, y]| {
            let from_middle = (2.0 * y - 1.0).abs();
            let across = y + 0.04 * sway.at([x, 0.5]);
            let ink = 0.6 * hair.at([0.5, across]) + 0.4 * tuft.at([x, across]);
            let ink = ink - 0.3 * smooth(0.7, 1.0, from_middle);
            // How far the brush has run dry: what repeats is half dry everywhere.
            let start = 0.6 - 0.8 * self.dry;
            let dry = match self.opens {
                true => ((x - start) / (1.0 - start)).max(0.0) * (0.6 + 0.4 * self.dry),
                false => 0.35 + 0.35 * self.dry,
            };
            let broken = 0.75 * skips.at([x, across]) + 0.25 * grain.at([x, y]);
            smooth(-0.07, 0.07, ink + 0.24 - dry * (0.75 + 0.8 * broken))
        }
    }

    /// Thin colour that dries darker where it ends, in clouds, with some of it in the valleys of the paper.
    fn watercolour(self) -> impl Fn([f32; 2]) -> f32 {
        let cloud = self.noise(1, [120.0, 50.0]);
        let bloom = self.noise(2, [48.0, 24.0]);
        let grain = self.noise(3, [7.0, 7.0]);
        let edge = self.noise(4, [60.0, 90.0]);
        let ripple = self.noise(5, [19.0, 40.0]);
        move |[x, y]| {
            let side = if y < 0.5 { 0.0 } else { 0.7 };
            let wobble = 0.7 * edge.at([x, side]) + 0.3 * ripple.at([x, side]);
            let to_edge = 1.0 - 0.22 * wobble - (2.0 * y - 1.0).abs();
            let pool = cloud.at([x, y]);
            let wash =
                0.74 - 0.5 * self.dry + 0.24 * (pool - 0.5) + 0.16 * (bloom.at([x, y]) - 0.5);
            let wash = wash + 0.12 * (grain.at([x, y]) - 0.5);
            let ring = (0.3 + 0.3 * pool) * smooth(0.26, 0.06, to_edge)
                + 0.12 * smooth(0.6, 0.15, to_edge);
            (wash + ring) * smooth(-0.01, 0.03, to_edge)
        }
    }

    /// Wax lies on the ridges of rough paper, more where it is pressed, in streaks along the way; clots stick here and there.
    fn crayon(self) -> impl Fn([f32; 2]) -> f32 {
        let pits = self.noise(1, [6.0, 6.0]);
        let tooth = self.noise(2, [13.0, 11.0]);
        let drag = self.noise(3, [60.0, 6.0]);
        let clots = self.noise(4, [36.0, 22.0]);
        let edge = self.noise(5, [14.0, 60.0]);
        move |[x, y]| {
            let side = if y < 0.5 { 0.0 } else { 0.7 };
            let from_middle = (2.0 * y - 1.0).abs() + 0.2 * (edge.at([x, side]) - 0.4);
            let pressure =
                1.0 - 0.25 * smooth(0.3, 0.9, from_middle) - smooth(0.86, 1.04, from_middle);
            let valley = 0.35 * pits.at([x, y]) + 0.3 * tooth.at([x, y]) + 0.35 * drag.at([x, y]);
            let clot = 0.3 * smooth(0.6, 1.0, clots.at([x, y]));
            let bare = 0.62 + 0.44 * self.dry;
            smooth(-0.06, 0.06, pressure + clot - bare * (0.55 + valley))
        }
    }

    /// Teeth along both edges, no two alike; those of the lower one lean. Both edges lie in a valley where teeth begin and end, so that strokes of whole
    /// teeth which meet there go on in one another, however they are turned. As a shape: how far within the edge a place lies.
    fn zigzag(self) -> impl Fn([f32; 2]) -> f32 {
        let teeth = TEETH as f32;
        let reach = Noise::new(self.seed, 1, [0.5 / teeth, 4.0]);
        let depth = 0.25 + 0.6 * self.dry;
        move |[x, y]| {
            let from_middle = 2.0 * y - 1.0;
            let (row, point) = if from_middle < 0.0 {
                (0.0, 0.5)
            } else {
                (0.5, 0.3)
            };
            let place = x * teeth;
            let tooth = place.floor().min(teeth - 1.0);
            let way = place - tooth;
            // How far the tooth reaches, and how far along it this is: from 0 at its sides to 1 at its point.
            let own = 1.0 - 0.45 * reach.at([(tooth + 0.5) / teeth, row]);
            let height = (way / point).min((1.0 - way) / (1.0 - point));
            let edge = 1.0 - depth + depth * own * height;
            0.5 + 0.5 * (edge - from_middle.abs())
        }
    }
}
