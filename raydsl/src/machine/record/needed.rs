//! What a program needs of its functions: which scalars of parameters, results and variables are read.
//!
//! A scalar is needed if the program's result depends on it: the results of the entry point, conditions
//! of branches and loops, and from there backwards through expressions, variables, calls and parameters.
//! A member of a struct is needed by itself; a component of a vector with its vector, where one is made.
//! A function that hand-written text calls is needed as a whole.

use core::ops::Range;

use super::State;
use super::ir::{Expr, Function, Id, Recorded, Stmt, Type, VarId};
use super::module::identifiers;
use crate::machine::Schema;

/// Which scalars of a value are needed, in order.
type Scalars = Vec<bool>;

/// What is needed of one function.
#[derive(Default)]
pub(super) struct Needed {
    nodes: Vec<Scalars>,
    vars: Vec<Scalars>,
    params: Vec<Scalars>,
    result: Scalars,
    /// Which expressions change a variable through its address; they are always evaluated.
    has_effect: Vec<bool>,
    /// Whether text calls it, so that its parameters stay.
    pub(super) is_called_by_text: bool,
}

impl Needed {
    pub(super) fn is_var_needed(&self, v: VarId) -> bool {
        self.vars[v.0 as usize].contains(&true)
    }

    pub(super) fn is_param_needed(&self, i: usize) -> bool {
        self.params[i].contains(&true)
    }

    pub(super) fn has_effect(&self, id: Id) -> bool {
        // Zeros that were added meanwhile have none.
        self.has_effect.get(id.0 as usize).is_some_and(|has| *has)
    }

    /// Returns whether some of the scalars of an expression in a range are needed.
    pub(super) fn is_any_needed(&self, id: Id, range: Range<usize>) -> bool {
        self.nodes[id.0 as usize][range].contains(&true)
    }

    fn new(function: &Recorded) -> Self {
        let none = |ty: Type| vec![false; scalars(ty)];
        let mut has_effect: Vec<bool> = Vec::with_capacity(function.nodes.len());
        for node in &function.nodes {
            let is_address =
                |id: Id| matches!(function.nodes[id.0 as usize].expr, Expr::Address(_));
            // An operand that is further down is a zero, which took the place of a value.
            let is_effect = |id: Id| has_effect.get(id.0 as usize) == Some(&true);
            let own = node.expr.operands().any(|id| is_address(id) || is_effect(id));
            has_effect.push(own);
        }
        Self {
            nodes: function.nodes.iter().map(|n| none(n.ty)).collect(),
            vars: function.vars.iter().map(|v| none(v.ty)).collect(),
            params: function.params.iter().map(|p| none(p.1)).collect(),
            result: function.result.map(none).unwrap_or_default(),
            has_effect,
            is_called_by_text: false,
        }
    }
}

/// Returns the number of scalars in a value of the type.
pub(super) fn scalars(ty: Type) -> usize {
    match ty {
        Type::Vector(_, n) => n,
        Type::Of(schema) => schema.leaves(),
        _ => 1,
    }
}

/// Returns where the scalars of each part are in the whole.
pub(super) fn ranges(f: &Recorded, parts: &[Id]) -> Vec<Range<usize>> {
    let counts = parts.iter().map(|part| scalars(f.nodes[part.0 as usize].ty));
    let begin = |at: &mut usize, count| {
        *at += count;
        Some(*at - count..*at)
    };
    counts.scan(0, begin).collect()
}

/// Adds needed scalars from index `at` on; returns whether any is new.
fn add(to: &mut [bool], at: usize, from: &[bool]) -> bool {
    let mut is_new = false;
    for (to, from) in to[at..].iter_mut().zip(from) {
        is_new |= *from && !*to;
        *to |= *from;
    }
    is_new
}

/// Returns what is needed of each function for the entry point's results.
pub(super) fn needed(state: &State, entry: usize) -> Vec<Needed> {
    let functions = &state.functions;
    let of = |f: &Function| match f {
        Function::Recorded(f) => Needed::new(f),
        Function::Text { .. } => Needed::default(),
    };
    let mut all: Vec<Needed> = functions.iter().map(of).collect();
    for text in functions {
        let Function::Text { text, .. } = text else { continue };
        let words = identifiers(text);
        for (needed, f) in all.iter_mut().zip(functions) {
            needed.is_called_by_text |= !f.is_text() && words.contains(f.name());
        }
    }
    for (i, needed) in all.iter_mut().enumerate() {
        needed.is_called_by_text |= i == entry;
        let whole = needed.is_called_by_text;
        needed.result.iter_mut().for_each(|scalar| *scalar |= whole);
    }
    // Callees come before their callers, but for what callees ask of arguments.
    loop {
        let mut is_new = false;
        for (i, f) in functions.iter().enumerate().rev() {
            if let Function::Recorded(f) = f {
                is_new |= (Sweep { functions, all: &mut all, i, f }).run();
            }
        }
        if !is_new {
            return all;
        }
    }
}

/// Follows what is needed through one function.
struct Sweep<'a> {
    functions: &'a [Function],
    all: &'a mut [Needed],
    i: usize,
    f: &'a Recorded,
}

impl Sweep<'_> {
    /// Returns whether anything new was found.
    fn run(&mut self) -> bool {
        let mut is_any_new = false;
        loop {
            let mut is_new = self.block(&self.f.body);
            for n in (0..self.f.nodes.len()).rev() {
                let needed = &self.all[self.i];
                if needed.has_effect[n] {
                    is_new |= self.whole(Id(n as u32));
                }
                if self.all[self.i].nodes[n].contains(&true) {
                    is_new |= self.operands(n);
                }
            }
            if !is_new {
                return is_any_new;
            }
            is_any_new = true;
        }
    }

    fn whole(&mut self, id: Id) -> bool {
        let to = &mut self.all[self.i].nodes[id.0 as usize];
        let is_new = to.contains(&false);
        to.fill(true);
        is_new
    }

    fn whole_var(&mut self, v: VarId) -> bool {
        let to = &mut self.all[self.i].vars[v.0 as usize];
        let is_new = to.contains(&false);
        to.fill(true);
        is_new
    }

    fn part(&mut self, id: Id, at: usize, from: &[bool]) -> bool {
        add(&mut self.all[self.i].nodes[id.0 as usize], at, from)
    }

    fn ty(&self, id: Id) -> Type {
        self.f.nodes[id.0 as usize].ty
    }

    /// Follows the statements: conditions, results, and values of variables.
    fn block(&mut self, block: &[Stmt]) -> bool {
        let mut is_new = false;
        for stmt in block {
            is_new |= match stmt {
                Stmt::Let(_) | Stmt::Var(_, None) | Stmt::Break | Stmt::Continue => false,
                Stmt::Return(None) => false,
                Stmt::Var(v, Some(value)) | Stmt::Store(v, value) => {
                    let is_kept = self.all[self.i].has_effect(*value) && self.whole_var(*v);
                    let of_var = self.all[self.i].vars[v.0 as usize].clone();
                    is_kept | self.part(*value, 0, &of_var)
                }
                Stmt::If { c, then, otherwise } => {
                    self.whole(*c) | self.block(then) | self.block(otherwise)
                }
                Stmt::Loop { body, continuing } => self.block(body) | self.block(continuing),
                Stmt::BreakUnless(c) => self.whole(*c),
                Stmt::Return(Some(value)) => {
                    let result = self.all[self.i].result.clone();
                    self.part(*value, 0, &result)
                }
            };
        }
        is_new
    }

    /// Follows an expression of which something is needed to its operands.
    fn operands(&mut self, n: usize) -> bool {
        let node = &self.f.nodes[n];
        let own = self.all[self.i].nodes[n].clone();
        match &node.expr {
            Expr::Param(i) => add(&mut self.all[self.i].params[*i], 0, &own),
            Expr::Load(v) => add(&mut self.all[self.i].vars[v.0 as usize], 0, &own),
            Expr::Address(v) => self.whole_var(*v),
            Expr::Member(a, name) => match member(self.ty(*a), name) {
                Some(at) => self.part(*a, at, &own),
                None => self.whole(*a),
            },
            Expr::Element(a, i) => self.part(*a, i * own.len(), &own),
            Expr::Select(c, a, b) => {
                self.whole(*c) | self.part(*a, 0, &own) | self.part(*b, 0, &own)
            }
            Expr::Compose(parts) if matches!(node.ty, Type::Of(_)) => {
                let ranges = ranges(self.f, parts);
                parts
                    .iter()
                    .zip(ranges)
                    .fold(false, |is_new, (part, range)| is_new | self.part(*part, 0, &own[range]))
            }
            Expr::Call(callee, args) => self.call(*callee, args, &own),
            expr => {
                let operands: Vec<Id> = expr.operands().collect();
                operands.into_iter().fold(false, |is_new, id| is_new | self.whole(id))
            }
        }
    }

    fn call(&mut self, callee: usize, args: &[Id], own: &[bool]) -> bool {
        if self.functions[callee].is_text() {
            return args.iter().fold(false, |is_new, id| is_new | self.whole(*id));
        }
        let mut is_new = add(&mut self.all[callee].result, 0, own);
        for (i, arg) in args.iter().enumerate() {
            let needed = self.all[callee].params[i].clone();
            is_new |= self.part(*arg, 0, &needed);
        }
        is_new
    }
}

/// Returns the index of a member's first scalar.
pub(super) fn member(ty: Type, name: &str) -> Option<usize> {
    match ty {
        Type::Vector(..) => ["x", "y", "z", "w"].iter().position(|c| *c == name),
        Type::Of(Schema::Struct { fields, .. }) => {
            let at = fields.iter().position(|f| f.name == name)?;
            Some(fields[..at].iter().map(|f| f.schema.leaves()).sum())
        }
        _ => None,
    }
}
