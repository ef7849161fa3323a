//! Which choice of a preset a function switches on.

use crate::params::{Kind, Param};
use naga::{Block, Expression, Function, Handle, Module, Statement};

/// The first choice that the function of that name switches on, and how many there are to choose from.
///
/// A loop over samples that knows it is compiled once for each, without branches: they would keep it from vector instructions, or have
/// all choices worked out for each sample.
pub(crate) fn of<'a>(
    module: &Module,
    function: &str,
    params: &'a [Param],
) -> Option<(&'a str, u32)> {
    let mut functions = module.functions.iter().map(|(_, function)| function);
    let function = functions.find(|it| it.name.as_deref() == Some(function))?;
    let mut switched = Vec::new();
    find(&function.body, &mut switched);
    switched.into_iter().find_map(|selector| {
        let param = params.get(field(module, function, selector)?)?;
        match &param.kind {
            Kind::Choice { names, .. } => Some((&*param.name, names.len() as u32)),
            _ => None,
        }
    })
}

/// What is switched on, from the first on.
fn find(block: &Block, switched: &mut Vec<Handle<Expression>>) {
    for statement in block {
        match statement {
            Statement::Block(inner) => find(inner, switched),
            Statement::If { accept, reject, .. } => {
                find(accept, switched);
                find(reject, switched);
            }
            Statement::Loop { body, .. } => find(body, switched),
            Statement::Switch { selector, cases } => {
                switched.push(*selector);
                for case in cases {
                    find(&case.body, switched);
                }
            }
            _ => {}
        }
    }
}

/// Which field of its argument `Params` an expression of a function is.
fn field(module: &Module, function: &Function, expression: Handle<Expression>) -> Option<usize> {
    let Expression::AccessIndex { base, index } = function.expressions[expression] else {
        return None;
    };
    let Expression::FunctionArgument(argument) = function.expressions[base] else {
        return None;
    };
    let ty = function.arguments[argument as usize].ty;
    let is_params = module.types[ty].name.as_deref() == Some("Params");
    is_params.then_some(index as usize)
}
