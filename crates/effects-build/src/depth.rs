//! Whether an effect moves its strokes nearer than their layer is, as its WGSL tells.

use crate::check::named_type;
use naga::{Arena, Expression, Handle, Literal, Module, Type, TypeInner};

/// Place of `depth_offset` among the fields of `struct Stroke`.
const FIELD: usize = 2;

/// Whether a stroke may have a `depth_offset` below 0: whether any is made with another than a written number that isn't.
pub(crate) fn may_be_nearer(module: &Module) -> bool {
    let Some(stroke) = named_type(module, "Stroke") else {
        return true;
    };
    let is_no_nearer = |expressions: &Arena<Expression>| {
        expressions.iter().all(|(_, expression)| match expression {
            Expression::Compose { ty, components } if *ty == stroke => {
                let offset = components.get(FIELD).map(|field| &expressions[*field]);
                matches!(offset, Some(Expression::Literal(Literal::F32(offset))) if *offset >= 0.0)
            }
            _ => true,
        })
    };
    // A variable's fields may be set one by one.
    let has_variable = |function: &naga::Function| {
        let mut variables = function.local_variables.iter();
        variables.any(|(_, variable)| holds(module, variable.ty, stroke))
    };
    let all = || module.functions.iter().map(|(_, function)| function);
    all().any(has_variable)
        || !all().all(|function| is_no_nearer(&function.expressions))
        || !is_no_nearer(&module.global_expressions)
}

/// Whether a type is that of strokes, or has such in it.
fn holds(module: &Module, ty: Handle<Type>, stroke: Handle<Type>) -> bool {
    ty == stroke
        || match &module.types[ty].inner {
            TypeInner::Array { base, .. } => holds(module, *base, stroke),
            TypeInner::Struct { members, .. } => members
                .iter()
                .any(|member| holds(module, member.ty, stroke)),
            _ => false,
        }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::compose::{Entry, compose};

    /// Of an effect whose function `stroke` has that body.
    fn of(body: &str) -> bool {
        let text = format!(
            "//! inputs: clump_radius\nstruct Params {{\n/// A width.\n/// @range 0..1 @default 0.5\nwidth: f32 }}\n\
             fn line(radius: f32) -> Stroke {{ return Stroke(vec2<f32>(0.0), radius, 0.0, vec3<f32>(0.0)); }}\n\
             fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {{ {body} }}"
        );
        let source = compose(&text, "src/line.wgsl", None, Entry::Effect).unwrap();
        may_be_nearer(&check::parse(&source).unwrap().0)
    }

    #[test]
    fn only_written_numbers_are_known() {
        let made =
            |depth: &str| format!("return Stroke(vec2<f32>(0.0), 1.0, {depth}, vec3<f32>(0.0));");
        assert!(!of("return line(joint.clump_radius);"));
        assert!(!of(&made("0.0")) && !of(&made("0.25")));
        assert!(!of(&format!(
            "if (instance > 1u) {{ {} }} return line(2.0);",
            made("0.0")
        )));
        assert!(of(&made("-0.25")) && of(&made("params.width")));
        assert!(of(&format!(
            "if (instance > 1u) {{ {} }} return line(2.0);",
            made("params.width")
        )));
        assert!(of(
            "var made = line(1.0); made.depth_offset = -params.width; return made;"
        ));
        assert!(of(
            "var made: array<Stroke, 2>; made[0] = line(1.0); made[0].depth_offset = -params.width; return made[0];"
        ));
    }
}
