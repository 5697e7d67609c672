//! Variables that turn out to have one value.
//!
//! The value of an `if` or a `match` is a variable declared before it, with a store in each arm. Where
//! one arm alone is recorded, since the others cannot be taken, there is one store, beside the
//! declaration: reads of it are the value stored, and the program has no such variable.

use std::collections::HashMap;

use super::builder::Builder;
use super::ir::{Id, Stmt, VarId};
use super::names::unique;

/// The variables of a function that are declared without a value, by their declaration.
pub(super) type Declared = HashMap<VarId, Declaration>;

#[derive(Clone)]
pub(super) struct Declaration {
    block: u32,
    in_loop: Option<u32>,
    /// Its only value, and its name, which others may have as long as there is no variable.
    settled: Option<(Id, String)>,
}

impl Builder {
    /// Notes a variable that is declared without a value.
    pub(super) fn declare(&mut self, v: VarId) {
        let (block, in_loop) = (self.block(), self.innermost());
        self.declared.insert(v, Declaration { block, in_loop, settled: None });
    }

    /// Notes a store: the first one may settle the variable, any other one needs it.
    pub(super) fn settle(&mut self, v: VarId, value: Id) {
        let here = self.block();
        let Some(of) = self.declared.get_mut(&v) else { return };
        if of.settled.is_some() || of.block != here {
            return self.unsettle(v);
        }
        let name = std::mem::take(&mut self.function.vars[v.0 as usize].name);
        of.settled = Some((value, name));
    }

    /// Returns the value of a variable that has only one.
    pub(super) fn settled(&mut self, v: VarId) -> Option<Id> {
        let of = self.declared.get(&v)?;
        let value = of.settled.as_ref()?.0;
        if of.in_loop == self.innermost() {
            return Some(value);
        }
        // Further down in the loop there may be another store.
        self.unsettle(v);
        None
    }

    fn unsettle(&mut self, v: VarId) {
        let Some((_, name)) = self.declared.remove(&v).and_then(|of| of.settled) else { return };
        let name = unique(&name, |n| self.is_taken(n));
        self.function.vars[v.0 as usize].name = name;
    }

    /// Removes the variables that are settled.
    pub(super) fn remove_settled(&mut self) {
        let settled = |v: &VarId| self.declared.get(v).is_some_and(|of| of.settled.is_some());
        if self.declared.keys().any(settled) {
            remove(&mut self.function.body, &settled);
        }
    }
}

fn remove(block: &mut Vec<Stmt>, is_removed: &impl Fn(&VarId) -> bool) {
    block.retain_mut(|stmt| match stmt {
        Stmt::Var(v, _) | Stmt::Store(v, _) => !is_removed(v),
        Stmt::If { then, otherwise, .. } => {
            remove(then, is_removed);
            remove(otherwise, is_removed);
            true
        }
        Stmt::Loop { body, continuing } => {
            remove(body, is_removed);
            remove(continuing, is_removed);
            true
        }
        _ => true,
    });
}
