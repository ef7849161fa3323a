//! Functions of a WGSL module, statement by statement.

use super::math;
use super::value::Value;
use naga::{
    Block, Expression, Function, Handle, Literal, Module, RelationalFunction, Statement,
    SwitchValue, Type, TypeInner,
};

/// Rounds of a loop, at most: an effect's joint must not take forever.
const MOST_ROUNDS: usize = 100_000;

pub(crate) struct Interpreter<'m> {
    module: &'m Module,
}

/// What a block's end leads to.
enum Flow {
    On,
    Break,
    Continue,
    Return(Option<Value>),
}

/// A call of a function.
struct Call<'m> {
    interpreter: &'m Interpreter<'m>,
    function: &'m Function,
    arguments: &'m [Value],
    variables: Vec<Value>,
    /// The values of expressions that were worked out, by their handles' indices.
    values: Vec<Option<Value>>,
}

impl<'m> Interpreter<'m> {
    pub fn new(module: &'m Module) -> Self {
        Self { module }
    }

    /// Calls the function of this name.
    pub fn call(&self, name: &str, arguments: &[Value]) -> Result<Value, String> {
        let mut functions = self.module.functions.iter().map(|(_, function)| function);
        let function = functions
            .find(|function| function.name.as_deref() == Some(name))
            .ok_or_else(|| format!("WGSL has no function `{name}`"))?;
        self.run(function, arguments)?
            .ok_or_else(|| format!("`{name}` returns nothing"))
    }

    fn run(&self, function: &Function, arguments: &[Value]) -> Result<Option<Value>, String> {
        let mut call = Call {
            interpreter: self,
            function,
            arguments,
            variables: Vec::new(),
            values: vec![None; function.expressions.len()],
        };
        for (_, variable) in function.local_variables.iter() {
            let value = match variable.init {
                Some(init) => call.value(init)?,
                None => self.zero(variable.ty)?,
            };
            call.variables.push(value);
        }
        match call.block(&function.body)? {
            Flow::Return(value) => Ok(value),
            _ => Ok(None),
        }
    }

    fn zero(&self, ty: Handle<Type>) -> Result<Value, String> {
        match &self.module.types[ty].inner {
            TypeInner::Scalar(scalar) => zero_scalar(*scalar),
            TypeInner::Vector { size, scalar } => {
                Ok(Value::List(vec![zero_scalar(*scalar)?; *size as usize]))
            }
            TypeInner::Struct { members, .. } => {
                let members = members.iter().map(|member| self.zero(member.ty));
                Ok(Value::List(members.collect::<Result<_, _>>()?))
            }
            TypeInner::Array {
                base,
                size: naga::ArraySize::Constant(size),
                ..
            } => Ok(Value::List(vec![self.zero(*base)?; size.get() as usize])),
            other => Err(format!("{other:?} is not known here")),
        }
    }

    /// A constant's value.
    fn constant(&self, handle: Handle<Expression>) -> Result<Value, String> {
        match &self.module.global_expressions[handle] {
            Expression::Literal(literal) => literal_value(*literal),
            Expression::Constant(constant) => self.constant(self.module.constants[*constant].init),
            Expression::ZeroValue(ty) => self.zero(*ty),
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|part| self.constant(*part));
                self.compose(*ty, parts.collect::<Result<_, _>>()?)
            }
            Expression::Splat { size, value } => {
                Ok(Value::List(vec![self.constant(*value)?; *size as usize]))
            }
            other => Err(format!("the constant {other:?} is not known here")),
        }
    }

    /// Vectors are made of numbers and of shorter vectors; all else of its members.
    fn compose(&self, ty: Handle<Type>, parts: Vec<Value>) -> Result<Value, String> {
        if !matches!(self.module.types[ty].inner, TypeInner::Vector { .. }) {
            return Ok(Value::List(parts));
        }
        let flat = parts.into_iter().flat_map(|part| match part {
            Value::List(parts) => parts,
            scalar => vec![scalar],
        });
        Ok(Value::List(flat.collect()))
    }
}

impl Call<'_> {
    fn block(&mut self, block: &Block) -> Result<Flow, String> {
        for statement in block {
            match self.statement(statement)? {
                Flow::On => {}
                flow => return Ok(flow),
            }
        }
        Ok(Flow::On)
    }

    fn statement(&mut self, statement: &Statement) -> Result<Flow, String> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    let value = self.work_out(handle)?;
                    self.values[handle.index()] = Some(value);
                }
            }
            Statement::Block(block) => return self.block(block),
            Statement::If {
                condition,
                accept,
                reject,
            } => {
                let branch = if self.value(*condition)?.bool()? {
                    accept
                } else {
                    reject
                };
                return self.block(branch);
            }
            Statement::Switch { selector, cases } => return self.switch(*selector, cases),
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => {
                return self.repeat(body, continuing, *break_if);
            }
            Statement::Break => return Ok(Flow::Break),
            Statement::Continue => return Ok(Flow::Continue),
            Statement::Return { value } => {
                let value = value.map(|value| self.value(value)).transpose()?;
                return Ok(Flow::Return(value));
            }
            Statement::Store { pointer, value } => {
                let value = self.value(*value)?;
                let Value::Pointer(variable, way) = self.value(*pointer)? else {
                    return Err("a store to no variable".to_owned());
                };
                *self.variables[variable].part_mut(&way)? = value;
            }
            Statement::Call {
                function,
                arguments,
                result,
            } => {
                let arguments = arguments.iter().map(|argument| self.value(*argument));
                let arguments: Vec<Value> = arguments.collect::<Result<_, _>>()?;
                let function = &self.interpreter.module.functions[*function];
                let returned = self.interpreter.run(function, &arguments)?;
                if let Some(result) = result {
                    self.values[result.index()] = returned;
                }
            }
            other => return Err(format!("{other:?} is not known here")),
        }
        Ok(Flow::On)
    }

    fn switch(
        &mut self,
        selector: Handle<Expression>,
        cases: &[naga::SwitchCase],
    ) -> Result<Flow, String> {
        let selector = self.value(selector)?;
        let is_chosen = |case: &naga::SwitchCase| match case.value {
            SwitchValue::I32(value) => selector == Value::I32(value),
            SwitchValue::U32(value) => selector == Value::U32(value),
            SwitchValue::Default => false,
        };
        let is_default = |case: &naga::SwitchCase| case.value == SwitchValue::Default;
        let chosen = cases.iter().position(is_chosen);
        let Some(first) = chosen.or_else(|| cases.iter().position(is_default)) else {
            return Ok(Flow::On);
        };
        for case in &cases[first..] {
            match self.block(&case.body)? {
                Flow::On if case.fall_through => {}
                Flow::On | Flow::Break => return Ok(Flow::On),
                flow => return Ok(flow),
            }
        }
        Ok(Flow::On)
    }

    fn repeat(
        &mut self,
        body: &Block,
        continuing: &Block,
        break_if: Option<Handle<Expression>>,
    ) -> Result<Flow, String> {
        for _ in 0..MOST_ROUNDS {
            match self.block(body)? {
                Flow::Break => return Ok(Flow::On),
                Flow::Return(value) => return Ok(Flow::Return(value)),
                Flow::On | Flow::Continue => {}
            }
            self.block(continuing)?;
            if let Some(condition) = break_if
                && self.value(condition)?.bool()?
            {
                return Ok(Flow::On);
            }
        }
        Err(format!("a loop goes on for more than {MOST_ROUNDS} rounds"))
    }

    /// An expression's value, worked out before or constant.
    fn value(&mut self, handle: Handle<Expression>) -> Result<Value, String> {
        match &self.values[handle.index()] {
            Some(value) => Ok(value.clone()),
            None => self.work_out(handle),
        }
    }

    fn work_out(&mut self, handle: Handle<Expression>) -> Result<Value, String> {
        let interpreter = self.interpreter;
        let function = self.function;
        match &function.expressions[handle] {
            Expression::Literal(literal) => literal_value(*literal),
            Expression::Constant(constant) => {
                interpreter.constant(interpreter.module.constants[*constant].init)
            }
            Expression::ZeroValue(ty) => interpreter.zero(*ty),
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|part| self.value(*part));
                let parts = parts.collect::<Result<_, _>>()?;
                interpreter.compose(*ty, parts)
            }
            Expression::Access { base, index } => {
                let index = self.value(*index)?.index()?;
                self.value(*base)?.part(index)
            }
            Expression::AccessIndex { base, index } => self.value(*base)?.part(*index as usize),
            Expression::Splat { size, value } => {
                Ok(Value::List(vec![self.value(*value)?; *size as usize]))
            }
            Expression::Swizzle {
                size,
                vector,
                pattern,
            } => {
                let vector = self.value(*vector)?;
                let parts = pattern[..*size as usize]
                    .iter()
                    .map(|c| vector.part(*c as usize));
                Ok(Value::List(parts.collect::<Result<_, _>>()?))
            }
            Expression::FunctionArgument(index) => Ok(self.arguments[*index as usize].clone()),
            Expression::LocalVariable(variable) => Ok(Value::Pointer(variable.index(), Vec::new())),
            Expression::Load { pointer } => {
                let Value::Pointer(variable, way) = self.value(*pointer)? else {
                    return Err("a load from no variable".to_owned());
                };
                Ok(self.variables[variable].part_mut(&way)?.clone())
            }
            Expression::Unary { op, expr } => math::unary(*op, &self.value(*expr)?),
            Expression::Binary { op, left, right } => {
                math::binary(*op, &self.value(*left)?, &self.value(*right)?)
            }
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let [accept, reject] = [self.value(*accept)?, self.value(*reject)?];
                math::select(&self.value(*condition)?, &accept, &reject)
            }
            Expression::Relational { fun, argument } => {
                let argument = self.value(*argument)?;
                relational(*fun, &argument)
            }
            Expression::Math {
                fun,
                arg,
                arg1,
                arg2,
                arg3,
            } => {
                let arguments = [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten();
                let arguments: Result<Vec<_>, _> = arguments.map(|a| self.value(a)).collect();
                math::call(*fun, &arguments?)
            }
            Expression::As {
                expr,
                kind,
                convert: Some(_),
            } => math::convert(&self.value(*expr)?, *kind),
            Expression::As {
                expr,
                kind,
                convert: None,
            } => math::bits(&self.value(*expr)?, *kind),
            other => Err(format!("{other:?} is not known here")),
        }
    }
}

fn relational(fun: RelationalFunction, argument: &Value) -> Result<Value, String> {
    let parts = match argument {
        Value::List(parts) => parts
            .iter()
            .map(Value::bool)
            .collect::<Result<Vec<_>, _>>()?,
        scalar => vec![scalar.bool()?],
    };
    match fun {
        RelationalFunction::All => Ok(Value::Bool(parts.iter().all(|part| *part))),
        RelationalFunction::Any => Ok(Value::Bool(parts.iter().any(|part| *part))),
        _ => Err(format!("{fun:?} is not known here")),
    }
}

fn zero_scalar(scalar: naga::Scalar) -> Result<Value, String> {
    match scalar.kind {
        naga::ScalarKind::Float => Ok(Value::F32(0.0)),
        naga::ScalarKind::Uint => Ok(Value::U32(0)),
        naga::ScalarKind::Sint => Ok(Value::I32(0)),
        naga::ScalarKind::Bool => Ok(Value::Bool(false)),
        other => Err(format!("{other:?} is not known here")),
    }
}

fn literal_value(literal: Literal) -> Result<Value, String> {
    match literal {
        Literal::F32(value) => Ok(Value::F32(value)),
        Literal::U32(value) => Ok(Value::U32(value)),
        Literal::I32(value) => Ok(Value::I32(value)),
        Literal::Bool(value) => Ok(Value::Bool(value)),
        other => Err(format!("{other:?} is not known here")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What `fn f(x: u32, v: vec3<f32>) -> T` of this body returns for 5 and (1, -2, 4).
    #[track_caller]
    fn assert_returns(ty: &str, body: &str, expected: Value) {
        let text = format!(
            "struct S {{ a: f32, v: vec3<f32>, }}\nconst K = array<f32, 3>(7.0, 8.0, 9.0);\n\
             fn twice(x: f32) -> f32 {{ return 2.0 * x; }}\n\
             fn f(x: u32, v: vec3<f32>) -> {ty} {{ {body} }}"
        );
        let module = naga::front::wgsl::parse_str(&text).unwrap();
        let arguments = [Value::U32(5), Value::list([1.0, -2.0, 4.0])];
        let returned = Interpreter::new(&module).call("f", &arguments);
        assert_eq!(returned, Ok(expected), "{body}");
    }

    #[test]
    fn expressions() {
        assert_returns("f32", "return 2.0 * v.z - v.y / 4.0;", Value::F32(8.5));
        assert_returns("u32", "return (x << 30u) ^ 7u;", Value::U32(0x4000_0007));
        assert_returns("u32", "return x * 0xffffffffu % 7u;", Value::U32(6));
        assert_returns("i32", "return -i32(x) / 2i;", Value::I32(-2));
        assert_returns("vec3<f32>", "return v.zxy;", Value::list([4.0, 1.0, -2.0]));
        assert_returns(
            "vec2<f32>",
            "return abs(v).xy + 1.0;",
            Value::list([2.0, 3.0]),
        );
        assert_returns("f32", "return dot(v, v.yzx);", Value::F32(-6.0));
        assert_returns(
            "vec3<f32>",
            "return cross(v, v.yzx);",
            Value::list([-18.0, -9.0, 0.0]),
        );
        assert_returns(
            "f32",
            "return length(vec2<f32>(3.0, v.z));",
            Value::F32(5.0),
        );
        assert_returns(
            "f32",
            "return smoothstep(0.0, 8.0, v.z - 2.0);",
            Value::F32(0.15625),
        );
        assert_returns("f32", "return mix(1.0, 5.0, 1.0 / v.z);", Value::F32(2.0));
        assert_returns(
            "bool",
            "return all(v > vec3<f32>(0.0));",
            Value::Bool(false),
        );
        assert_returns(
            "vec3<f32>",
            "return select(v, vec3<f32>(0.0), v < vec3<f32>(0.0));",
            Value::list([1.0, 0.0, 4.0]),
        );
        assert_returns("f32", "return K[x - 3u];", Value::F32(9.0));
    }

    #[test]
    fn statements() {
        assert_returns(
            "f32",
            "var s: S; s.v = v; s.v.y = twice(3.0); return s.v.y + s.a;",
            Value::F32(6.0),
        );
        assert_returns(
            "u32",
            "var sum: u32; for (var i = 0u; i < 99u; i++) { if (i == 1u) { continue; } \
             if (i > x) { break; } sum += i; } return sum;",
            Value::U32(14),
        );
        assert_returns(
            "f32",
            "switch x { case 1u, 5u: { return 1.0; } default: { return 2.0; } }",
            Value::F32(1.0),
        );
        assert_returns(
            "u32",
            "var i = x; loop { i -= 1u; continuing { break if i < 3u; } } return i;",
            Value::U32(2),
        );
    }

    #[test]
    fn what_is_not_known_and_what_never_ends_is_told() {
        let run = |body: &str| {
            let module =
                naga::front::wgsl::parse_str(&format!("fn f() -> f32 {{ {body} }}")).unwrap();
            Interpreter::new(&module).call("f", &[]).unwrap_err()
        };
        assert!(run("var x = 1.0; return atan2(x, x);").contains("Atan2"));
        assert!(run("var i = 0u; while (i < 2u) { i = 0u; } return 1.0;").contains("rounds"));
    }
}
