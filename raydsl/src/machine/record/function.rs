//! Printing of recorded functions.

use core::fmt::Write;

use super::State;
use super::expression::Expressions;
use super::ir::{Expr, Id, Recorded, Stmt, Type, VarId};
use super::names::{safe_name, unique};
use super::types::Names;
use crate::machine::F32Binary;

/// The declarations that expressions of every function may refer to.
pub(super) struct Text<'a> {
    pub(super) state: &'a State,
}

impl Text<'_> {
    pub(super) fn function(&self, i: usize) -> &str {
        self.state.functions[i].name()
    }

    pub(super) fn uniform(&self, i: usize) -> &str {
        &self.state.uniforms[i].name
    }

    pub(super) fn param(&self, f: &Recorded, i: usize) -> String {
        self.local(&safe_name(&f.params[i].0))
    }

    pub(super) fn var(&self, f: &Recorded, v: VarId) -> String {
        self.local(&f.vars[v.0 as usize].name)
    }

    /// Returns the name of a local, changed if it would shadow a function or a buffer.
    pub(super) fn local(&self, name: &str) -> String {
        let hides = self.state.functions.iter().any(|f| f.name() == name)
            || self.state.buffers.iter().any(|b| b.name == name);
        if hides { format!("{name}_") } else { name.to_owned() }
    }
}

/// Prints one function.
pub(super) struct FunctionPrinter<'a> {
    function: &'a Recorded,
    text: &'a Text<'a>,
    uses: Vec<u32>,
    locals: Vec<Option<String>>,
    taken: Vec<String>,
    /// Variables printed as a `let`.
    constant: Vec<VarId>,
    out: String,
}

impl<'a> FunctionPrinter<'a> {
    pub(super) fn new(function: &'a Recorded, text: &'a Text<'a>) -> Self {
        let mut p = Self {
            function,
            text,
            uses: vec![0; function.nodes.len()],
            locals: vec![None; function.nodes.len()],
            taken: (0..function.params.len()).map(|i| text.param(function, i)).collect(),
            constant: Vec::new(),
            out: String::new(),
        };
        p.taken.extend((0..function.vars.len()).map(|v| text.var(function, VarId(v as u32))));
        p.count_block(&function.body);
        p.find_single_stores(&function.body);
        p
    }

    /// Counts how often each expression would be printed.
    fn count(&mut self, id: Id) {
        let i = id.0 as usize;
        self.uses[i] += 1;
        let node = &self.function.nodes[i];
        if self.uses[i] > 1 && !node.expr.is_trivial() {
            return;
        }
        // `min` and `max` as selects print their operands twice.
        let twice = !self.function.is_without_nan
            && matches!(node.expr, Expr::F32Binary(F32Binary::Min | F32Binary::Max, ..));
        for operand in node.expr.operands() {
            self.count(operand);
            if twice {
                self.count(operand);
            }
        }
    }

    /// Returns whether a function may change the variable.
    fn is_addressed(&self, v: VarId) -> bool {
        self.function.nodes.iter().any(|node| node.expr == Expr::Address(v))
    }

    /// Finds variables that are assigned once, where they are declared or right in that block: these
    /// are constants.
    fn find_single_stores(&mut self, block: &[Stmt]) {
        fn stores(block: &[Stmt], v: VarId) -> usize {
            let inner = |s: &Stmt| match s {
                Stmt::Store(w, _) => usize::from(*w == v),
                Stmt::If { then, otherwise, .. } => stores(then, v) + stores(otherwise, v),
                Stmt::Loop { body, continuing } => stores(body, v) + stores(continuing, v),
                _ => 0,
            };
            block.iter().map(inner).sum()
        }
        for (i, stmt) in block.iter().enumerate() {
            match stmt {
                Stmt::Var(v, None) => {
                    let here = |s: &Stmt| matches!(s, Stmt::Store(w, _) if w == v);
                    if block[i..].iter().any(here) && stores(block, *v) == 1 {
                        self.constant.push(*v);
                    }
                }
                Stmt::Var(v, Some(_)) if stores(block, *v) == 0 && !self.is_addressed(*v) => {
                    self.constant.push(*v);
                }
                Stmt::If { then, otherwise, .. } => {
                    self.find_single_stores(then);
                    self.find_single_stores(otherwise);
                }
                Stmt::Loop { body, continuing } => {
                    self.find_single_stores(body);
                    self.find_single_stores(continuing);
                }
                _ => {}
            }
        }
    }

    fn count_block(&mut self, block: &[Stmt]) {
        for stmt in block {
            match stmt {
                Stmt::Let(_) | Stmt::Break | Stmt::Continue | Stmt::Return(None) => {}
                Stmt::Var(_, value) => value.iter().for_each(|v| self.count(*v)),
                Stmt::Store(_, v) | Stmt::BreakUnless(v) | Stmt::Return(Some(v)) => self.count(*v),
                Stmt::If { c, then, otherwise } => {
                    self.count(*c);
                    self.count_block(then);
                    self.count_block(otherwise);
                }
                Stmt::Loop { body, continuing } => {
                    self.count_block(body);
                    self.count_block(continuing);
                }
            }
        }
    }

    /// Returns whether the expression gets a `let` where it was recorded.
    fn has_let(&self, id: Id) -> bool {
        let node = &self.function.nodes[id.0 as usize];
        let uses = self.uses[id.0 as usize];
        match node.expr {
            _ if uses == 0 || node.expr.is_trivial() => false,
            // A variable that does not change meanwhile is read at its use.
            Expr::Load(_) => node.pinned,
            _ => uses > 1 || node.pinned || node.name.is_some(),
        }
    }

    fn line(&mut self, depth: usize, text: &str) {
        let _ = writeln!(self.out, "{}{text}", "    ".repeat(depth));
    }

    fn any(&self, id: Id, names: &mut Names) -> String {
        let e = Expressions { function: self.function, locals: &self.locals, text: self.text };
        e.any(id, names)
    }

    fn var(&self, v: VarId) -> String {
        self.text.var(self.function, v)
    }

    pub(super) fn print(mut self, names: &mut Names) -> String {
        let f = self.function;
        let params: Vec<String> = f
            .params
            .iter()
            .enumerate()
            .map(|(i, (_, ty))| format!("{}: {}", self.text.param(f, i), names.ty(*ty)))
            .collect();
        let result = f.result.map(|r| format!(" -> {}", names.ty(r))).unwrap_or_default();
        self.line(0, &format!("fn {}({}){result} {{", f.name, params.join(", ")));
        if let Some(leave) = f.vars.iter().find(|v| v.name == "leave" && v.ty == Type::U32) {
            let text = format!("var {}: u32 = 0u;", leave.name);
            self.line(1, &text);
        }
        self.block(&f.body, 1, names);
        self.line(0, "}");
        self.out
    }

    fn block(&mut self, block: &[Stmt], depth: usize, names: &mut Names) {
        for stmt in block {
            self.stmt(stmt, depth, names);
            // The remaining statements are unreachable.
            if matches!(stmt, Stmt::Return(_) | Stmt::Break | Stmt::Continue) {
                break;
            }
        }
    }

    fn stmt(&mut self, stmt: &Stmt, depth: usize, names: &mut Names) {
        match stmt {
            Stmt::Let(id) => self.let_stmt(*id, depth, names),
            Stmt::Var(v, None) if self.constant.contains(v) => {}
            Stmt::Var(v, value) => {
                let ty = names.ty(self.function.vars[v.0 as usize].ty);
                let text = match value {
                    Some(value) if self.constant.contains(v) => {
                        format!("let {} = {};", self.var(*v), self.any(*value, names))
                    }
                    Some(value) => {
                        format!("var {}: {ty} = {};", self.var(*v), self.any(*value, names))
                    }
                    None => format!("var {}: {ty};", self.var(*v)),
                };
                self.line(depth, &text);
            }
            Stmt::Store(v, value) => {
                let keyword = if self.constant.contains(v) { "let " } else { "" };
                let text = format!("{keyword}{} = {};", self.var(*v), self.any(*value, names));
                self.line(depth, &text);
            }
            Stmt::If { c, then, otherwise } => self.if_stmt(*c, then, otherwise, depth, names),
            Stmt::Loop { body, continuing } => self.loop_stmt(body, continuing, depth, names),
            Stmt::BreakUnless(c) => {
                let text = format!("if (!({})) {{ break; }}", self.any(*c, names));
                self.line(depth, &text);
            }
            Stmt::Break => self.line(depth, "break;"),
            Stmt::Continue => self.line(depth, "continue;"),
            Stmt::Return(None) => self.line(depth, "return;"),
            Stmt::Return(Some(v)) => {
                let text = format!("return {};", self.any(*v, names));
                self.line(depth, &text);
            }
        }
    }

    fn let_stmt(&mut self, id: Id, depth: usize, names: &mut Names) {
        if !self.has_let(id) {
            return;
        }
        let node = &self.function.nodes[id.0 as usize];
        let base = match (node.name, &node.expr) {
            (Some(name), _) => self.text.local(&safe_name(name)),
            (None, Expr::Load(v)) => self.var(*v),
            (None, _) => "t".to_owned(),
        };
        let name = unique(&base, |n| self.taken.iter().any(|t| t == n));
        self.taken.push(name.clone());
        let e = Expressions { function: self.function, locals: &self.locals, text: self.text };
        let text = format!("let {name} = {};", e.definition(id, names));
        self.line(depth, &text);
        self.locals[id.0 as usize] = Some(name);
    }

    fn if_stmt(&mut self, c: Id, then: &[Stmt], other: &[Stmt], depth: usize, names: &mut Names) {
        let c = self.any(c, names);
        self.line(depth, &format!("if ({c}) {{"));
        self.else_chain(then, other, depth, names);
    }

    /// Prints the arms of an `if` whose head is printed already; a sole `if` in an `else` becomes
    /// `else if`.
    fn else_chain(&mut self, then: &[Stmt], other: &[Stmt], depth: usize, names: &mut Names) {
        self.block(then, depth + 1, names);
        let visible: Vec<&Stmt> =
            other.iter().filter(|s| !matches!(s, Stmt::Let(id) if !self.has_let(*id))).collect();
        if let [Stmt::If { c, then, otherwise }] = visible[..] {
            let c = self.any(*c, names);
            self.line(depth, &format!("}} else if ({c}) {{"));
            return self.else_chain(then, otherwise, depth, names);
        }
        if other.iter().any(|s| !matches!(s, Stmt::Let(id) if !self.has_let(*id))) {
            self.line(depth, "} else {");
            self.block(other, depth + 1, names);
        }
        self.line(depth, "}");
    }

    /// Prints a loop, as `while` or `for` where it has that form.
    fn loop_stmt(&mut self, body: &[Stmt], continuing: &[Stmt], depth: usize, names: &mut Names) {
        let visible = |p: &Self, s: &&Stmt| !matches!(s, Stmt::Let(id) if !p.has_let(*id));
        let first = body.iter().position(|s| visible(self, &s));
        let test = first.and_then(|i| match &body[i] {
            Stmt::BreakUnless(c) => Some((i, *c)),
            _ => None,
        });
        let steps: Vec<&Stmt> = continuing.iter().filter(|s| visible(self, s)).collect();
        let step = match steps[..] {
            [] => Some(String::new()),
            [Stmt::Store(v, value)] => {
                Some(format!("{} = {}", self.var(*v), self.any(*value, names)))
            }
            _ => None,
        };
        let (head, rest) = match (test, step) {
            (Some((i, c)), Some(step)) if step.is_empty() => {
                (format!("while ({}) {{", self.any(c, names)), &body[i + 1..])
            }
            (Some((i, c)), Some(step)) => {
                (format!("for (; {}; {step}) {{", self.any(c, names)), &body[i + 1..])
            }
            _ => {
                self.line(depth, "loop {");
                self.block(body, depth + 1, names);
                if !steps.is_empty() {
                    self.line(depth + 1, "continuing {");
                    self.block(continuing, depth + 2, names);
                    self.line(depth + 1, "}");
                }
                self.line(depth, "}");
                return;
            }
        };
        self.line(depth, &head);
        self.block(rest, depth + 1, names);
        self.line(depth, "}");
    }
}
