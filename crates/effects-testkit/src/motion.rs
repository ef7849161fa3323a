//! Nothing pops: each input runs through its range, and strokes follow without a jump.

use crate::hair;
use crate::joint::{InputValue, Joint};
use crate::strokes::evaluate;
use crate::values::some_instances;
use effects::wgsl::{Stroke, vec2, vec3};
use effects::{AnyEffect, Input, LayerProgram, Values};
use glam::{Quat, Vec3};

/// Moments of a motion that are looked at, before times between them are halved.
const MOMENTS: u32 = 64;
/// How often the time between two moments is halved.
const HALVINGS: u32 = 14;
/// Change of a stroke that is no jump yet, in parts of its clump, of a full colour, or of a twentieth of
/// the head's height in depth.
const SMALL: f32 = 0.02;

pub(crate) fn check(effect: &dyn AnyEffect, parameters: &[(&str, &str)]) -> Result<(), String> {
    let mut values = Values::defaults(effect.params());
    for (name, text) in parameters {
        (values.set_text(effect.id(), name, text)).map_err(|error| error.to_string())?;
    }
    let program = effect.program(&values);
    // A strand's id stays, and so does the seed that is made of it.
    let changes = |input: &Input| !matches!(input, Input::Strand | Input::Seed);
    for input in program.inputs().iter().filter(changes) {
        for joint in hair::joints().into_iter().step_by(29) {
            let motion = Motion { input, joint };
            for instance in some_instances(program.instances()) {
                motion.look_at(&*program, instance)?;
            }
        }
    }
    Ok(())
}

/// A joint of which one input moves through its range as time goes from 0 to 1.
struct Motion {
    input: Input,
    joint: Joint,
}

impl Motion {
    fn at(&self, time: f32) -> Joint {
        let mut joint = self.joint;
        let along = |low: f32, high: f32| InputValue::Number(low + (high - low) * time);
        let value = match (self.input, joint.get(self.input, 0)) {
            (Input::Position, InputValue::Triple(place)) => {
                let place = Vec3::from(place.to_array()) + (time - 0.5) * Vec3::new(0.4, 0.3, -0.5);
                InputValue::Triple(vec3(place.to_array()))
            }
            (Input::ClumpColor, _) => InputValue::Triple(vec3([time, 1.0 - time, 0.5])),
            (Input::ClumpRadius, _) => along(0.0, 40.0),
            (Input::ArcLength, _) => along(0.0, 1.0),
            (Input::LightDistance, _) => along(0.0, 10.0),
            (Input::Unit, _) => along(0.1, 5.0),
            (Input::Depth, _) => along(0.2, 20.0),
            (Input::Time, _) => along(0.0, 10.0),
            (Input::HeadHeight, _) => along(0.1, 0.4),
            (Input::StrandSize, _) => along(0.0, 40.0),
            // As the head and its hair move.
            (Input::HeadCenter | Input::StrandMean, InputValue::Triple(place)) => {
                let place = Vec3::from(place.to_array()) + time * Vec3::new(0.2, -0.1, 0.1);
                InputValue::Triple(vec3(place.to_array()))
            }
            // From end to end of a strand of 0.1 m.
            (Input::FromEnds, _) => InputValue::Pair(vec2([0.1 * time, 0.1 * (1.0 - time)])),
            // u and gray.
            (_, InputValue::Number(_)) => along(0.0, 1.0),
            // Directions go once around.
            (_, InputValue::Triple(direction)) => {
                let axis = Vec3::new(0.36, 0.48, 0.8);
                let turn = Quat::from_axis_angle(axis, std::f32::consts::TAU * time);
                InputValue::Triple(vec3((turn * Vec3::from(direction.to_array())).to_array()))
            }
            (_, InputValue::Pair(_)) => {
                let (sine, cosine) = (std::f32::consts::TAU * time).sin_cos();
                InputValue::Pair(vec2([cosine, sine]))
            }
            (_, InputValue::Whole(_)) => return joint,
        };
        joint.set(self.input, value);
        joint
    }

    fn stroke(&self, program: &dyn LayerProgram, instance: u32, time: f32) -> Stroke {
        evaluate(program, &[self.at(time)], instance)[0]
    }

    /// Finds jumps.
    fn look_at(&self, program: &dyn LayerProgram, instance: u32) -> Result<(), String> {
        let stroke = |time: f32| self.stroke(program, instance, time);
        for moment in 0..MOMENTS {
            let [mut start, mut end] = [moment, moment + 1].map(|m| m as f32 / MOMENTS as f32);
            for _ in 0..HALVINGS {
                if self.change(&stroke(start), &stroke(end)) <= SMALL {
                    break;
                }
                let middle = 0.5 * (start + end);
                let before = self.change(&stroke(start), &stroke(middle));
                if before > self.change(&stroke(middle), &stroke(end)) {
                    end = middle;
                } else {
                    start = middle;
                }
            }
            let (before, after) = (stroke(start), stroke(end));
            if self.change(&before, &after) > SMALL {
                return Err(self.tell(instance, [start, end], [before, after]));
            }
        }
        Ok(())
    }

    /// How far two strokes are apart to the eye.
    fn change(&self, a: &Stroke, b: &Stroke) -> f32 {
        let size = self.joint.clump_radius.max(1.0);
        let radius = (a.radius - b.radius).abs() / size;
        if a.radius <= 0.0 || b.radius <= 0.0 {
            return radius;
        }
        let offset = (a.offset.x - b.offset.x).hypot(a.offset.y - b.offset.y) / size;
        let depth = (a.depth_offset - b.depth_offset).abs() / 0.05;
        let colors = a.color.to_array().into_iter().zip(b.color.to_array());
        let color = colors.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        radius.max(offset).max(depth).max(color)
    }

    fn tell(&self, instance: u32, [start, end]: [f32; 2], strokes: [Stroke; 2]) -> String {
        let input = |time| match self.at(time).get(self.input, 0) {
            InputValue::Number(value) => value.to_string(),
            InputValue::Triple(value) => format!("{:?}", value.to_array()),
            InputValue::Pair(value) => format!("[{}, {}]", value.x, value.y),
            InputValue::Whole(value) => value.to_string(),
        };
        let stroke = |stroke: &Stroke| {
            let (x, y) = (stroke.offset.x, stroke.offset.y);
            let [red, green, blue] = stroke.color.to_array();
            format!(
                "radius {}, offset ({x}, {y}), depth offset {}, colour ({red}, {green}, {blue})",
                stroke.radius, stroke.depth_offset
            )
        };
        format!(
            "stroke {instance} jumps where `{}` goes from {} to {}:\n  {}\n  {}",
            self.input.name(),
            input(start),
            input(end),
            stroke(&strokes[0]),
            stroke(&strokes[1])
        )
    }
}
