//! `inkstrand effects`: what there is to build a look from.

use crate::Failure;
use effects::preset::nearest;
use effects::{AnyEffect, Param, ParamKind, Registry};

pub(crate) fn effects(id: Option<&str>, registry: &Registry) -> Result<(), Failure> {
    match id {
        None => {
            list(registry);
            Ok(())
        }
        Some(id) => match registry.get(id) {
            Some(effect) => {
                describe(effect);
                Ok(())
            }
            None => Err(Failure::Usage(unknown(id, registry))),
        },
    }
}

fn unknown(id: &str, registry: &Registry) -> String {
    let ids: Vec<&str> = registry.iter().map(AnyEffect::id).collect();
    match nearest(id, ids.iter().copied()) {
        Some(near) => format!("there is no effect `{id}`, did you mean `{near}`?"),
        None => format!("there is no effect `{id}`; there are: {}", ids.join(", ")),
    }
}

fn list(registry: &Registry) {
    let mut effects: Vec<&dyn AnyEffect> = registry.iter().collect();
    effects.sort_by_key(|effect| (effect.rank(), effect.id()));
    println!(
        "{:<20} {:>5} {:>13}  what it draws",
        "effect", "rank", "depth_offset"
    );
    for effect in effects {
        println!(
            "{:<20} {:>5} {:>13}  {}",
            effect.id(),
            effect.rank(),
            effect.depth_offset(),
            effect.doc()
        );
    }
}

fn describe(effect: &dyn AnyEffect) {
    println!("{}: {}", effect.id(), effect.doc());
    println!(
        "rank {}, depth_offset {} head heights",
        effect.rank(),
        effect.depth_offset()
    );
    for param in effect.params() {
        println!();
        println!("  {}: {}", param.name, param.kind.expected());
        println!("      default {}{}", default(param), unit(param));
        println!("      {}", param.doc);
    }
}

fn unit(param: &Param) -> String {
    if param.unit.is_empty() {
        String::new()
    } else {
        format!("; unit: {}", param.unit)
    }
}

/// A parameter's default as a preset would write it.
fn default(param: &Param) -> String {
    match param.kind {
        ParamKind::Number { default, .. } => default.to_string(),
        ParamKind::Integer { default, .. } => default.to_string(),
        ParamKind::Choice { names, default } => names[default].to_owned(),
        ParamKind::Color { default } => format!("\"{default}\""),
        ParamKind::OptionalColor { default: Some(hex) } => format!("\"{hex}\""),
        ParamKind::OptionalColor { default: None } | ParamKind::Text => "none".to_owned(),
        ParamKind::Triple {
            default: [x, y, z], ..
        } => format!("({x}, {y}, {z})"),
        ParamKind::Size {
            default: [w, h], ..
        } => format!("({w}, {h})"),
    }
}
