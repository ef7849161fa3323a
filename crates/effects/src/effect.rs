//! What an effect is.

use crate::joints::{Input, InputSet, Joints, LANES};
use crate::lanes::widest;
use crate::param::{Param, ParamKind, Values};
use crate::paths::{Hair, MadePaths};
use crate::program::{Parameters, Program};
use crate::samples::{BLOCK, SampleBlock, SampleInput, SampleSet, Samples, Vectors};
use crate::source::{PaintSource, ProgramSource};
use crate::strokes::{Strokes, Taken};
use crate::texture::{Lookups, Texels, Texture};
use crate::varied::Varied;
use crate::wgsl::{Vec3, hash};
use std::ops::Range;

/// A stroke effect, as its author writes it.
///
/// ```ignore
/// effects::effect!("outline"); // src/outline.wgsl, translated by build.rs
///
/// /// A line around the hair.
/// pub struct Outline;
///
/// impl effects::StrokeEffect for Outline {
///     type Program = Program;
///     const ID: &'static str = "mine.outline";
///     const DOC: &'static str = "a line around the hair";
/// }
/// ```
pub trait StrokeEffect: Send + Sync + 'static {
    /// The translated WGSL.
    type Program: Program;
    /// A stable id: `hair.` for inkstrand's own, `vendor.` for others.
    const ID: &'static str;
    /// One line for people.
    const DOC: &'static str;
    /// Drawing order within a strand, low first; the base stroke is 0. From 0 on, strokes are
    /// clipped to the clump.
    const RANK: i32 = 100;
    /// How much farther from the eye the strokes are than their strand, in head heights.
    const DEPTH_OFFSET: f32 = 0.0;
    /// Whether the strokes follow paths that the effect makes ([`Self::make_paths`]), in place of the
    /// strands. These are strands of their own in the order, whose clump is their first stroke.
    const OWN_PATHS: bool = false;
    /// Whether it paints meshes and draws no strokes: [`MeshEffect`](crate::MeshEffect).
    const IS_FOR_MESHES: bool = false;
    /// Whether it draws lines of surfaces: strands whose joints lie on a mesh, have no clump, and whose material normals are the surface's.
    /// Else it draws hair.
    const IS_FOR_LINES: bool = false;
    /// Whether there are strokes on the coat of clumps below a hair style's own, too. It shows in gaps alone,
    /// where highlights would be specks.
    const ON_UNDERCOAT: bool = true;

    /// Whether its first strokes are the clump itself: at every joint the offset and the radius of the discs of
    /// [`clump_disc`](crate::wgsl::clump_disc), in any colour. What other hair has behind it is then never seen, and need not be
    /// worked out. Only of effects with a rank of 0 or more.
    const IS_CLUMP: bool = false;

    /// What its strokes are drawn on where the layer doesn't say it (`clip`); nothing where they are no decals.
    const CLIP: Option<&'static str> = None;
    /// How far before or behind them, head heights, decals are drawn on that where the layer doesn't say it.
    const REACH: f32 = 0.05;
    /// Whether its strokes are shadows that hair casts: decals that meshes show as their own colours in shadow, and that no hair shows but
    /// what lies behind them by more than the layer's reach, never their own strand. Of effects with a [`Self::CLIP`].
    const CASTS: bool = false;

    /// Parameters (colour or none) that shadows on hair have their colour by: on hair that has colours of its file's, as a character's has, they are none,
    /// so that the effect draws a shade of these, where the look's colour was made for the look's hair.
    fn shadow_colors(params: &<Self::Program as Parameters>::Params) -> &'static [&'static str] {
        let _ = params;
        &[]
    }

    /// How many strokes there are for each strand (feathers). At least 1.
    fn instances(params: &<Self::Program as Parameters>::Params) -> u32 {
        let _ = params;
        1
    }

    /// The shortest stretch of a strand as it is seen, in head heights, that a stroke may cover or leave
    /// out: shorter ones are smoothed away ([`smooth`](crate::smooth)). 0 leaves all as it is.
    fn shortest(params: &<Self::Program as Parameters>::Params) -> f32 {
        let _ = params;
        0.0
    }

    /// Of a strand's joints those from the first to behind the last at which a stroke may have a size, by what is cheap to know before it
    /// is evaluated; nothing where the strand has no such stroke. Beyond them its radius is 0, which is then not worked out. All
    /// joints, where nothing is said: then radii tell, and a stroke without a size costs those alone.
    ///
    /// It is asked where no parameter varies, and reads what the WGSL declares.
    fn extent(
        params: &<Self::Program as Parameters>::Params,
        strand: &StrandJoints,
    ) -> Range<usize> {
        let _ = params;
        strand.range.clone()
    }

    /// Whether the light must have a place: what is measured from a light without one is 1e6 head
    /// heights away.
    fn needs_point_light(params: &<Self::Program as Parameters>::Params) -> bool {
        let _ = params;
        false
    }

    /// Of an effect for lines ([`Self::IS_FOR_LINES`]) that reads [`Input::RestPosition`]: whether its strokes hang on that. Contours are at rest nowhere, as
    /// they are elsewhere on the surface in each frame: where they do, contours are followed from frame to frame, and have places of their own there, which stay with them. The
    /// parameters are the largest that there are along lines and from line to line.
    fn follows_lines(params: &<Self::Program as Parameters>::Params) -> bool {
        let _ = params;
        true
    }

    /// How far strokes reach, where that is less than any may: what is far off the picture, or behind a head, costs less then. The
    /// parameters are the largest that there are along strands and from strand to strand.
    fn reach(params: &<Self::Program as Parameters>::Params) -> Reach {
        let _ = params;
        Reach::FARTHEST
    }

    /// How far strokes reach beyond the clump's own discs, where that is known: by the lesser of the two. Hair behind other hair costs less then. It is
    /// asked as [`Self::reach`] is.
    fn beyond(params: &<Self::Program as Parameters>::Params) -> Option<Reach> {
        let _ = params;
        None
    }

    /// Whether painting with these parameters makes use of something of a sample that the WGSL declares, so that it need not be worked
    /// out else. Of effects with a parameter that varies all is.
    fn reads(params: &<Self::Program as Parameters>::Params, input: SampleInput) -> bool {
        let _ = (params, input);
        true
    }

    /// Makes this frame's paths of the hair as it stands, for an effect with [`Self::OWN_PATHS`]. Choices
    /// hang on `seed`, the layer's, and the strands' ids alone, so that the paths move as the hair does.
    fn make_paths(
        params: &<Self::Program as Parameters>::Params,
        hair: &Hair,
        seed: u32,
        paths: &mut MadePaths,
    ) {
        let _ = (params, hair, seed, paths);
    }
}

/// The joints of one strand, or of a piece of it, from the root to the tip; and which of its strokes is asked for.
#[derive(Clone, Debug)]
pub struct StrandJoints<'a> {
    /// The joints of all strands.
    pub joints: &'a Joints,
    /// Which of them are the strand's; at least one.
    pub range: Range<usize>,
    /// Which of its strokes.
    pub instance: u32,
    /// `joint.seed`, as the WGSL has it; 0 where it isn't declared.
    pub seed: u32,
}

impl StrandJoints<'_> {
    /// From the first joint for which `may_have_size` to behind the last.
    pub fn extent(&self, mut may_have_size: impl FnMut(usize) -> bool) -> Range<usize> {
        let mut rest = self.range.clone();
        let Some(start) = rest.find(|&joint| may_have_size(joint)) else {
            return self.range.start..self.range.start;
        };
        let last = rest.rfind(|&joint| may_have_size(joint));
        start..last.unwrap_or(start) + 1
    }

    /// The extent of one of the discs of [`clump_disc`](crate::wgsl::clump_disc): the first lies everywhere, those at the sides where
    /// the clump is seen to be flat. `clump_radius` and `clump_shift` are declared.
    #[must_use]
    pub fn clump_disc_extent(&self) -> Range<usize> {
        if self.instance == 0 {
            return self.range.clone();
        }
        let Joints {
            clump_radius,
            clump_shift,
            ..
        } = self.joints;
        self.extent(|i| {
            // A little less than where `clump_disc` has its step, for rounding.
            let flat = 0.199 * clump_radius[i].max(1e-6);
            clump_shift[i].dot(clump_shift[i]).0 > flat * flat
        })
    }
}

/// A [`StrokeEffect`] without its types, as the registry keeps it.
pub trait AnyEffect: Send + Sync {
    /// [`StrokeEffect::ID`].
    fn id(&self) -> &'static str;
    /// [`StrokeEffect::DOC`].
    fn doc(&self) -> &'static str;
    /// [`StrokeEffect::RANK`].
    fn rank(&self) -> i32;
    /// [`StrokeEffect::DEPTH_OFFSET`].
    fn depth_offset(&self) -> f32;
    /// [`StrokeEffect::CLIP`].
    fn clip(&self) -> Option<&'static str>;
    /// [`StrokeEffect::REACH`].
    fn clip_reach(&self) -> f32;
    /// [`Parameters::PARAMS`].
    fn params(&self) -> &'static [Param];
    /// [`Parameters::INPUTS`].
    fn inputs(&self) -> &'static [Input];
    /// Whether it paints meshes ([`MeshEffect`](crate::MeshEffect)) and draws no strokes.
    fn is_for_meshes(&self) -> bool;
    /// [`StrokeEffect::IS_FOR_LINES`].
    fn is_for_lines(&self) -> bool;
    /// [`Program::PAINTS`].
    fn paints(&self) -> Option<&'static [SampleInput]>;
    /// [`Parameters::WGSL`].
    fn wgsl(&self) -> &'static str;
    /// The effect with these values.
    fn program(&self, values: &Values) -> Box<dyn LayerProgram>;
}

/// How far strokes reach from the middle of their clump, their radius and all: the sum of both. What is so far off the picture isn't
/// worked out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// In radii of the clump there.
    pub clumps: f32,
    /// In the layer's unit: 1/300 of the head's height, or pixels of a picture of 720 lines.
    pub units: f32,
}

impl Reach {
    /// What no stroke may exceed: eight of the clump's radii and half a head's height, or 150 pixels.
    pub const FARTHEST: Self = Self {
        clumps: 8.0,
        units: 150.0,
    };
    /// Where strokes of no width reach: there are none. A layer of such strokes alone is left out, with the paths and lines that only it is drawn on.
    pub const NOWHERE: Self = Self {
        clumps: 0.0,
        units: 0.0,
    };
}

/// How many discs a clump is made of: `clump_disc` in `shaders/prelude.wgsl`.
pub const CLUMP_DISCS: u32 = 3;

/// An effect with its parameters, ready to be evaluated.
pub trait LayerProgram: Send + Sync {
    /// Strokes per strand, 1 or more.
    fn instances(&self) -> u32;
    /// [`StrokeEffect::shortest`], head heights.
    fn shortest(&self) -> f32;
    /// [`StrokeEffect::needs_point_light`].
    fn needs_point_light(&self) -> bool;
    /// [`StrokeEffect::follows_lines`] of an effect that is asked for that.
    fn follows_lines(&self) -> bool;
    /// [`StrokeEffect::OWN_PATHS`].
    fn has_own_paths(&self) -> bool;
    /// [`StrokeEffect::ON_UNDERCOAT`].
    fn is_on_undercoat(&self) -> bool;
    /// [`StrokeEffect::IS_CLUMP`].
    fn is_clump(&self) -> bool;
    /// [`StrokeEffect::CASTS`].
    fn casts(&self) -> bool;
    /// [`StrokeEffect::shadow_colors`].
    fn shadow_colors(&self) -> &'static [&'static str];
    /// [`Program::MAY_BE_NEARER`].
    fn may_be_nearer(&self) -> bool;
    /// [`StrokeEffect::reach`].
    fn reach(&self) -> Reach;
    /// [`StrokeEffect::beyond`].
    fn beyond(&self) -> Option<Reach>;
    /// [`StrokeEffect::make_paths`].
    fn make_paths(&self, hair: &Hair, seed: u32, paths: &mut MadePaths);
    /// What is read of a joint.
    fn inputs(&self) -> InputSet;
    /// The same for a graphics card.
    fn source(&self) -> ProgramSource<'_>;
    /// [`StrokeEffect::extent`] of stroke `instance` on these joints of one strand. `seed` is the layer's.
    fn extent(
        &self,
        joints: &Joints,
        range: Range<usize>,
        instance: u32,
        seed: u32,
    ) -> Range<usize>;
    /// Appends the discs of stroke `instance` at these joints. `seed` is the layer's.
    fn evaluate(
        &self,
        joints: &Joints,
        range: Range<usize>,
        instance: u32,
        seed: u32,
        strokes: &mut Strokes,
    );
    /// What is read of each sample that the layer shows, where its effect paints them; nothing where samples have their strokes' colours.
    fn paints(&self) -> Option<SampleSet>;
    /// Of what [`Self::paints`] says that which painting with these parameters makes use of.
    fn reads(&self) -> SampleSet;
    /// The linear colours of a block's samples, all of them shown by this layer. `seed` is the layer's.
    fn paint_block(&self, samples: &SampleBlock, seed: u32, colors: &mut Vectors);
    /// Appends the linear colours of samples of a list, block by block.
    fn paint(
        &self,
        samples: &Samples,
        range: Range<usize>,
        seed: u32,
        colors: &mut Vec<Vec3<f32>>,
    ) {
        let mut of_block = Vectors::NOTHING;
        for start in range.clone().step_by(BLOCK) {
            let some = start..range.end.min(start + BLOCK);
            self.paint_block(&samples.block(some.clone()), seed, &mut of_block);
            colors.extend((0..some.len()).map(|index| of_block.at(index)));
        }
    }
    /// Appends their radii alone, bit for bit the same: most strokes have none on most joints, and what else is made of them need
    /// not be worked out.
    fn radii(
        &self,
        joints: &Joints,
        range: Range<usize>,
        instance: u32,
        seed: u32,
        radii: &mut Vec<f32>,
    );
}

/// The erasure of an effect `E`.
pub(crate) struct Erased<E>(pub std::marker::PhantomData<fn() -> E>);

impl<E: StrokeEffect> AnyEffect for Erased<E> {
    fn id(&self) -> &'static str {
        E::ID
    }
    fn doc(&self) -> &'static str {
        E::DOC
    }
    fn rank(&self) -> i32 {
        E::RANK
    }
    fn depth_offset(&self) -> f32 {
        E::DEPTH_OFFSET
    }
    fn clip(&self) -> Option<&'static str> {
        E::CLIP
    }
    fn clip_reach(&self) -> f32 {
        E::REACH
    }
    fn params(&self) -> &'static [Param] {
        E::Program::PARAMS
    }
    fn inputs(&self) -> &'static [Input] {
        E::Program::INPUTS
    }
    fn is_for_meshes(&self) -> bool {
        E::IS_FOR_MESHES
    }
    fn is_for_lines(&self) -> bool {
        E::IS_FOR_LINES
    }
    fn paints(&self) -> Option<&'static [SampleInput]> {
        E::Program::PAINTS
    }
    fn wgsl(&self) -> &'static str {
        E::Program::WGSL
    }
    fn program(&self, values: &Values) -> Box<dyn LayerProgram> {
        let textures = E::Program::PARAMS.iter().filter_map(|param| {
            let ParamKind::Texture { repeats, .. } = param.kind else {
                return None;
            };
            Some((values.texture(param.name).clone(), repeats))
        });
        Box::new(WithParams::<E> {
            params: Varied::new(values),
            textures: textures.collect(),
        })
    }
}

struct WithParams<E: StrokeEffect> {
    params: Varied<E::Program>,
    /// By the number that their parameters have, and whether they repeat.
    textures: Vec<(Texture, bool)>,
}

impl<E: StrokeEffect> LayerProgram for WithParams<E> {
    fn instances(&self) -> u32 {
        E::instances(self.params.base()).max(1)
    }

    fn shortest(&self) -> f32 {
        E::shortest(self.params.base())
    }

    fn needs_point_light(&self) -> bool {
        E::needs_point_light(self.params.base())
    }

    fn follows_lines(&self) -> bool {
        let reads_rest = E::Program::INPUTS.contains(&Input::RestPosition);
        E::IS_FOR_LINES && reads_rest && E::follows_lines(&self.params.greatest())
    }

    fn has_own_paths(&self) -> bool {
        E::OWN_PATHS
    }

    fn is_on_undercoat(&self) -> bool {
        E::ON_UNDERCOAT
    }

    fn is_clump(&self) -> bool {
        E::IS_CLUMP
    }

    fn casts(&self) -> bool {
        E::CASTS
    }

    fn shadow_colors(&self) -> &'static [&'static str] {
        E::shadow_colors(self.params.base())
    }

    fn may_be_nearer(&self) -> bool {
        E::Program::MAY_BE_NEARER
    }

    fn reach(&self) -> Reach {
        E::reach(&self.params.greatest())
    }

    fn beyond(&self) -> Option<Reach> {
        E::beyond(&self.params.greatest())
    }

    fn make_paths(&self, hair: &Hair, seed: u32, paths: &mut MadePaths) {
        E::make_paths(self.params.base(), hair, seed, paths);
    }

    fn inputs(&self) -> InputSet {
        self.params.inputs()
    }

    fn source(&self) -> ProgramSource<'_> {
        let paint = E::Program::PAINTS.map(|inputs| PaintSource {
            inputs,
            places: E::Program::PLACES,
            textures: &self.textures,
        });
        ProgramSource {
            paint,
            ..self.params.source()
        }
    }

    fn extent(
        &self,
        joints: &Joints,
        range: Range<usize>,
        instance: u32,
        seed: u32,
    ) -> Range<usize> {
        if self.params.varies() || range.is_empty() {
            return range;
        }
        let of_strand = joints.seed.get(range.start);
        let strand = StrandJoints {
            joints,
            range: range.clone(),
            instance,
            seed: of_strand.map_or(0, |of_strand| hash(seed ^ of_strand)),
        };
        let extent = E::extent(self.params.base(), &strand);
        let start = extent.start.clamp(range.start, range.end);
        start..extent.end.clamp(start, range.end)
    }

    fn evaluate(
        &self,
        joints: &Joints,
        range: Range<usize>,
        instance: u32,
        seed: u32,
        strokes: &mut Strokes,
    ) {
        self.each(joints, range, instance, seed, strokes);
    }

    fn paints(&self) -> Option<SampleSet> {
        let own = SampleSet::of(E::Program::PAINTS?);
        Some(if self.params.varies() {
            own.union(SampleSet::of(&[SampleInput::U, SampleInput::Seed]))
        } else {
            own
        })
    }

    fn reads(&self) -> SampleSet {
        let declared = E::Program::PAINTS.unwrap_or_default().iter();
        let read = declared.filter(|input| E::reads(self.params.base(), **input));
        let read: Vec<SampleInput> = read.copied().collect();
        match self.params.varies() {
            true => self.paints().unwrap_or_default(),
            false => SampleSet::of(&read),
        }
    }

    fn paint_block(&self, samples: &SampleBlock, seed: u32, colors: &mut Vectors) {
        let params = self.params.base();
        let mut numbers = self.params.numbers();
        let varying = self.params.varies().then(|| {
            widest(
                #[inline(always)]
                || {
                    let (u, strand) = (&samples.u, samples.seed);
                    self.params.fill_at(&mut numbers, u, strand, seed);
                },
            );
            &numbers[..]
        });
        let mut texels = Texels::NOTHING;
        if E::Program::PLACES {
            let mut lookups = Lookups::NOTHING;
            widest(
                #[inline(always)]
                || {
                    E::Program::knowing_place(
                        params,
                        #[inline(always)]
                        |params| {
                            for_each_of_block::<E::Program>(
                                params,
                                varying,
                                #[inline(always)]
                                |i, params| {
                                    let lookup = E::Program::place(samples, i, seed, params);
                                    if let Some(lookup) = lookup {
                                        lookups.set(i, &lookup);
                                    }
                                },
                            );
                        },
                    );
                },
            );
            lookups.look_up(&self.textures, &mut texels);
        }
        widest(
            #[inline(always)]
            || {
                E::Program::knowing_paint(
                    params,
                    #[inline(always)]
                    |params| {
                        for_each_of_block::<E::Program>(
                            params,
                            varying,
                            #[inline(always)]
                            |i, params| {
                                let texel = texels.at(i);
                                let color = E::Program::paint(samples, i, seed, texel, params);
                                colors.set(i, color);
                            },
                        );
                    },
                );
            },
        );
    }

    fn radii(
        &self,
        joints: &Joints,
        range: Range<usize>,
        instance: u32,
        seed: u32,
        radii: &mut Vec<f32>,
    ) {
        self.each(joints, range, instance, seed, radii);
    }
}

impl<E: StrokeEffect> WithParams<E> {
    /// Appends what is taken of the strokes of these joints.
    fn each<T: Taken>(
        &self,
        joints: &Joints,
        range: Range<usize>,
        instance: u32,
        seed: u32,
        list: &mut T,
    ) {
        let params = self.params.base();
        let mut numbers = self.params.numbers();
        let mut taken = T::NOTHING;
        let blocks = (range.clone().step_by(LANES)).map(|i| i..range.end.min(i + LANES));
        widest(
            #[inline(always)]
            || {
                for block in blocks {
                    if self.params.varies() {
                        self.params.fill(&mut numbers, joints, block.start, seed);
                        let params = E::Program::with_numbers(params, &numbers);
                        E::Program::strokes(
                            joints,
                            block.clone(),
                            instance,
                            seed,
                            params,
                            #[inline(always)]
                            |lane, stroke| T::put(&mut taken, lane, stroke),
                        );
                    } else {
                        E::Program::knowing_stroke(
                            params,
                            #[inline(always)]
                            |params| {
                                E::Program::strokes(
                                    joints,
                                    block.clone(),
                                    instance,
                                    seed,
                                    #[inline(always)]
                                    |_| params.clone(),
                                    #[inline(always)]
                                    |lane, stroke| T::put(&mut taken, lane, stroke),
                                );
                            },
                        );
                    }
                    list.append(&taken, block.len());
                }
            },
        );
    }
}

/// Calls `each` with every sample of a block and its parameters, of which some may vary: then there are `numbers` of the samples.
#[inline(always)]
fn for_each_of_block<P: Parameters>(
    params: &P::Params,
    numbers: Option<&[[f32; BLOCK]]>,
    mut each: impl FnMut(usize, &P::Params),
) {
    let Some(numbers) = numbers else {
        for i in 0..BLOCK {
            each(i, params);
        }
        return;
    };
    let params = P::with_numbers(params, numbers);
    for i in 0..BLOCK {
        each(i, &params(i));
    }
}
