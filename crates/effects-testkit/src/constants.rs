//! What an effect's Rust reads is one number for all of a strand: a number that may vary along it would be read at the root alone.

use crate::hair::strands;
use crate::paths::{Path, made};
use crate::values::{defaults, extreme_values};
use effects::{AnyEffect, LayerProgram, ParamKind, Section as _, Values};

/// What an effect's Rust says of a layer.
#[derive(PartialEq)]
struct Said {
    instances: u32,
    shortest: f32,
    needs_point_light: bool,
    paths: Vec<Path>,
}

impl Said {
    fn by(program: &dyn LayerProgram) -> Result<Self, String> {
        let rest = strands();
        Ok(Self {
            instances: program.instances(),
            shortest: program.shortest(),
            needs_point_light: program.needs_point_light(),
            paths: match program.has_own_paths() {
                true => made(program, &rest, &rest)?,
                false => Vec::new(),
            },
        })
    }

    /// The function of which another answer was given.
    fn differs(&self, other: &Self) -> Option<&'static str> {
        let differences = [
            ("instances", self.instances != other.instances),
            ("shortest", self.shortest != other.shortest),
            (
                "needs_point_light",
                self.needs_point_light != other.needs_point_light,
            ),
            ("make_paths", self.paths != other.paths),
        ];
        let found = differences.into_iter().find(|(_, differs)| *differs);
        found.map(|(function, _)| function)
    }
}

pub(crate) fn check(effect: &dyn AnyEffect) -> Result<(), String> {
    let usual = Said::by(&*effect.program(&defaults(effect).values))?;
    for (index, param) in effect.params().iter().enumerate() {
        if !matches!(param.kind, ParamKind::Number { varies: true, .. }) {
            continue;
        }
        for value in extreme_values(&param.kind) {
            let mut values = Values::defaults(effect.params());
            values.set(index, value);
            // Extremes that make no paths are told of elsewhere.
            let Ok(said) = Said::by(&*effect.program(&values)) else {
                continue;
            };
            if let Some(function) = usual.differs(&said) {
                return Err(format!(
                    "`{}` may vary along the strand, and `{function}` reads it at the root alone: mark it `@constant` in `struct Params`",
                    param.name
                ));
            }
        }
    }
    Ok(())
}
