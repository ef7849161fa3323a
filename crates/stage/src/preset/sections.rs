//! The sections of presets: what each may say.

use super::VERSION;
use crate::dynamics::DynamicsSection;
use effects::section::{OutOfRange, Section};
use effects::{Param, Parameters, Value, Values, choices, clump, section};

choices! {
    /// The upward axis of a file.
    pub enum UpAxis {
        /// The one that fits the head.
        Guess = "guess",
        /// Y.
        Y = "y",
        /// Z.
        Z = "z",
    }
}

choices! {
    /// Where hair is from.
    pub enum HairFrom {
        /// The section's file.
        File = "file",
        /// The character that is the head.
        Character = "character",
    }
}

choices! {
    /// Whose colour shadows have on hair that has colours of its file's.
    pub enum ShadowColors {
        /// The hair's: darker shades of it.
        Own = "own",
        /// The look's.
        Look = "look",
    }
}

section! {
    /// Which strands are drawn.
    pub struct HairSection {
        /// Strands to draw, relative to the preset: .tfx, .strands.ron or .style.ron.
        file: Option<String> = text(),
        /// Where it is from: that file, or the hair that the character of section `head` has as a mesh, whose locks become strands; then `file`
        /// is only for characters without.
        from: HairFrom = HairFrom::File.or_another(),
        /// Which of the character's meshes are hair: names of meshes, materials or spring bones with commas between them, `*` for any end. Without it
        /// what is called hair, or else what spring bones on the head move.
        meshes: Option<String> = text(),
        /// Which of these stay meshes, as ribbons do: names as in `meshes`.
        keep: Option<String> = text(),
        /// What shadows on hair that has colours of its file's, as a character's own has, are: darker shades of these, or in the look's colour for shadows, which
        /// was made for the look's hair.
        shadows: ShadowColors = ShadowColors::Own.or_another(),
        /// How many strands to keep, those that stand best for all; 0 keeps all.
        guides: u32 = whole(0, 0..=1_000_000),
        /// Motion of this hair that `inkstrand simulate` has written, relative to the preset.
        bake: Option<String> = text(),
        /// The file's upward axis.
        up: UpAxis = UpAxis::Guess.or_another(),
        /// Metres in one unit of the file; 0 guesses.
        scale: f32 = number(0.0, 0.0..=1e4).unit("m"),
        /// Clump size of strands that bring none; 0 takes it from the spacing of the roots. A character's own locks become strands of at most this size, 0: 14.
        size: f32 = number(0.0, 0.0..=300.0).unit("1/300 head height"),
    }
}

choices! {
    /// The head where no file is named.
    pub enum HeadShape {
        /// None.
        None = "none",
        /// The bust that comes with inkstrand.
        Bust = "bust",
        /// A figure with the bust's skull, and a face and a dress to choose.
        Figure = "figure",
    }
}

choices! {
    /// What a figure wears.
    pub enum DressChoice {
        /// Nothing.
        None = "none",
        /// A band around the neck, and a top with straps.
        Choker = "choker",
        /// A collar that is rolled at the jaw.
        Turtleneck = "turtleneck",
        /// A shirt with a folded collar and a tie.
        Collar = "collar",
        /// A jacket with a wide collar, open over a shirt.
        Jacket = "jacket",
        /// A blouse with a sailor's collar and a bow.
        Sailor = "sailor",
    }
}

choices! {
    /// The cut of a figure's eyes.
    pub enum EyesChoice {
        /// Large and open.
        Round = "round",
        /// Long, a little pointed.
        Almond = "almond",
        /// Narrow, the outer corners raised.
        Sharp = "sharp",
        /// Under heavy lids, the outer corners low.
        Sleepy = "sleepy",
    }
}

choices! {
    /// What a figure's face says.
    pub enum ExpressionChoice {
        /// At rest.
        Neutral = "neutral",
        /// A smile with open eyes.
        Smile = "smile",
        /// An open mouth under eyes closed upwards.
        Laugh = "laugh",
        /// Eyes closed at rest.
        Closed = "closed",
    }
}

choices! {
    /// Blush on a figure's cheeks.
    pub enum BlushChoice {
        /// None.
        None = "none",
        /// A flat shape under each eye.
        Flat = "flat",
        /// Slanted strokes.
        Hatch = "hatch",
    }
}

choices! {
    /// Whose colours a head from a file has.
    pub enum HeadColors {
        /// Those of the preset's section `head`: two flat tones and an outline.
        Preset = "preset",
        /// The file's own.
        File = "file",
    }
}

section! {
    /// The head under the hair, and its colours.
    pub struct HeadSection {
        /// The head, relative to the preset: .obj, .ply, .gltf, .glb or .vrm.
        file: Option<String> = text(),
        /// The head where no file is named: none, the bust that comes with inkstrand, or a figure with the bust's skull that is dressed and has
        /// a face to choose. What follows `threshold` is said of figures alone.
        shape: HeadShape = HeadShape::None.or_another(),
        /// Whose colours a head from a file has: this section's, or the file's own with its pictures and cut-outs. Then `light` and `shadow` say
        /// only how much darker the side away from the light is, where the file doesn't say it.
        colors: HeadColors = HeadColors::Preset.or_another(),
        /// What of the file is not there: names of meshes or materials, or of bones for all that hangs on them, with commas between them, `*` for any end.
        hide: Option<String> = text(),
        /// The file's upward axis.
        up: UpAxis = UpAxis::Guess.or_another(),
        /// Metres in one unit of the file; 0 guesses.
        scale: f32 = number(0.0, 0.0..=1e4).unit("m"),
        /// Colour of the lit side.
        light: [f32; 3] = color("F8DCC8"),
        /// Colour of the side away from the light.
        shadow: [f32; 3] = color("E3B49C"),
        /// Colour of the outline.
        line: [f32; 3] = color("6B4438"),
        /// Colour of the bust's eyes.
        iris: [f32; 3] = color("3A9CA6"),
        /// Colour of the pupils and of the irises under the lids.
        iris_shadow: [f32; 3] = color("1B4F5C"),
        /// Colour of ties in the hair.
        tie: [f32; 3] = color("F0F0F5"),
        /// Colour of ties away from the light.
        tie_shadow: [f32; 3] = color("B8B8CC"),
        /// How far around roots the head has the hair's basic colour, so that gaps between clumps are no bald spots; 0 is nowhere.
        /// Hair styles that have an undercoat don't need it.
        scalp: f32 = number(0.05, 0.0..=1.0).unit("head heights"),
        /// Width of the outline; 0 is none.
        width: f32 = number(1.6, 0.0..=50.0).unit("1/300 head height"),
        /// Where light turns to shadow: the cosine to the light.
        threshold: f32 = number(0.1, -1.0..=1.0),
        /// How far below the chin the figure is cut off; its outline thins out there, and lines of meshes end.
        crop: f32 = number(1.05, 0.5..=2.4).unit("head heights"),
        /// What it wears.
        dress: DressChoice = DressChoice::None.or_another(),
        /// Colour of the dress.
        dress_light: [f32; 3] = color("F4F1EE"),
        /// Colour of the dress away from the light.
        dress_shadow: [f32; 3] = color("C3BFD2"),
        /// Colour of the dress's outline and hems.
        dress_line: [f32; 3] = color("4A4458"),
        /// Colour of what is set off from the dress: collar, band, bow, tie or shirt.
        accent: [f32; 3] = color("3E5A94"),
        /// Colour of that away from the light.
        accent_shadow: [f32; 3] = color("2A3E70"),
        /// The cut of the eyes.
        eyes: EyesChoice = EyesChoice::Round.or_another(),
        /// Size of the eyes.
        eye_size: f32 = number(1.0, 0.7..=1.2),
        /// Colour of the lower part of the irises, which light comes through.
        iris_light: [f32; 3] = color("8FD3D1"),
        /// Lights in each eye.
        highlights: u32 = whole(2, 0..=3),
        /// Width of the brows, in parts of their own; 0 is none.
        brow: f32 = number(1.0, 0.0..=3.0),
        /// What the face says: eyes, brows and mouth.
        expression: ExpressionChoice = ExpressionChoice::Neutral.or_another(),
        /// Blush on the cheeks.
        blush: BlushChoice = BlushChoice::None.or_another(),
        /// Colour of the blush.
        blush_color: [f32; 3] = color("F0A79A"),
        /// Colour of the inside of an open mouth.
        mouth: [f32; 3] = color("B4555A"),
    }
}

choices! {
    /// Which stroke a sample shows: see [`render::Order`].
    pub enum OrderChoice {
        /// [`render::Order::Rounded`].
        Rounded = "rounded",
        /// An order of earlier presets, drawn as [`Self::Rounded`].
        Scattered = "scattered",
        /// [`render::Order::StrandFirst`].
        StrandFirst = "strand_first",
        /// [`render::Order::Shifted`].
        Shifted = "shifted",
    }
}

section! {
    /// The picture: size, samples, background, frame rate.
    pub struct SceneSection {
        /// Width and height of the picture.
        size: [u32; 2] = size([960, 720], 1..=16_384),
        /// Samples a pixel.
        samples: u32 = whole(16, 1..=256),
        /// Colour behind everything, or none for a transparent picture.
        background: Option<[f32; 3]> = optional_color(Some("FFFFFF")),
        /// Frames a second.
        fps: f32 = number(24.0, 1.0..=1000.0).unit("1/s"),
        /// Within a strand by rank, then by depth, of round clumps or of flat ones; or every stroke by its shifted depth.
        /// `scattered`, as older presets say, is drawn as `rounded`.
        order: OrderChoice = OrderChoice::Rounded.or_another(),
        /// How much deeper than its middle a round clump's edge lies.
        edge_depth: f32 = number(0.02, 0.0..=1.0).unit("head heights"),
        /// Clumps narrower than this are drawn as fewer and wider ones, with as much ink: dense hair in less time. 0 draws all.
        detail: f32 = number(1.0, 0.0..=16.0).unit("pixels"),
    }
}

section! {
    /// From where it is seen.
    pub struct CameraSection {
        /// 0 looks at the face; positive moves to the viewer's right.
        yaw: f32 = number(0.0, -360.0..=360.0).unit("degrees"),
        /// Positive looks from above.
        pitch: f32 = number(0.0, -90.0..=90.0).unit("degrees"),
        /// From the target to the eye.
        distance: f32 = number(4.48, 0.01..=1000.0).unit("head heights"),
        /// Vertical field of view.
        fov: f32 = number(30.0, 1.0..=150.0).unit("degrees"),
        /// What the camera looks at, from the head's centre.
        target: [f32; 3] = triple([0.0; 3], -1000.0..=1000.0).unit("head heights"),
    }
}

choices! {
    /// What a light is.
    pub enum LightKind {
        /// A light from far away.
        Direction = "direction",
        /// A light at a place.
        Point = "point",
    }
}

choices! {
    /// What a light turns with.
    pub enum FixedTo {
        /// The world.
        World = "world",
        /// The camera.
        Camera = "camera",
    }
}

section! {
    /// Where the light comes from.
    pub struct LightSection {
        /// A light from far away, or one at a place.
        kind: LightKind = LightKind::Direction.or_another(),
        /// What the light turns with.
        fixed_to: FixedTo = FixedTo::World.or_another(),
        /// 0 shines at the face; positive comes from the viewer's right.
        yaw: f32 = number(35.0, -360.0..=360.0).unit("degrees"),
        /// Positive shines from above.
        pitch: f32 = number(40.0, -90.0..=90.0).unit("degrees"),
        /// A point light's distance from the head's centre.
        distance: f32 = number(3.0, 0.01..=1000.0).unit("head heights"),
    }
}

choices! {
    /// What of a pose is held.
    pub enum HeldChoice {
        /// Head and hair.
        All = "all",
        /// Hair, on a head that moves.
        Hair = "hair",
    }
}

section! {
    /// How head, wind and hair move.
    pub struct MotionSection {
        /// How head, wind and hair move, relative to the preset: .motion.ron.
        file: Option<String> = text(),
        /// A character whose animation moves the head, relative to the preset: .glb, .gltf or .vrm. The script's moves come on top.
        gltf: Option<String> = text(),
        /// Whether the head's own file moves it, a character with an animation: its bones pose all of its meshes, and hair follows the head's. The
        /// script's moves come on top; the head has its file's colours.
        character: bool = flag(false),
        /// The character's bone that the head follows; "head" without it.
        bone: Option<String> = text(),
        /// The character's animation, by its name or its number, 0 first; the first without it.
        animation: Option<String> = text(),
        /// Whether the character's animation starts again at its end.
        repeat: bool = flag(false),
        /// Frames that each pose is held: 1 on ones, 2 on twos, 3 on threes. The simulation goes on underneath.
        on: u32 = whole(1, 1..=24),
        /// What is held: all, or hair alone on a head that moves in each frame.
        held: HeldChoice = HeldChoice::All.or_another(),
    }
}

impl MotionSection {
    /// What of it contradicts itself: a parameter, and why.
    pub(crate) fn unsupported(&self) -> Option<(&'static str, String)> {
        (self.gltf.is_some() && self.character).then(|| {
            let message = "gltf: it and `character` both move the head: one of them";
            ("gltf", message.to_owned())
        })
    }
}

choices! {
    /// How particles are joined.
    pub enum PathChoice {
        /// By straight lines.
        Linear = "linear",
        /// By a Catmull-Rom spline.
        CatmullRom = "catmull_rom",
    }
}

choices! {
    /// What is put down along a path.
    pub enum BrushChoice {
        /// A circle, which ends round.
        Circle = "circle",
        /// The half of it behind its centre, which ends flat.
        Semicircle = "semicircle",
    }
}

section! {
    /// How a strand becomes a stroke's path.
    pub struct PathSection {
        /// How particles are joined.
        kind: PathChoice = PathChoice::CatmullRom.or_another(),
        /// Joints from one particle to the next.
        subdivision: u32 = whole(4, 1..=64),
        /// What is put down along a path: a circle, which ends round, or the half of it behind its centre, which ends flat.
        brush: BrushChoice = BrushChoice::Circle.or_another(),
    }
}

section! {
    /// What stands in a preset beside its sections and layers.
    pub struct TopSection {
        /// Version of the preset's format.
        version: u32 = whole(VERSION, 1..=VERSION),
        /// Seed of all variations.
        seed: u32 = whole(1, 0..=i32::MAX as u32),
        /// Another preset that this one builds on, relative to it. What this one says is in place of what that one says: each value of a
        /// section or of a layer with the same name by itself, `lines`, `meshes`, `bodies`, `passes` and `objects` as a whole. New layers come after its own.
        base: Option<String> = text(),
        /// The base's layers that are left out: their names with commas between them, such as "hair.fine, hair.highlight".
        without: Option<String> = text(),
    }
}

/// What all layers share of a strand: size, normal, basic colour. Its table is that of the clump's WGSL.
#[derive(Clone, Debug, PartialEq)]
pub struct ClumpSection(pub Values);

impl ClumpSection {
    /// What it is about.
    pub const DOC: &'static str = "What all layers share of a strand: size, normal, basic colour.";
    /// What parameters there are.
    pub const TABLE: &'static [Param] = clump::Program::PARAMS;
}

impl Default for ClumpSection {
    fn default() -> Self {
        Self(Values::defaults(Self::TABLE))
    }
}

impl Section for ClumpSection {
    fn table(&self) -> &'static [Param] {
        Self::TABLE
    }

    fn set(&mut self, index: usize, value: Value) {
        self.0.set(index, value);
    }

    fn get(&self, index: usize) -> Option<Value> {
        self.0.get(index)
    }
}

/// Makes [`Sections`], and what goes through them by name, from one list.
macro_rules! sections {
    ($($name:ident: $Type:ty),+ $(,)?) => {
        /// A preset's sections: all that it says but for its layers.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Sections {
            $(#[doc = concat!("The section `", stringify!($name), "`.")] pub $name: $Type),+
        }

        impl Sections {
            /// Names, with what each is about and its table.
            pub const ALL: &'static [(&'static str, &'static str, &'static [Param])] =
                &[$((stringify!($name), <$Type>::DOC, <$Type>::TABLE)),+];

            /// The section of that name.
            pub fn by_name(&mut self, name: &str) -> Option<&mut dyn Section> {
                match name {
                    $(stringify!($name) => Some(&mut self.$name),)+
                    _ => None,
                }
            }

            /// Holds all values against their tables, for sections that a program filled in.
            ///
            /// # Errors
            ///
            /// The first section and parameter whose value is not one of those it takes.
            pub fn check(&self) -> Result<(), (&'static str, OutOfRange)> {
                $(self.$name.check().map_err(|error| (stringify!($name), error))?;)+
                Ok(())
            }
        }
    };
}

sections! {
    hair: HairSection,
    head: HeadSection,
    scene: SceneSection,
    camera: CameraSection,
    light: LightSection,
    motion: MotionSection,
    dynamics: DynamicsSection,
    path: PathSection,
    clump: ClumpSection,
}
