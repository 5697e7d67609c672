//! Functions that are written as text, beside those that are recorded.

use super::ir::{Expr, Function, Id, Stmt, Type, VarId};
use super::{Builder, Recorder};
use crate::machine::{KernelInfo, Schema, Value};

static SCRATCH: KernelInfo =
    KernelInfo { name: "scratch", file: file!(), line: line!(), params: &[], known: None };

impl Recorder {
    /// The number of the function of this name that is text, made if there is none. `types` are those that
    /// its text has by their names.
    pub(crate) fn text_function(
        &self,
        name: String,
        types: Vec<&'static Schema>,
        text: &dyn Fn(&str) -> String,
    ) -> usize {
        let mut state = self.state.borrow_mut();
        if let Some(i) = state.functions.iter().position(|f| f.is_text() && f.name() == name) {
            return i;
        }
        let text = text(&name);
        state.functions.push(Function::Text { name, text, types });
        state.functions.len() - 1
    }

    /// The number of the function that `call` records, without a call of it.
    pub(crate) fn function_of<R: Value<Self>>(&self, call: impl FnOnce(&Self) -> R) -> usize {
        self.state.borrow_mut().open.push(Builder::new(&SCRATCH));
        call(self);
        self.called()
    }

    /// The number of the function that is called last in the function under way, which goes.
    fn called(&self) -> usize {
        let scratch = self.state.borrow_mut().open.pop();
        let called =
            scratch.iter().flat_map(|b| &b.function.nodes).rev().find_map(|n| match n.expr {
                Expr::Call(f, _) => Some(f),
                _ => None,
            });
        called.expect("what is recorded calls a kernel, which records a function")
    }

    /// The name of a function.
    pub(crate) fn function_name(&self, i: usize) -> String {
        self.state.borrow().functions[i].name().to_owned()
    }

    /// A variable that begins with a value.
    pub(crate) fn declare(&self, name: &'static str, value: Id, schema: &'static Schema) -> VarId {
        self.builder(|b| {
            let variable = b.new_var(name, Type::Of(schema));
            b.used(value);
            b.push(Stmt::Var(variable, Some(value)));
            variable
        })
    }

    /// Has a value computed where it stands, under this name.
    pub(crate) fn pin(&self, id: Id, name: &'static str) {
        self.builder(|b| {
            let node = b.node(id);
            (node.pinned, node.name) = (true, Some(name));
        });
    }

    /// A value in one piece.
    pub(crate) fn whole<V: Value<Self>>(&self, v: V) -> Id {
        self.put_together(V::SCHEMA, &mut self.leaves_of(v).into_iter())
    }
}
