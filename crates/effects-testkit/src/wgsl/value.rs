//! Values of WGSL.

/// A value: a scalar, or a list of them (vector, struct, array), or a place in a local variable.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    F32(f32),
    U32(u32),
    I32(i32),
    Bool(bool),
    List(Vec<Value>),
    /// A local variable's index, and the way to a part of it.
    Pointer(usize, Vec<usize>),
}

impl Value {
    pub fn list<const N: usize>(numbers: [f32; N]) -> Self {
        Self::List(numbers.map(Self::F32).to_vec())
    }

    /// All numbers in it, in their order.
    pub fn numbers(&self) -> Vec<f32> {
        match self {
            Self::F32(number) => vec![*number],
            Self::List(values) => values.iter().flat_map(Self::numbers).collect(),
            _ => Vec::new(),
        }
    }

    pub fn part(&self, index: usize) -> Result<Self, String> {
        match self {
            Self::List(values) => {
                // WGSL: an index out of bounds is some index in bounds.
                let part = values.get(index).or(values.last());
                part.cloned().ok_or_else(|| "a part of nothing".to_owned())
            }
            Self::Pointer(variable, way) => {
                let way = way.iter().copied().chain([index]).collect();
                Ok(Self::Pointer(*variable, way))
            }
            other => Err(format!("a part of {other:?}")),
        }
    }

    /// The part at the end of this way, to change.
    pub fn part_mut(&mut self, way: &[usize]) -> Result<&mut Self, String> {
        let Some((first, rest)) = way.split_first() else {
            return Ok(self);
        };
        match self {
            Self::List(values) => {
                let part = values.get_mut(*first).ok_or("an index out of bounds")?;
                part.part_mut(rest)
            }
            other => Err(format!("a part of {other:?}")),
        }
    }

    pub fn bool(&self) -> Result<bool, String> {
        match self {
            Self::Bool(value) => Ok(*value),
            other => Err(format!("a condition is {other:?}")),
        }
    }

    pub fn index(&self) -> Result<usize, String> {
        match self {
            Self::U32(value) => Ok(*value as usize),
            Self::I32(value) => Ok(usize::try_from(*value).unwrap_or_default()),
            other => Err(format!("an index is {other:?}")),
        }
    }
}

/// Applies a function of scalars to scalars, or component by component to lists; scalars beside lists
/// count for every component.
pub(crate) fn each<const N: usize>(
    values: [&Value; N],
    apply: &impl Fn([&Value; N]) -> Result<Value, String>,
) -> Result<Value, String> {
    let length = values.iter().find_map(|value| match value {
        Value::List(parts) => Some(parts.len()),
        _ => None,
    });
    let Some(length) = length else {
        return apply(values);
    };
    let component = |i: usize| {
        let parts = values.map(|value| match value {
            Value::List(parts) => &parts[i.min(parts.len() - 1)],
            scalar => scalar,
        });
        each(parts, apply)
    };
    Ok(Value::List(
        (0..length).map(component).collect::<Result<_, _>>()?,
    ))
}
