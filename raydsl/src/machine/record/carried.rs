//! Variables that are stored again with the value that they have.
//!
//! A method that changes a struct takes it and returns it, with all its members. In a loop each member is
//! a variable, which is stored with what the call returns, also where no call changes it: where a walk
//! begins, the key of a sampler. Such a variable is the value that it was declared with. Its stores are
//! removed here, and then no function needs to return the member.

use super::State;
use super::ir::{Expr, Function, Id, Recorded, Stmt, VarId};
use super::needed::{member, ranges, scalars};

/// Where a scalar of a value comes from: one of a parameter, or of another expression.
#[derive(Clone, Copy, PartialEq)]
enum Source {
    Param(usize, usize),
    Node(Id, usize),
}

/// How far an origin is searched: further than any is, were it not for mistaken programs.
const MOST_STEPS: usize = 1000;

/// For each scalar of a function's result the scalar of a parameter that it always is.
type Passed = Vec<Option<(usize, usize)>>;

/// Removes such stores from all functions.
pub(super) fn settle_carried(state: &mut State) {
    // Callees come before their callers.
    let mut passed: Vec<Passed> = Vec::with_capacity(state.functions.len());
    for function in &mut state.functions {
        let Function::Recorded(f) = function else {
            passed.push(Passed::new());
            continue;
        };
        let variables = variables(f);
        let carried = carried(f, &passed, &variables);
        let of = passed_by(&Origins { f, passed: &passed, carried: &carried });
        let is_settled = |v: &VarId| {
            let is_declared = |of: &Variable| of.v == *v && of.is_declared_with_value;
            carried[v.0 as usize].is_some() && variables.iter().any(is_declared)
        };
        remove_stores(&mut f.body, &is_settled);
        passed.push(of);
    }
}

/// A variable: its first value, and what is stored in it.
struct Variable {
    v: VarId,
    /// What it is declared with, or what is stored first: nothing reads it before.
    value: Id,
    is_declared_with_value: bool,
    stores: Vec<Id>,
}

/// Collects the variables of a function that no other one changes.
fn variables(f: &Recorded) -> Vec<Variable> {
    type Declared = Vec<(VarId, Option<Id>)>;
    fn visit(block: &[Stmt], declared: &mut Declared, stores: &mut Vec<(VarId, Id)>) {
        for stmt in block {
            match stmt {
                Stmt::Var(v, value) => declared.push((*v, *value)),
                Stmt::Store(v, value) => stores.push((*v, *value)),
                Stmt::If { then, otherwise, .. } => {
                    visit(then, declared, stores);
                    visit(otherwise, declared, stores);
                }
                Stmt::Loop { body, continuing } => {
                    visit(body, declared, stores);
                    visit(continuing, declared, stores);
                }
                _ => {}
            }
        }
    }
    let (mut declared, mut stores) = (Vec::new(), Vec::new());
    visit(&f.body, &mut declared, &mut stores);
    let is_addressed = |v: VarId| f.nodes.iter().any(|node| node.expr == Expr::Address(v));
    let variable = |(v, value): (VarId, Option<Id>)| {
        let own = stores.iter().filter(|(of, _)| *of == v);
        let stores: Vec<Id> = own.map(|(_, value)| *value).collect();
        let first = value.or(stores.first().copied())?;
        let is_declared_with_value = value.is_some();
        Some(Variable { v, value: first, is_declared_with_value, stores })
    };
    let own = declared.into_iter().filter(|(v, _)| !is_addressed(*v));
    own.filter_map(variable).collect()
}

/// Returns the variables that keep their first value, with that.
fn carried(f: &Recorded, passed: &[Passed], variables: &[Variable]) -> Vec<Option<Id>> {
    let mut carried = vec![None; f.vars.len()];
    for variable in variables {
        carried[variable.v.0 as usize] = Some(variable.value);
    }
    // Those that a store changes are none, and then those that take their value from one of these.
    loop {
        let origins = Origins { f, passed, carried: &carried };
        let is_kept = |of: &Variable| {
            let count = scalars(f.vars[of.v.0 as usize].ty);
            let same = |value: &Id, i| origins.of(*value, i) == origins.of(of.value, i);
            of.stores.iter().all(|value| (0..count).all(|i| same(value, i)))
        };
        let is_carried = |of: &&Variable| carried[of.v.0 as usize].is_some();
        let changed: Vec<usize> = variables
            .iter()
            .filter(is_carried)
            .filter(|of| !is_kept(of))
            .map(|of| of.v.0 as usize)
            .collect();
        if changed.is_empty() {
            return carried;
        }
        changed.into_iter().for_each(|v| carried[v] = None);
    }
}

/// Finds where scalars come from in one function.
struct Origins<'a> {
    f: &'a Recorded,
    passed: &'a [Passed],
    carried: &'a [Option<Id>],
}

impl Origins<'_> {
    /// Returns the origin of a scalar of an expression.
    fn of(&self, id: Id, i: usize) -> Source {
        self.within(id, i, MOST_STEPS)
    }

    fn within(&self, id: Id, i: usize, steps: usize) -> Source {
        let node = &self.f.nodes[id.0 as usize];
        let ty = |id: &Id| self.f.nodes[id.0 as usize].ty;
        let from = match &node.expr {
            Expr::Param(p) => return Source::Param(*p, i),
            Expr::Member(a, name) => member(ty(a), name).map(|at| (*a, at + i)),
            Expr::Element(a, k) => Some((*a, k * scalars(node.ty) + i)),
            Expr::Compose(parts) => {
                let part =
                    ranges(self.f, parts).into_iter().zip(parts).find(|(r, _)| r.contains(&i));
                part.map(|(range, part)| (*part, i - range.start))
            }
            Expr::Call(f, args) => {
                let passed = self.passed.get(*f).and_then(|passed| *passed.get(i)?);
                passed.map(|(p, k)| (args[p], k))
            }
            Expr::Load(v) => self.carried[v.0 as usize].map(|value| (value, i)),
            _ => None,
        };
        match from {
            Some((id, i)) if steps > 0 => self.within(id, i, steps - 1),
            _ => Source::Node(id, i),
        }
    }
}

/// Returns which scalars of a function's result are always those of a parameter.
fn passed_by(origins: &Origins<'_>) -> Passed {
    fn results(block: &[Stmt], all: &mut Vec<Id>) {
        for stmt in block {
            match stmt {
                Stmt::Return(Some(value)) => all.push(*value),
                Stmt::If { then, otherwise, .. } => {
                    results(then, all);
                    results(otherwise, all);
                }
                Stmt::Loop { body, continuing } => {
                    results(body, all);
                    results(continuing, all);
                }
                _ => {}
            }
        }
    }
    let mut all = Vec::new();
    results(&origins.f.body, &mut all);
    let (Some(ty), Some((first, others))) = (origins.f.result, all.split_first()) else {
        return Passed::new();
    };
    let of = |i| match origins.of(*first, i) {
        Source::Param(p, k) => {
            let is_same = |value: &Id| origins.of(*value, i) == Source::Param(p, k);
            others.iter().all(is_same).then_some((p, k))
        }
        Source::Node(..) => None,
    };
    (0..scalars(ty)).map(of).collect()
}

fn remove_stores(block: &mut Vec<Stmt>, is_settled: &impl Fn(&VarId) -> bool) {
    block.retain_mut(|stmt| match stmt {
        Stmt::Store(v, _) => !is_settled(v),
        Stmt::If { then, otherwise, .. } => {
            remove_stores(then, is_settled);
            remove_stores(otherwise, is_settled);
            true
        }
        Stmt::Loop { body, continuing } => {
            remove_stores(body, is_settled);
            remove_stores(continuing, is_settled);
            true
        }
        _ => true,
    });
}
