//! The functions of a program without what nothing reads.
//!
//! A kernel of the library computes for all its callers: a hit has texture coordinates, a path the
//! albedo that denoisers ask for. Where a program does not read them, its text has none of it: no
//! variable, no argument, no call that only computes it. Where a struct is made as a whole, zeros stand
//! in for members that nothing reads.
//!
//! This happens while a program is printed: recordings keep everything, since what a kernel does with
//! its arguments decides what the frame around it needs.

use core::ops::Range;

use super::carried::settle_carried;
use super::ir::{Expr, Function, Id, Node, Recorded, Scalar, Stmt, Type};
use super::needed::{Needed, needed, ranges};
use super::{Recording, State};
use crate::machine::Schema;

/// How often branches that have become empty free their conditions; more is rare.
const ROUNDS: usize = 4;

/// Returns the recording without what its result does not depend on.
pub(super) fn lean(recording: &Recording) -> Recording {
    let mut lean = recording.clone();
    settle_carried(&mut lean.state);
    for _ in 0..ROUNDS {
        if !shrink(&mut lean.state, recording.entry) {
            break;
        }
    }
    lean
}

/// Removes what is not needed; returns whether a branch was removed, whose condition may be unneeded.
fn shrink(state: &mut State, entry: usize) -> bool {
    let all = needed(state, entry);
    let kept = kept_parameters(&state.functions, &all);
    let mut is_shorter = false;
    for (i, function) in state.functions.iter_mut().enumerate() {
        let Function::Recorded(f) = function else { continue };
        is_shorter |= shrink_block(&mut f.body, &all[i]);
        for n in 0..f.nodes.len() {
            match f.nodes[n].expr.clone() {
                Expr::Compose(parts) if matches!(f.nodes[n].ty, Type::Of(_)) => {
                    let is_read =
                        |_: usize, range: Range<usize>| all[i].is_any_needed(Id(n as u32), range);
                    let parts = with_zeros(f, &all[i], parts, is_read);
                    f.nodes[n].expr = Expr::Compose(parts);
                }
                Expr::Call(callee, args) => {
                    let Some(kept) = &kept[callee] else { continue };
                    let is_read =
                        |k: usize, _: Range<usize>| !kept[k] || all[callee].is_param_needed(k);
                    let mut args = with_zeros(f, &all[i], args, is_read);
                    let mut is_kept = kept.iter();
                    args.retain(|_| is_kept.next() == Some(&true));
                    f.nodes[n].expr = Expr::Call(callee, args);
                }
                _ => {}
            }
        }
        if let Some(kept) = &kept[i] {
            drop_parameters(f, kept);
        }
    }
    is_shorter
}

/// Replaces values that nothing reads by zeros, but for those that have an effect. `is_read` is told
/// the index of a value and where its scalars are among all of them.
fn with_zeros(
    f: &mut Recorded,
    needed: &Needed,
    mut values: Vec<Id>,
    is_read: impl Fn(usize, Range<usize>) -> bool,
) -> Vec<Id> {
    for (k, range) in ranges(f, &values).into_iter().enumerate() {
        if !needed.has_effect(values[k]) && !is_read(k, range) {
            values[k] = zero(f, f.nodes[values[k].0 as usize].ty);
        }
    }
    values
}

/// Returns which parameters of each function stay; `None` of hand-written text.
fn kept_parameters(functions: &[Function], all: &[Needed]) -> Vec<Option<Vec<bool>>> {
    let of = |(f, needed): (&Function, &Needed)| match f {
        Function::Text { .. } => None,
        Function::Recorded(f) => {
            let is_kept = |i| needed.is_called_by_text || needed.is_param_needed(i);
            Some((0..f.params.len()).map(is_kept).collect::<Vec<bool>>())
        }
    };
    let mut kept: Vec<Option<Vec<bool>>> = functions.iter().zip(all).map(of).collect();
    for (f, needed) in functions.iter().zip(all) {
        let Function::Recorded(f) = f else { continue };
        for node in &f.nodes {
            let Expr::Call(callee, args) = &node.expr else { continue };
            let Some(kept) = &mut kept[*callee] else { continue };
            for (kept, arg) in kept.iter_mut().zip(args) {
                *kept |= needed.has_effect(*arg);
            }
        }
    }
    kept
}

fn drop_parameters(f: &mut Recorded, kept: &[bool]) {
    for node in &mut f.nodes {
        if let Expr::Param(i) = &mut node.expr {
            // Of one that is dropped no expression is printed.
            *i = match kept.get(*i) {
                Some(true) => kept[..*i].iter().filter(|is_kept| **is_kept).count(),
                _ => usize::MAX,
            };
        }
    }
    let mut is_kept = kept.iter();
    f.params.retain(|_| is_kept.next() == Some(&true));
}

/// Removes stores to variables that nothing reads, branches without statements, and loops that run
/// once; returns whether a branch was removed.
fn shrink_block(block: &mut Vec<Stmt>, needed: &Needed) -> bool {
    let mut is_shorter = false;
    let mut kept = Vec::with_capacity(block.len());
    for mut stmt in block.drain(..) {
        match &mut stmt {
            Stmt::Var(v, _) | Stmt::Store(v, _) if !needed.is_var_needed(*v) => continue,
            Stmt::If { c, then, otherwise } => {
                is_shorter |= shrink_block(then, needed) | shrink_block(otherwise, needed);
                let is_let = |s: &Stmt| matches!(s, Stmt::Let(id) if !needed.has_effect(*id));
                if then.iter().all(is_let) && otherwise.iter().all(is_let) && !needed.has_effect(*c)
                {
                    is_shorter = true;
                    continue;
                }
            }
            Stmt::Loop { body, continuing } => {
                is_shorter |= shrink_block(body, needed) | shrink_block(continuing, needed);
                if runs_once(body) {
                    if matches!(body.last(), Some(Stmt::Break)) {
                        body.pop();
                    }
                    kept.append(body);
                    continue;
                }
            }
            _ => {}
        }
        kept.push(stmt);
    }
    *block = kept;
    is_shorter
}

/// Returns whether the body of a loop ends with an exit, and has no other one of this loop.
fn runs_once(body: &[Stmt]) -> bool {
    fn leaves(block: &[Stmt]) -> bool {
        block.iter().any(|stmt| match stmt {
            Stmt::Break | Stmt::Continue | Stmt::BreakUnless(_) => true,
            Stmt::If { then, otherwise, .. } => leaves(then) || leaves(otherwise),
            _ => false,
        })
    }
    match body.split_last() {
        Some((Stmt::Break | Stmt::Return(_), rest)) => !leaves(rest),
        _ => false,
    }
}

/// Adds a zero of a type.
fn zero(f: &mut Recorded, ty: Type) -> Id {
    let all = |f: &mut Recorded, types: Vec<Type>| {
        Expr::Compose(types.into_iter().map(|ty| zero(f, ty)).collect())
    };
    let expr = match ty {
        Type::F32 => Expr::F32(0),
        Type::I32 => Expr::I32(0),
        Type::U32 => Expr::U32(0),
        Type::Bool => Expr::Bool(false),
        Type::Vector(scalar, n) => {
            let element = match scalar {
                Scalar::F32 => Type::F32,
                Scalar::I32 => Type::I32,
                Scalar::U32 => Type::U32,
                Scalar::Bool => Type::Bool,
            };
            let element = zero(f, element);
            Expr::Compose(vec![element; n])
        }
        Type::Of(Schema::Array { element, count, .. }) => all(f, vec![Type::of(element); *count]),
        Type::Of(Schema::Struct { fields, .. }) => {
            let fields = fields.iter().filter(|field| field.schema.leaves() > 0);
            all(f, fields.map(|field| Type::of(field.schema)).collect())
        }
        Type::Of(_) => unreachable!("a scalar or a vector has a type of its own"),
    };
    let is_equal = |n: &Node| n.expr == expr && n.ty == ty && n.name.is_none() && !n.pinned;
    if let Some(known) = f.nodes.iter().position(|n| expr.is_trivial() && is_equal(n)) {
        return Id(known as u32);
    }
    let id = Id(f.nodes.len() as u32);
    let node =
        Node { expr, ty, name: None, pinned: false, block: 0, loads: Vec::new(), version: 0 };
    f.nodes.push(node);
    id
}
