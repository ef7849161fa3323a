//! What is declared is worked out for every joint: an input that nobody reads costs time for nothing.

use effects::AnyEffect;
use naga::proc::TypeResolution;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Expression, Handle, Module, Type, TypeInner};

pub(crate) fn check(effect: &dyn AnyEffect) -> Result<(), String> {
    let wrong = |message: String| format!("WGSL is not WGSL: {message}");
    let module = naga::front::wgsl::parse_str(effect.wgsl())
        .map_err(|error| wrong(error.emit_to_string(effect.wgsl())))?;
    let of_samples = match effect.is_for_meshes() {
        true => "`//! mesh:`",
        false => "`//! sample:`",
    };
    for (structure, of, line) in [
        ("Inputs", "joint", "`//! inputs:`"),
        ("Sample", "sample", of_samples),
    ] {
        let unread = unread(&module, structure).map_err(wrong)?;
        if !unread.is_empty() {
            return Err(format!(
                "{} declared and never read, and worked out for every {of}: take {} out of the line {line}",
                unread.join(", ") + if unread.len() == 1 { " is" } else { " are" },
                if unread.len() == 1 { "it" } else { "them" }
            ));
        }
    }
    Ok(())
}

/// The fields of a struct that no expression takes.
fn unread(module: &Module, structure: &str) -> Result<Vec<String>, String> {
    let mut types = module.types.iter();
    let Some((inputs, Type { inner, .. })) =
        types.find(|(_, ty)| ty.name.as_deref() == Some(structure))
    else {
        return Ok(Vec::new());
    };
    let TypeInner::Struct { members, .. } = inner else {
        return Ok(Vec::new());
    };
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(module)
        .map_err(|error| error.emit_to_string(""))?;
    let mut is_read = vec![false; members.len()];
    for (handle, function) in module.functions.iter() {
        for (_, expression) in function.expressions.iter() {
            let Expression::AccessIndex { base, index } = *expression else {
                continue;
            };
            if is_of(&info[handle][base].ty, inputs) {
                is_read[index as usize] = true;
            }
        }
    }
    let unread = members.iter().zip(is_read).filter(|(_, is_read)| !is_read);
    let name = |member: &naga::StructMember| member.name.clone().unwrap_or_default();
    Ok(unread
        .map(|(member, _)| format!("`{}`", name(member)))
        .collect())
}

/// Whether an expression is the struct of that type, or a pointer to one.
fn is_of(ty: &TypeResolution, structure: Handle<Type>) -> bool {
    match ty {
        TypeResolution::Handle(handle) => *handle == structure,
        TypeResolution::Value(TypeInner::Pointer { base, .. }) => *base == structure,
        TypeResolution::Value(_) => false,
    }
}
