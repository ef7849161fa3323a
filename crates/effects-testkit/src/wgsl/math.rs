//! Operators and builtin functions of WGSL, by its specification (W3C, "WebGPU Shading Language",
//! chapters 8 and 17). Where it leaves the order of a sum open, from left to right.

use super::value::{Value, each};
use Value::{Bool, F32, I32, List, U32};
use naga::{BinaryOperator as Op, MathFunction as Fun, ScalarKind, UnaryOperator};

pub(crate) fn unary(op: UnaryOperator, value: &Value) -> Result<Value, String> {
    each([value], &|[value]| {
        Ok(match (op, value) {
            (UnaryOperator::Negate, F32(a)) => F32(-a),
            (UnaryOperator::Negate, I32(a)) => I32(a.wrapping_neg()),
            (UnaryOperator::LogicalNot, Bool(a)) => Bool(!a),
            (UnaryOperator::BitwiseNot, U32(a)) => U32(!a),
            (UnaryOperator::BitwiseNot, I32(a)) => I32(!a),
            _ => return Err(format!("{op:?} of {value:?}")),
        })
    })
}

pub(crate) fn binary(op: Op, left: &Value, right: &Value) -> Result<Value, String> {
    each([left, right], &|[left, right]| {
        Ok(match (left, right) {
            (F32(a), F32(b)) => float(op, *a, *b).ok_or(unknown(op))?,
            (U32(a), U32(b)) => whole(op, *a, *b).ok_or(unknown(op))?,
            (I32(a), I32(b)) => signed(op, *a, *b).ok_or(unknown(op))?,
            (I32(a), U32(b)) if op == Op::ShiftLeft => I32(a.wrapping_shl(*b)),
            (I32(a), U32(b)) if op == Op::ShiftRight => I32(a.wrapping_shr(*b)),
            (Bool(a), Bool(b)) => Bool(match op {
                Op::LogicalAnd | Op::And => a & b,
                Op::LogicalOr | Op::InclusiveOr => a | b,
                Op::ExclusiveOr | Op::NotEqual => a ^ b,
                Op::Equal => a == b,
                _ => return Err(unknown(op)),
            }),
            _ => return Err(format!("{op:?} of {left:?} and {right:?}")),
        })
    })
}

fn unknown(op: Op) -> String {
    format!("{op:?} is not known here")
}

fn float(op: Op, a: f32, b: f32) -> Option<Value> {
    Some(match op {
        Op::Add => F32(a + b),
        Op::Subtract => F32(a - b),
        Op::Multiply => F32(a * b),
        Op::Divide => F32(a / b),
        Op::Modulo => F32(a % b),
        _ => Bool(compare(op, &a, &b)?),
    })
}

fn whole(op: Op, a: u32, b: u32) -> Option<Value> {
    Some(match op {
        Op::Add => U32(a.wrapping_add(b)),
        Op::Subtract => U32(a.wrapping_sub(b)),
        Op::Multiply => U32(a.wrapping_mul(b)),
        // By zero: the number itself, and nothing left.
        Op::Divide => U32(a.checked_div(b).unwrap_or(a)),
        Op::Modulo => U32(a.checked_rem(b).unwrap_or(0)),
        Op::And => U32(a & b),
        Op::InclusiveOr => U32(a | b),
        Op::ExclusiveOr => U32(a ^ b),
        Op::ShiftLeft => U32(a.wrapping_shl(b)),
        Op::ShiftRight => U32(a.wrapping_shr(b)),
        _ => Bool(compare(op, &a, &b)?),
    })
}

fn signed(op: Op, a: i32, b: i32) -> Option<Value> {
    Some(match op {
        Op::Add => I32(a.wrapping_add(b)),
        Op::Subtract => I32(a.wrapping_sub(b)),
        Op::Multiply => I32(a.wrapping_mul(b)),
        Op::Divide => I32(a.checked_div(b).unwrap_or(a)),
        Op::Modulo => I32(a.checked_rem(b).unwrap_or(0)),
        Op::And => I32(a & b),
        Op::InclusiveOr => I32(a | b),
        Op::ExclusiveOr => I32(a ^ b),
        _ => Bool(compare(op, &a, &b)?),
    })
}

fn compare<T: PartialOrd>(op: Op, a: &T, b: &T) -> Option<bool> {
    Some(match op {
        Op::Equal => a == b,
        Op::NotEqual => a != b,
        Op::Less => a < b,
        Op::LessEqual => a <= b,
        Op::Greater => a > b,
        Op::GreaterEqual => a >= b,
        _ => return None,
    })
}

pub(crate) fn select(condition: &Value, accept: &Value, reject: &Value) -> Result<Value, String> {
    match condition {
        Bool(true) => Ok(accept.clone()),
        Bool(false) => Ok(reject.clone()),
        _ => each([condition, accept, reject], &|[
            condition,
            accept,
            reject,
        ]| {
            select(condition, accept, reject)
        }),
    }
}

/// A scalar, or each of a vector's, as another type of scalar.
pub(crate) fn convert(value: &Value, kind: ScalarKind) -> Result<Value, String> {
    each([value], &|[value]| {
        Ok(match (kind, value) {
            (ScalarKind::Float, F32(a)) => F32(*a),
            (ScalarKind::Float, U32(a)) => F32(*a as f32),
            (ScalarKind::Float, I32(a)) => F32(*a as f32),
            (ScalarKind::Float, Bool(a)) => F32(u8::from(*a).into()),
            (ScalarKind::Uint, F32(a)) => U32(*a as u32),
            (ScalarKind::Uint, U32(a)) => U32(*a),
            (ScalarKind::Uint, I32(a)) => U32(*a as u32),
            (ScalarKind::Uint, Bool(a)) => U32((*a).into()),
            (ScalarKind::Sint, F32(a)) => I32(*a as i32),
            (ScalarKind::Sint, U32(a)) => I32(*a as i32),
            (ScalarKind::Sint, I32(a)) => I32(*a),
            (ScalarKind::Sint, Bool(a)) => I32((*a).into()),
            (ScalarKind::Bool, F32(a)) => Bool(*a != 0.0),
            (ScalarKind::Bool, U32(a)) => Bool(*a != 0),
            (ScalarKind::Bool, I32(a)) => Bool(*a != 0),
            (ScalarKind::Bool, Bool(a)) => Bool(*a),
            _ => return Err(format!("{value:?} as {kind:?}")),
        })
    })
}

/// A `bitcast` between numbers and their bits.
pub(crate) fn bits(value: &Value, kind: ScalarKind) -> Result<Value, String> {
    match (kind, value) {
        (ScalarKind::Uint, F32(a)) => Ok(U32(a.to_bits())),
        (ScalarKind::Float, U32(a)) => Ok(F32(f32::from_bits(*a))),
        _ => Err(format!("{value:?} as the bits of {kind:?}")),
    }
}

/// A builtin function.
pub(crate) fn call(fun: Fun, arguments: &[Value]) -> Result<Value, String> {
    let wrong = || format!("{fun:?} of {arguments:?} is not known here");
    match (fun, arguments) {
        (Fun::Dot, [a, b]) => dot(a, b).map(F32),
        (Fun::Length, [F32(a)]) => Ok(F32(a.abs())),
        (Fun::Length, [a]) => Ok(F32(dot(a, a)?.sqrt())),
        (Fun::Distance, [a, b]) => {
            let difference = binary(Op::Subtract, a, b)?;
            call(Fun::Length, &[difference])
        }
        (Fun::Normalize, [a]) => binary(Op::Divide, a, &F32(dot(a, a)?.sqrt())),
        (Fun::Cross, [a, b]) => match (&a.numbers()[..], &b.numbers()[..]) {
            (&[ax, ay, az], &[bx, by, bz]) => {
                let [x, y, z] = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
                Ok(Value::list([x, y, z]))
            }
            _ => Err(wrong()),
        },
        (_, [a]) => each([a], &|[a]| one(fun, a).ok_or_else(wrong)),
        (_, [a, b]) => each([a, b], &|[a, b]| two(fun, a, b).ok_or_else(wrong)),
        (_, [a, b, c]) => each([a, b, c], &|[a, b, c]| {
            three(fun, a, b, c).ok_or_else(wrong)
        }),
        _ => Err(wrong()),
    }
}

fn dot(a: &Value, b: &Value) -> Result<f32, String> {
    match (a, b) {
        (List(_), List(_)) => {
            let pairs = a.numbers().into_iter().zip(b.numbers());
            let products = pairs.map(|(a, b)| a * b);
            products
                .reduce(|sum, product| sum + product)
                .ok_or_else(|| "a dot of nothing".to_owned())
        }
        _ => Err(format!("a dot of {a:?} and {b:?}")),
    }
}

fn one(fun: Fun, a: &Value) -> Option<Value> {
    Some(match (fun, a) {
        (Fun::Abs, F32(a)) => F32(a.abs()),
        (Fun::Abs, I32(a)) => I32(a.wrapping_abs()),
        (Fun::Abs, U32(a)) => U32(*a),
        (Fun::Sign, F32(a)) if *a == 0.0 => F32(0.0),
        (Fun::Sign, F32(a)) => F32(a.signum()),
        (Fun::Sign, I32(a)) => I32(a.signum()),
        (Fun::Saturate, F32(a)) => F32(a.clamp(0.0, 1.0)),
        (Fun::Ceil, F32(a)) => F32(a.ceil()),
        (Fun::Floor, F32(a)) => F32(a.floor()),
        (Fun::Trunc, F32(a)) => F32(a.trunc()),
        (Fun::Sqrt, F32(a)) => F32(a.sqrt()),
        _ => return None,
    })
}

fn two(fun: Fun, a: &Value, b: &Value) -> Option<Value> {
    Some(match (fun, a, b) {
        (Fun::Min, F32(a), F32(b)) => F32(a.min(*b)),
        (Fun::Min, U32(a), U32(b)) => U32(*a.min(b)),
        (Fun::Min, I32(a), I32(b)) => I32(*a.min(b)),
        (Fun::Max, F32(a), F32(b)) => F32(a.max(*b)),
        (Fun::Max, U32(a), U32(b)) => U32(*a.max(b)),
        (Fun::Max, I32(a), I32(b)) => I32(*a.max(b)),
        _ => return None,
    })
}

fn three(fun: Fun, a: &Value, b: &Value, c: &Value) -> Option<Value> {
    Some(match (fun, a, b, c) {
        (Fun::Clamp, x, low, high) => two(Fun::Min, &two(Fun::Max, x, low)?, high)?,
        (Fun::Mix, F32(a), F32(b), F32(t)) => F32(a * (1.0 - t) + b * t),
        (Fun::SmoothStep, F32(low), F32(high), F32(x)) => {
            let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
            F32(t * t * (3.0 - 2.0 * t))
        }
        _ => return None,
    })
}
