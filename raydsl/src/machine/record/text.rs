//! Hand-written WGSL functions in a recording.

use super::ir::{Expr, Function, Id, Stmt, Type, VarId};
use super::{Builder, Recorder};
use crate::machine::{KernelInfo, Schema, Value};

static SCRATCH: KernelInfo =
    KernelInfo { name: "scratch", file: file!(), line: line!(), params: &[], known: None };

impl Recorder {
    /// Returns the index of the text function `name`, adding it if there is none. `types` are those
    /// that its text refers to by name.
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

    /// Returns the index of the function that `call` records, without recording a call of it.
    pub(crate) fn function_of<R: Value<Self>>(&self, call: impl FnOnce(&Self) -> R) -> usize {
        let mut scratch = Builder::new(&SCRATCH);
        scratch.known.is_scratch = true;
        self.state.borrow_mut().open.push(scratch);
        call(self);
        self.called()
    }

    /// Returns the index of the last function called by the function being recorded, which is
    /// discarded.
    fn called(&self) -> usize {
        let scratch = self.state.borrow_mut().open.pop();
        let called =
            scratch.iter().flat_map(|b| &b.function.nodes).rev().find_map(|n| match n.expr {
                Expr::Call(f, _) => Some(f),
                _ => None,
            });
        called.expect("what is recorded calls a kernel, which records a function")
    }

    /// Returns the name of a function.
    pub(crate) fn function_name(&self, i: usize) -> String {
        self.state.borrow().functions[i].name().to_owned()
    }

    /// Declares a variable with an initial value.
    pub(crate) fn declare(&self, name: &'static str, value: Id, schema: &'static Schema) -> VarId {
        self.builder(|b| {
            let variable = b.new_var(name, Type::Of(schema));
            b.used(value);
            b.push(Stmt::Var(variable, Some(value)));
            variable
        })
    }

    /// Evaluates a value where it was recorded, under this name.
    pub(crate) fn pin(&self, id: Id, name: &'static str) {
        self.builder(|b| {
            let node = b.node(id);
            (node.pinned, node.name) = (true, Some(name));
        });
    }

    /// Returns the expression of a whole value.
    pub(crate) fn whole<V: Value<Self>>(&self, v: V) -> Id {
        self.put_together(V::SCHEMA, &mut self.leaves_of(v).into_iter())
    }
}

/// Returns WGSL with the `$names` in it replaced, `${names}` where an identifier continues behind.
/// A line of one name alone becomes as many lines as the value has, none if that is empty, with its
/// indentation.
///
/// # Panics
///
/// If the text has a name without a value.
pub(crate) fn from_template(template: &str, values: &[(&str, &str)]) -> String {
    let value_of = |name: &str| {
        let found = values.iter().find(|(of, _)| *of == name);
        found.unwrap_or_else(|| panic!("the template has `${name}`, which has no value")).1
    };
    let mut text = String::new();
    for line in template.lines() {
        let inner = line.trim_start();
        let indentation = &line[..line.len() - inner.len()];
        if let Some(name) = inner.strip_prefix('$').filter(|name| is_name(name)) {
            for line in value_of(name).lines().filter(|line| !line.trim().is_empty()) {
                text += &format!("{indentation}{line}\n");
            }
            continue;
        }
        let mut parts = line.split('$');
        text += parts.next().unwrap_or_default();
        for part in parts {
            let (name, rest) = match part.strip_prefix('{').and_then(|part| part.split_once('}')) {
                Some(parts) => parts,
                None => part.split_at(part.find(|c| !is_of_name(c)).unwrap_or(part.len())),
            };
            text += value_of(name);
            text += rest;
        }
        text.push('\n');
    }
    text
}

fn is_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(is_of_name)
}

#[cfg(test)]
mod tests {
    use super::from_template;

    #[test]
    fn names_are_replaced() {
        let template = "fn $name() {\n    $body\n    let ${a}_b = $a;\n    $nothing\n}\n";
        let values = [("name", "f"), ("body", "x;\ny;"), ("a", "v"), ("nothing", "")];
        let expected = "fn f() {\n    x;\n    y;\n    let v_b = v;\n}\n";
        assert_eq!(from_template(template, &values), expected);
    }

    #[test]
    #[should_panic(expected = "`$b`, which has no value")]
    fn names_without_values_are_mistakes() {
        from_template("$a $b", &[("a", "1")]);
    }
}
