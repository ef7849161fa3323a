//! A sample with all that samples offer, lists of them as an effect gets them, and samples to try effects with.

use crate::hair;
use crate::joint::{InputValue, Joint};
use effects::wgsl::{hash, vec3};
use effects::{SampleInput, SampleSet, Samples};

/// Makes [`Sample`] of the table of inputs. An input without a value in [`samples`] doesn't compile: every one must be tried.
macro_rules! inputs {
    ($($(#[$doc:meta])* $input:ident $name:ident: $ty:ty,)*) => {
        /// One sample. Names, types and units are those of [`Samples`].
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct Sample {
            $(pub $name: $ty,)*
        }

        impl Sample {
            /// The input's value in WGSL. `seed` is the layer's.
            pub fn get(&self, input: SampleInput, seed: u32) -> InputValue {
                if input == SampleInput::Seed {
                    return hash(seed ^ self.seed).into();
                }
                match input {
                    $(SampleInput::$input => self.$name.into(),)*
                }
            }
        }

        /// These samples for an effect that reads `read`: lists that it does not declare are empty.
        pub(crate) fn list(samples: &[Sample], read: SampleSet) -> Samples {
            let mut lists = Samples::default();
            $(if read.has(SampleInput::$input) {
                lists.$name = samples.iter().map(|sample| sample.$name).collect();
            })*
            lists
        }
    };
}

effects::for_each_sample_input!(inputs);

/// Samples on a head of hair, from side to side of each joint's clump.
pub(crate) fn samples() -> Vec<Sample> {
    let across = [-1.0, -0.4, 0.0, 0.7];
    let joints = hair::joints().into_iter().step_by(5);
    joints
        .flat_map(|joint| across.map(|w| sample(&joint, w)))
        .collect()
}

/// A sample beside a joint, at `w` across its clump.
fn sample(joint: &Joint, w: f32) -> Sample {
    let view = joint.view_direction;
    let [x, y, z] = joint.forward.to_array();
    let side = glam::Vec3::new(x, y, z).cross(glam::Vec3::from(view.to_array()));
    let side = side.normalize_or(glam::Vec3::X);
    let facing = (1.0 - w * w).max(0.0).sqrt();
    let tube = w * side + facing * glam::Vec3::from(view.to_array());
    Sample {
        color: joint.clump_color,
        shade_color: vec3(joint.clump_color.to_array().map(|x| 0.6 * x)),
        occlusion: (0.5 * w).max(0.0),
        position: joint.position,
        forward: joint.forward,
        normal: joint.normal,
        tube: vec3(tube.normalize_or(glam::Vec3::Z).to_array()),
        u: joint.u,
        s: joint.arc_length / hair::HEAD_M,
        v: 0.9 * w,
        w,
        strand: joint.strand,
        seed: joint.seed,
        level: joint.strand % 3,
        depth: joint.depth,
        head_depth: 6.0,
        light_direction: joint.light_direction,
        light_distance: joint.light_distance,
        view_direction: view,
        pixels: 400.0,
        time: joint.time,
    }
}

/// Samples that break what counts on good ones, each with what is bad about it.
pub(crate) fn hostile_samples() -> Vec<(&'static str, Sample)> {
    let of_joints = hair::hostile_joints().into_iter();
    let mut samples: Vec<_> = of_joints
        .map(|(what, joint)| (what, sample(&joint, 0.3)))
        .collect();
    let good = samples[0].1;
    let up = vec3([0.0, 1.0, 0.0]);
    samples.extend([
        (
            "a sample at a stroke's edge",
            Sample {
                v: 1.0,
                w: 1.0,
                ..good
            },
        ),
        ("a stroke wider than its clump", Sample { w: -8.0, ..good }),
        (
            "normals against each other",
            Sample {
                normal: up,
                tube: -up,
                ..good
            },
        ),
        (
            "light from behind the eye's place",
            Sample {
                light_direction: -good.view_direction,
                ..good
            },
        ),
        (
            "what no light reaches",
            Sample {
                occlusion: 1.0,
                ..good
            },
        ),
        (
            "a head at the eye",
            Sample {
                depth: 0.0,
                head_depth: 0.0,
                ..good
            },
        ),
        (
            "a head as large as a pixel",
            Sample {
                pixels: 1.0,
                ..good
            },
        ),
        (
            "a black stroke",
            Sample {
                color: vec3([0.0; 3]),
                ..good
            },
        ),
    ]);
    samples
}
