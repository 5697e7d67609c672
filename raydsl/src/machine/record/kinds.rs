//! What is known of the kinds of enums while a kernel is recorded.
//!
//! A `match` compares the number of a variant, a node of type `u32`. For such nodes the builder
//! keeps the set of the kinds that they may have: literals have one, elements of data those of the
//! data, parameters those of the arguments, results those of what is returned, and the branches
//! around exclude some. A comparison that is decided so is a literal, and the arm that cannot be
//! taken is not recorded.
//!
//! The body of a loop runs often, and what is stored further down may be read further up. A read of
//! a variable made outside the loop assumes the kinds stored so far. Where the loop has ended and
//! others were stored as well, its body is recorded again, with these known from the start; see
//! `restart.rs`.

use std::collections::HashMap;

use super::builder::Builder;
use super::ir::{Expr, Id, VarId};
use super::{Compare, Recorder, Schema};
use crate::machine::{BoolBinary, Data, Kinds, Type as MachineType, Value};

/// What is known of the function being recorded.
#[derive(Clone, Default)]
pub(super) struct Known {
    /// The kinds of numbers that are no literals.
    nodes: HashMap<Id, Kinds>,
    variables: HashMap<VarId, Variable>,
    /// What holds in the branches being recorded.
    assumed: Vec<(Id, Kinds)>,
    /// The kinds of each number in the results returned so far.
    returned: Vec<Kinds>,
    /// Whether the function is a scratch, whose calls have zeros in place of arguments.
    pub(super) is_scratch: bool,
}

/// What is known of a variable.
#[derive(Clone, Copy)]
pub(super) struct Variable {
    /// The kinds stored so far.
    stored: Kinds,
    /// The kinds of the enum.
    all: Kinds,
    /// The innermost loop around its declaration.
    in_loop: Option<u32>,
}

/// Shows the number of each leaf that is a kind, with the kinds of its enum.
fn each_kind(schema: &Schema, next: &mut usize, visit: &mut dyn FnMut(usize, Kinds)) {
    match schema {
        Schema::Kind { count } => {
            visit(*next, Kinds::first(*count));
            *next += 1;
        }
        Schema::Array { element, count, .. } if element.has_kinds() => {
            (0..*count).for_each(|_| each_kind(element, next, visit));
        }
        Schema::Struct { fields, .. } => {
            fields.iter().for_each(|f| each_kind(f.schema, next, visit));
        }
        _ => *next += schema.leaves(),
    }
}

/// Returns the leaves that are kinds, with the kinds of their enums.
fn kinds_of_schema(schema: &Schema) -> Vec<(usize, Kinds)> {
    let mut all = Vec::new();
    if schema.has_kinds() {
        each_kind(schema, &mut 0, &mut |leaf, kinds| all.push((leaf, kinds)));
    }
    all
}

/// Shows the offset of each number that is a kind.
fn each_offset(schema: &Schema, offset: usize, visit: &mut dyn FnMut(usize)) {
    match schema {
        Schema::Kind { .. } => visit(offset),
        Schema::Array { element, count, stride } if element.has_kinds() => {
            (0..*count).for_each(|i| each_offset(element, offset + i * stride, visit));
        }
        Schema::Struct { fields, .. } => {
            fields.iter().for_each(|f| each_offset(f.schema, offset + f.offset, visit));
        }
        _ => {}
    }
}

/// Returns what is in one of the lists, with the union of the kinds, if it is in both.
fn in_both(a: &[(Id, Kinds)], b: &[(Id, Kinds)]) -> Vec<(Id, Kinds)> {
    let of = |id| b.iter().find(|(other, _)| *other == id);
    a.iter().filter_map(|(id, kinds)| Some((*id, kinds.union(of(*id)?.1)))).collect()
}

impl Builder {
    /// Returns the number of the innermost loop.
    pub(super) fn innermost(&self) -> Option<u32> {
        self.loops.last().map(|l| l.number)
    }

    /// Returns whether both are one value: one node, or loads without a store between them.
    fn is_same(&self, a: Id, b: Id) -> bool {
        let (x, y) = (&self.function.nodes[a.0 as usize], &self.function.nodes[b.0 as usize]);
        a == b || matches!(x.expr, Expr::Load(_)) && x.expr == y.expr && x.version == y.version
    }

    /// Returns the kinds that a number may be.
    fn kinds_of(&self, id: Id) -> Kinds {
        if let Expr::U32(v) = self.function.nodes[id.0 as usize].expr {
            return Kinds::one(v);
        }
        let known = self.known.nodes.get(&id).copied().unwrap_or(Kinds::ALL);
        let assumed = self.known.assumed.iter().filter(|(of, _)| self.is_same(*of, id));
        assumed.fold(known, |all, (_, kinds)| all.intersection(*kinds))
    }

    /// Returns what follows where `c` is `holds`.
    fn implied(&self, c: Id, holds: bool) -> Vec<(Id, Kinds)> {
        let node = |id: Id| &self.function.nodes[id.0 as usize].expr;
        match *node(c) {
            Expr::Compare(op @ (Compare::Eq | Compare::Ne), a, b)
                if self.known.nodes.contains_key(&a) =>
            {
                let Expr::U32(kind) = *node(b) else { return Vec::new() };
                let is = (op == Compare::Eq) == holds;
                vec![(a, if is { Kinds::one(kind) } else { Kinds::ALL.without(kind) })]
            }
            Expr::Not(a) => self.implied(a, !holds),
            Expr::BoolBinary(op @ (BoolBinary::And | BoolBinary::Or), a, b) => {
                let (mut a, b) = (self.implied(a, holds), self.implied(b, holds));
                if (op == BoolBinary::And) == holds {
                    a.extend(b);
                    return a;
                }
                in_both(&a, &b)
            }
            _ => Vec::new(),
        }
    }

    /// Returns how much is assumed here.
    pub(super) fn assumptions(&self) -> usize {
        self.known.assumed.len()
    }

    /// Assumes what follows where `c` is `holds`, behind the first `count` assumptions.
    pub(super) fn assume(&mut self, count: usize, c: Id, holds: bool) {
        let implied = self.implied(c, holds);
        self.forget(count);
        self.known.assumed.extend(implied);
    }

    /// Forgets all but the first `count` assumptions.
    pub(super) fn forget(&mut self, count: usize) {
        self.known.assumed.truncate(count);
    }

    /// Begins to keep the kinds of a variable.
    pub(super) fn keep_kinds(&mut self, v: VarId, all: Kinds, value: Option<Id>) {
        let stored = value.map_or(Kinds::NONE, |value| self.kinds_of(value));
        let variable = Variable { stored, all, in_loop: self.innermost() };
        self.known.variables.insert(v, variable);
    }

    /// Adds the kinds of `value`, stored in a variable.
    pub(super) fn store_kinds(&mut self, v: VarId, value: Id) {
        if self.known.variables.is_empty() {
            return;
        }
        let kinds = self.kinds_of(value);
        if let Some(variable) = self.known.variables.get_mut(&v) {
            variable.stored = variable.stored.union(kinds);
        }
    }

    /// Keeps the kinds of a load: those stored so far. In a loop that the variable was not made in,
    /// they are an assumption.
    pub(super) fn load_kinds(&mut self, v: VarId, load: Id) {
        let Some(&Variable { stored, all, in_loop }) = self.known.variables.get(&v) else { return };
        let kinds = if stored == Kinds::NONE { all } else { stored };
        self.known.nodes.insert(load, kinds);
        let around = self.loops.iter().rposition(|l| Some(l.number) == in_loop);
        let inside = around.map_or(0, |at| at + 1);
        // All stores that may come before it are in front of the outermost of these loops or in it.
        if let Some(l) = self.loops.get_mut(inside) {
            // Kinds are only added: the first read assumes the fewest.
            l.assumed.entry(v).or_insert(kinds);
        }
    }

    /// Returns whether any variable has kinds.
    pub(super) fn has_kinds(&self) -> bool {
        !self.known.variables.is_empty()
    }

    /// Returns whether a read in the innermost loop assumed too few kinds: others were stored, and
    /// its body runs again.
    pub(super) fn assumed_too_few(&self) -> bool {
        let assumed = self.loops.last().map(|l| &l.assumed);
        assumed.into_iter().flatten().any(|(v, kinds)| {
            let variable = &self.known.variables[v];
            !kinds.has_all(variable.stored.intersection(variable.all))
        })
    }

    /// Adds the kinds that variables got in `other`, the same function recorded further: all of the
    /// enum for variables that got any, if `all` is set.
    pub(super) fn widen(&mut self, other: &Self, all: bool) {
        for (v, variable) in &mut self.known.variables {
            let stored = other.known.variables[v].stored;
            if !variable.stored.has_all(stored) {
                let more = if all { variable.all } else { Kinds::NONE };
                variable.stored = stored.union(more);
            }
        }
    }

    /// Keeps the kinds of a selection of one of two numbers.
    pub(super) fn select_kinds(&mut self, selected: Id, a: Id, b: Id) {
        let kinds = self.kinds_of(a).union(self.kinds_of(b));
        if kinds != Kinds::ALL {
            self.known.nodes.insert(selected, kinds);
        }
    }

    /// Keeps the kinds among the leaves of a value: `found`, or any.
    pub(super) fn know(&mut self, schema: &Schema, leaves: &[Id], found: &[Kinds]) {
        for (i, (leaf, all)) in kinds_of_schema(schema).into_iter().enumerate() {
            let kinds = found.get(i).map_or(all, |kinds| all.intersection(*kinds));
            self.known.nodes.insert(leaves[leaf], kinds);
        }
    }

    /// Returns the kinds among the leaves of a value. In a scratch they may be any.
    pub(super) fn kinds_among(&self, schema: &Schema, leaves: &[Id]) -> Vec<Kinds> {
        let all = kinds_of_schema(schema).into_iter();
        if self.known.is_scratch {
            return all.map(|(_, all)| all).collect();
        }
        all.map(|(leaf, _)| self.kinds_of(leaves[leaf])).collect()
    }

    /// Adds the kinds of a result.
    pub(super) fn return_kinds(&mut self, schema: &Schema, leaves: &[Id]) {
        let kinds = self.kinds_among(schema, leaves);
        self.known.returned.resize(kinds.len(), Kinds::NONE);
        for (all, kinds) in self.known.returned.iter_mut().zip(kinds) {
            *all = all.union(kinds);
        }
    }

    /// Returns the kinds in the results.
    pub(super) fn returned_kinds(&mut self) -> Vec<Kinds> {
        std::mem::take(&mut self.known.returned)
    }
}

impl Recorder {
    /// Returns what `a == kind` always is, if that is known.
    pub(super) fn is_kind(&self, a: Id, kind: Id) -> Option<bool> {
        let kind = self.u32_literal(kind)?;
        let kinds = self.builder(|b| b.kinds_of(a));
        match (kinds.has(kind), kinds.is_only(kind)) {
            (false, _) => Some(false),
            (_, true) => Some(true),
            _ => None,
        }
    }

    /// Returns the element that `function` reads at `index`, with the kinds of all elements.
    pub(super) fn element_of<D: Data>(
        &self,
        data: &D,
        function: usize,
        index: Id,
    ) -> <D::Element as MachineType>::On<Self> {
        let schema = D::Element::SCHEMA;
        let leaves = self.call_of(function, vec![index], schema);
        if const { D::Element::SCHEMA.has_kinds() } {
            let found = self.kinds_of_data(data);
            self.builder(|b| b.know(schema, &leaves, &found));
        }
        self.with_leaves(Value::zero(self), &leaves)
    }

    /// Returns the kinds of each number of a variant in the elements, which are noted with the
    /// buffer; none if the elements have no enums.
    pub(super) fn kinds_of_data<D: Data>(&self, data: &D) -> Vec<Kinds> {
        let schema = D::Element::SCHEMA;
        if const { !D::Element::SCHEMA.has_kinds() } {
            return Vec::new();
        }
        let buffer = self.buffer_of(data);
        self.kinds_of_buffer(&buffer, schema, &mut || {
            let write = &mut |i, out: &mut [u8]| data.get(i).write(out);
            data.kinds().map_or_else(|| found_in(schema, data.count(), write), |k| vec![k])
        })
    }

    /// Returns the kinds among the elements of a buffer, found once.
    fn kinds_of_buffer(
        &self,
        name: &str,
        schema: &Schema,
        find: &mut dyn FnMut() -> Vec<Kinds>,
    ) -> Vec<Kinds> {
        let of =
            |s: &super::State| s.buffers.iter().position(|b| b.name == name && b.schema == schema);
        let Some(i) = of(&self.state.borrow()) else { return Vec::new() };
        let known = self.state.borrow().buffers[i].kinds.clone();
        known.unwrap_or_else(|| {
            let found = find();
            self.state.borrow_mut().buffers[i].kinds = Some(found.clone());
            found
        })
    }
}

/// Returns the kinds of each number among `count` elements, which `write` writes; none if there are
/// no elements: then they may be any.
fn found_in(schema: &Schema, count: usize, write: &mut dyn FnMut(u32, &mut [u8])) -> Vec<Kinds> {
    if count == 0 {
        return Vec::new();
    }
    let mut offsets = Vec::new();
    each_offset(schema, 0, &mut |offset| offsets.push(offset));
    let all: Vec<Kinds> = kinds_of_schema(schema).into_iter().map(|(_, all)| all).collect();
    let (mut found, mut bytes) = (vec![Kinds::NONE; offsets.len()], vec![0; schema.size()]);
    for i in 0..count as u32 {
        write(i, &mut bytes);
        for (found, &at) in found.iter_mut().zip(&offsets) {
            let word = <[u8; 4]>::try_from(&bytes[at..at + 4]).expect("four bytes");
            *found = found.union(Kinds::one(u32::from_le_bytes(word)));
        }
        if found == all {
            break;
        }
    }
    found
}
