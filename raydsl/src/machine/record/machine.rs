//! The [`Recorder`]'s implementation of the machine's hooks.

use core::cell::Cell;

use super::ir::{Conversion, Expr, Id, Stmt, Type, VarId};
use super::{RecordedBranch, RecordedLoop, Recorder, storage};
use crate::machine::index::with_element;
use crate::machine::wgsl;
use crate::machine::{
    B, BoolBinary, Compare, Data, F, F32Binary, F32Unary, IntBinary, KernelInfo, Loop, Machine, On,
    Op, Operation, Schema, Type as MachineType, U, U32Unary, Usize, Value, Var, Visit, op,
};

/// Returns the name of a literal in the uniform buffer, such as `lit_0_125`.
fn literal_name(v: f32) -> String {
    let digits: String = format!("{v:?}")
        .chars()
        .map(|c| match c {
            '-' => 'm',
            '.' => '_',
            c => c,
        })
        .collect();
    format!("lit_{digits}")
}

impl Recorder {
    /// Moves a number to the uniform buffer, so that drivers cannot fold it or reorder arithmetic
    /// with it. A factor that is a power of two may stay: it is exact in any order.
    pub(super) fn opaque(&self, id: Id) -> Id {
        if self.arithmetic == wgsl::Arithmetic::Fast {
            return id;
        }
        match self.node(id).expr {
            Expr::F32(bits) => {
                let name = literal_name(f32::from_bits(bits));
                self.uniform(&name, Type::F32, vec![bits])
            }
            Expr::Compose(parts) => {
                let parts: Vec<Id> = parts.into_iter().map(|p| self.opaque(p)).collect();
                let n = parts.len();
                self.add(Expr::Compose(parts), Type::F32.times(n))
            }
            _ => id,
        }
    }

    /// Returns the number of the source that `id` is, if it is one.
    ///
    /// Operations on literals alone are folded here: WGSL would evaluate them differently, or
    /// refuse a result that is not finite.
    pub(super) fn literal(&self, id: Id) -> Option<f32> {
        match self.node(id).expr {
            Expr::F32(bits) => Some(f32::from_bits(bits)),
            _ => None,
        }
    }

    /// Returns the integer of the source that `id` is, if it is one. WGSL refuses operations on
    /// constants that overflow, so these are folded here as well.
    pub(super) fn i32_literal(&self, id: Id) -> Option<i32> {
        match self.node(id).expr {
            Expr::I32(v) => Some(v),
            _ => None,
        }
    }

    pub(super) fn u32_literal(&self, id: Id) -> Option<u32> {
        match self.node(id).expr {
            Expr::U32(v) => Some(v),
            _ => None,
        }
    }

    /// Returns the truth value that `id` always has, if there is one.
    pub(super) fn truth(&self, id: Id) -> Option<bool> {
        match self.node(id).expr {
            Expr::Bool(v) => Some(v),
            _ => None,
        }
    }

    fn select(&self, c: Id, a: Id, b: Id, ty: Type) -> Id {
        match self.truth(c) {
            Some(true) => a,
            Some(false) => b,
            None => {
                let selected = self.add(Expr::Select(c, a, b), ty);
                if ty == Type::U32 {
                    self.builder(|builder| builder.select_kinds(selected, a, b));
                }
                selected
            }
        }
    }

    /// Returns the variable `leave`, which holds the labelled loop being left.
    fn leave(&self) -> VarId {
        self.builder(|b| {
            if let Some(v) = b.leave {
                return v;
            }
            let v = b.new_var("leave", Type::U32);
            b.leave = Some(v);
            v
        })
    }

    /// Leaves the innermost loop on the way to loop `number`.
    fn exit(&self, number: u32, again: bool) {
        let innermost = self.builder(|b| b.loops.last().map(|l| l.number));
        if innermost == Some(number) {
            let stmt = if again { Stmt::Continue } else { Stmt::Break };
            self.builder(|b| b.push(stmt));
            return;
        }
        let leave = self.leave();
        let code = self.add(Expr::U32(2 * number + u32::from(again)), Type::U32);
        self.builder(|b| {
            b.store(leave, code);
            b.push(Stmt::Break);
            if let Some(l) = b.loops.last_mut()
                && !l.passing.contains(&(number, again))
            {
                l.passing.push((number, again));
            }
        });
    }

    /// Continues a labelled exit behind an inner loop that it passed through.
    fn pass_on(&self, passing: Vec<(u32, bool)>) {
        for (number, again) in passing {
            let leave = self.leave();
            let code = self.add(Expr::U32(2 * number + u32::from(again)), Type::U32);
            let now = self.add(Expr::Load(leave), Type::U32);
            let c = self.add(Expr::Compare(Compare::Eq, now, code), Type::Bool);
            let b = self.branch(c);
            let zero = self.add(Expr::U32(0), Type::U32);
            let arrived = self.builder(|b| b.loops.last().is_some_and(|l| l.number == number));
            if arrived {
                self.builder(|b| b.store(leave, zero));
                self.exit(number, again);
            } else {
                self.builder(|b| {
                    b.push(Stmt::Break);
                    if let Some(l) = b.loops.last_mut()
                        && !l.passing.contains(&(number, again))
                    {
                        l.passing.push((number, again));
                    }
                });
            }
            self.branch_end(b);
        }
    }
}

/// Variables: the state of one is the leaves that read its cells.
///
/// The functions that are not generic are compiled once: hooks split values, and pass leaves on.
impl Recorder {
    fn cells(name: &str, schema: &'static Schema) -> Vec<storage::Cell> {
        let mut cells = Vec::new();
        storage::cells(name, schema, &mut cells);
        cells
    }

    /// Returns the leaves that read `v`.
    fn read(&self, v: VarId, ty: Type) -> Vec<Id> {
        let value = self.builder(|b| b.settled(v)).unwrap_or_else(|| {
            let load = self.add(Expr::Load(v), ty);
            self.builder(|b| b.load_kinds(v, load));
            load
        });
        match ty {
            Type::Vector(_, n) => ["x", "y", "z", "w"]
                .into_iter()
                .take(n)
                .map(|c| self.add(Expr::Member(value, c), ty.component()))
                .collect(),
            _ => vec![value],
        }
    }

    fn new_cells(&self, name: &str, schema: &'static Schema, value: Option<Vec<Id>>) -> Vec<Id> {
        let mut values = value.map(Vec::into_iter);
        let mut state = Vec::new();
        for cell in Self::cells(name, schema) {
            let value = values.as_mut().map(|values| {
                let parts: Vec<Id> = values.by_ref().take(cell.leaves).collect();
                if parts.len() > 1 { self.vector(&parts) } else { parts[0] }
            });
            let v = self.builder(|b| {
                let v = b.new_var(&super::safe_name(&cell.name), cell.ty);
                if let Some(value) = value {
                    b.used(value);
                }
                b.push(Stmt::Var(v, value));
                if value.is_none() {
                    b.declare(v);
                }
                if let Some(all) = cell.kinds {
                    b.keep_kinds(v, all, value);
                }
                v
            });
            state.extend(self.read(v, cell.ty));
        }
        state
    }

    /// Returns the variables behind a state, with their types.
    fn vars_of(&self, schema: &'static Schema, state: Vec<Id>) -> Vec<(VarId, Type)> {
        let mut leaves = state.into_iter();
        let cells = Self::cells("", schema);
        let vars = cells.into_iter().filter_map(|cell| {
            let first = leaves.next()?;
            leaves.by_ref().take(cell.leaves - 1).for_each(drop);
            let load = match self.node(first).expr {
                Expr::Member(load, _) => load,
                _ => first,
            };
            match self.node(load).expr {
                Expr::Load(v) => Some((v, cell.ty)),
                _ => None,
            }
        });
        vars.collect()
    }

    /// Returns the leaves that read a variable now.
    fn read_all(&self, schema: &'static Schema, state: Vec<Id>) -> Vec<Id> {
        let vars = self.vars_of(schema, state).into_iter();
        vars.flat_map(|(v, ty)| self.read(v, ty)).collect()
    }

    fn store_all(&self, schema: &'static Schema, state: Vec<Id>, values: Vec<Id>) {
        let mut values = values.into_iter();
        for (var, ty) in self.vars_of(schema, state) {
            let value = match ty {
                Type::Vector(_, n) => {
                    let parts: Vec<Id> = values.by_ref().take(n).collect();
                    self.vector(&parts)
                }
                _ => values.next().expect("one leaf for each scalar of the schema"),
            };
            self.builder(|b| b.store(var, value));
        }
    }

    fn give_all(&self, schema: &'static Schema, leaves: Vec<Id>) {
        if leaves.is_empty() {
            self.builder(|b| b.push(Stmt::Return(None)));
        } else {
            self.give_leaves(schema, leaves);
        }
    }

    /// Selects one of two vectors.
    fn select_vector(&self, c: Id, a: &[Id], b: &[Id]) -> Id {
        let (a, b) = (self.vector(a), self.vector(b));
        let ty = self.node(a).ty;
        self.add(Expr::Select(c, a, b), ty)
    }

    fn captured(&self, name: &str, schema: &'static Schema, bytes: &[u8]) -> Vec<Id> {
        let mut leaves = Vec::new();
        storage::uniforms(self, name, schema, bytes, &mut leaves);
        leaves
    }

    fn name_leaves(&self, name: &'static str, leaves: &[Id]) {
        let whole = leaves.first().map(|l| self.node(*l).expr);
        self.builder(|b| {
            // If all are parts of one value, that value gets the name.
            let owner = match whole {
                Some(Expr::Member(a, _) | Expr::Element(a, _)) if leaves.len() > 1 => Some(a),
                _ if leaves.len() == 1 => Some(leaves[0]),
                _ => None,
            };
            let Some(mut id) = owner else { return };
            while let Expr::Member(a, _) | Expr::Element(a, _) = b.node(id).expr
                && leaves.len() > 1
            {
                id = a;
            }
            let node = b.node(id);
            if !node.expr.is_trivial() && node.name.is_none() {
                node.name = Some(name);
            }
        });
    }

    /// Selects what `arm(true)` records where `c` holds, else what `arm(false)` does.
    fn choose_leaves(
        &self,
        name: &'static str,
        calls: bool,
        c: Id,
        schema: &'static Schema,
        arm: &mut dyn FnMut(bool) -> Vec<Id>,
    ) -> Vec<Id> {
        if let Some(known) = self.truth(c) {
            return arm(known);
        }
        // As a statement a struct reads better than as a selection of each member, and calls run
        // for their own lanes only.
        if calls || matches!(schema, Schema::Struct { .. } | Schema::Array { .. }) {
            let cells = self.new_cells(name, schema, None);
            let branch = self.branch(c);
            self.branch_then(&branch);
            self.store_all(schema, cells.clone(), arm(true));
            self.branch_else(&branch);
            self.store_all(schema, cells.clone(), arm(false));
            self.branch_end(branch);
            return self.read_all(schema, cells);
        }
        let (a, b) = (arm(true), arm(false));
        if let Schema::Vector(..) = schema {
            let mut leaves = Vec::with_capacity(a.len());
            self.parts(schema, self.select_vector(c, &a, &b), &mut leaves);
            return leaves;
        }
        a.iter().zip(&b).map(|(&a, &b)| self.select(c, a, b, self.node(a).ty)).collect()
    }

    /// Records a function's `body`, unless WGSL has it built in, and calls it.
    fn call_leaves(
        &self,
        info: &'static KernelInfo,
        (args, result): (&'static Schema, &'static Schema),
        leaves: Vec<Id>,
        body: &mut dyn FnMut(&[Id]) -> Vec<Id>,
    ) -> Vec<Id> {
        if self.arithmetic == wgsl::Arithmetic::Fast
            && let Some(known) = info.known
            && let Some(result) = known.0.record_builtin(self, &leaves)
        {
            return result;
        }
        let kinds = self.builder(|b| b.kinds_among(args, &leaves));
        let operands = self.arguments(args, leaves);
        let params = self.begin_function(info, args, &kinds);
        let (function, kinds) = self.end_function(result, body(&params));
        if result.leaves() == 0 {
            return Vec::new();
        }
        let leaves = self.call_of(function, operands, result);
        self.builder(|b| b.know(result, &leaves, &kinds));
        leaves
    }

    /// Records a call of a recorded function and returns the leaves of its result.
    pub(super) fn call_of(
        &self,
        function: usize,
        operands: Vec<Id>,
        result: &'static Schema,
    ) -> Vec<Id> {
        let call = self.add(Expr::Call(function, operands), Type::of(result));
        self.all_parts(result, call)
    }
}

impl Machine for Recorder {
    type F32 = Id;
    type I32 = Id;
    type U32 = Id;
    type Bool = Id;
    type Branch = RecordedBranch;
    type Loop = RecordedLoop;
    const RUNS: bool = false;
    const HAS_VECTORS: bool = true;

    fn f32(&self, v: f32) -> Id {
        if v.is_finite() {
            return self.add(Expr::F32(v.to_bits()), Type::F32);
        }
        // WGSL has no literal for infinity and NaN.
        let name = if v.is_nan() { "nan" } else { "infinity" };
        self.uniform(name, Type::F32, vec![v.to_bits()])
    }
    fn i32(&self, v: i32) -> Id {
        self.add(Expr::I32(v), Type::I32)
    }
    fn u32(&self, v: u32) -> Id {
        self.add(Expr::U32(v), Type::U32)
    }
    fn bool(&self, v: bool) -> Id {
        self.add(Expr::Bool(v), Type::Bool)
    }
    fn f32_unary<O: Op<F32Unary>>(&self, _: O, a: Id) -> Id {
        self.float_unary(O::OP, a)
    }
    fn f32_binary<O: Op<F32Binary>>(&self, _: O, a: Id, b: Id) -> Id {
        self.float_binary(O::OP, a, b)
    }
    fn f32_mul_add(&self, a: Id, b: Id, c: Id) -> Id {
        self.add(Expr::MulAdd(a, b, c), Type::F32)
    }
    fn i32_binary<O: Op<IntBinary>>(&self, _: O, a: Id, b: Id) -> Id {
        self.signed_binary(O::OP, a, b)
    }
    fn u32_binary<O: Op<IntBinary>>(&self, _: O, a: Id, b: Id) -> Id {
        self.unsigned_binary(O::OP, a, b)
    }
    fn bool_binary<O: Op<BoolBinary>>(&self, _: O, a: Id, b: Id) -> Id {
        self.truth_binary(O::OP, a, b)
    }
    fn i32_neg(&self, a: Id) -> Id {
        if let Some(a) = self.i32_literal(a) {
            return self.i32(a.wrapping_neg());
        }
        self.add(Expr::Neg(a), Type::I32)
    }
    fn i32_not(&self, a: Id) -> Id {
        if let Some(a) = self.i32_literal(a) {
            return self.i32(!a);
        }
        self.add(Expr::Complement(a), Type::I32)
    }
    fn u32_not(&self, a: Id) -> Id {
        if let Some(a) = self.u32_literal(a) {
            return self.u32(!a);
        }
        self.add(Expr::Complement(a), Type::U32)
    }
    fn bool_not(&self, a: Id) -> Id {
        if let Some(v) = self.truth(a) {
            return self.bool(!v);
        }
        self.add(Expr::Not(a), Type::Bool)
    }
    fn f32_compare<O: Op<Compare>>(&self, _: O, a: Id, b: Id) -> Id {
        self.float_compare(O::OP, a, b)
    }
    fn i32_compare<O: Op<Compare>>(&self, _: O, a: Id, b: Id) -> Id {
        self.signed_compare(O::OP, a, b)
    }
    fn u32_compare<O: Op<Compare>>(&self, _: O, a: Id, b: Id) -> Id {
        self.unsigned_compare(O::OP, a, b)
    }
    fn f32_select(&self, c: Id, a: Id, b: Id) -> Id {
        self.select(c, a, b, Type::F32)
    }
    fn i32_select(&self, c: Id, a: Id, b: Id) -> Id {
        self.select(c, a, b, Type::I32)
    }
    fn u32_select(&self, c: Id, a: Id, b: Id) -> Id {
        self.select(c, a, b, Type::U32)
    }
    fn bool_select(&self, c: Id, a: Id, b: Id) -> Id {
        self.select(c, a, b, Type::Bool)
    }
    fn f32_to_i32(&self, a: Id) -> Id {
        if let Some(a) = self.literal(a) {
            return self.i32(a as i32);
        }
        self.add(Expr::Convert(Conversion::Saturate, a), Type::I32)
    }
    fn f32_to_u32(&self, a: Id) -> Id {
        if let Some(a) = self.literal(a) {
            return self.u32(a as u32);
        }
        self.add(Expr::Convert(Conversion::Saturate, a), Type::U32)
    }
    fn i32_to_f32(&self, a: Id) -> Id {
        if let Some(a) = self.i32_literal(a) {
            return self.f32(a as f32);
        }
        self.add(Expr::Convert(Conversion::To, a), Type::F32)
    }
    fn u32_to_f32(&self, a: Id) -> Id {
        if let Some(a) = self.u32_literal(a) {
            return self.f32(a as f32);
        }
        self.add(Expr::Convert(Conversion::To, a), Type::F32)
    }
    fn i32_to_u32(&self, a: Id) -> Id {
        if let Some(a) = self.i32_literal(a) {
            return self.u32(a as u32);
        }
        self.add(Expr::Convert(Conversion::Bits, a), Type::U32)
    }
    fn u32_to_i32(&self, a: Id) -> Id {
        if let Some(a) = self.u32_literal(a) {
            return self.i32(a as i32);
        }
        self.add(Expr::Convert(Conversion::Bits, a), Type::I32)
    }
    fn f32_to_bits(&self, a: Id) -> Id {
        if let Some(a) = self.literal(a) {
            return self.u32(a.to_bits());
        }
        self.add(Expr::Convert(Conversion::Bits, a), Type::U32)
    }
    fn f32_from_bits(&self, a: Id) -> Id {
        if let Some(a) = self.u32_literal(a) {
            return self.f32(f32::from_bits(a));
        }
        self.add(Expr::Convert(Conversion::Bits, a), Type::F32)
    }
    fn bool_to_u32(&self, a: Id) -> Id {
        if let Some(a) = self.truth(a) {
            return self.u32(u32::from(a));
        }
        self.add(Expr::Convert(Conversion::To, a), Type::U32)
    }

    fn vector_binary<O: Op<F32Binary>, const N: usize>(
        &self,
        _: O,
        mut a: [Id; N],
        b: [Id; N],
    ) -> [Id; N] {
        self.float_vectors(O::OP, &mut a, &b);
        a
    }
    fn vector_unary<O: Op<F32Unary>, const N: usize>(&self, _: O, mut a: [Id; N]) -> [Id; N] {
        self.float_vector(O::OP, &mut a);
        a
    }

    fn i32_vector_binary<O: Op<IntBinary>, const N: usize>(
        &self,
        _: O,
        mut a: [Id; N],
        b: [Id; N],
    ) -> [Id; N] {
        self.int_vectors(O::OP, Type::I32, &mut a, &b);
        a
    }
    fn u32_vector_binary<O: Op<IntBinary>, const N: usize>(
        &self,
        _: O,
        mut a: [Id; N],
        b: [Id; N],
    ) -> [Id; N] {
        self.int_vectors(O::OP, Type::U32, &mut a, &b);
        a
    }
    fn u32_unary<O: Op<U32Unary>>(&self, _: O, a: Id) -> Id {
        self.bits_unary(O::OP, a)
    }

    fn branch(&self, c: Id) -> RecordedBranch {
        let assumptions = self.builder(|b| b.assumptions());
        if self.truth(c).is_none() {
            self.builder(|b| {
                b.used(c);
                b.open_block();
                b.assume(assumptions, c, true);
            });
        }
        RecordedBranch { c, then: Default::default(), assumptions }
    }
    fn branch_then(&self, t: &RecordedBranch) -> bool {
        self.truth(t.c) != Some(false)
    }
    fn branch_else(&self, t: &RecordedBranch) -> bool {
        if let Some(c) = self.truth(t.c) {
            return !c;
        }
        let then = self.builder(|b| {
            let then = b.close_block();
            b.open_block();
            b.assume(t.assumptions, t.c, false);
            then
        });
        t.then.replace(Some(then));
        true
    }
    // Small, like `call`: every use in a kernel is a copy of it.
    #[inline]
    fn choose<V: Value<Self>>(
        &self,
        name: &'static str,
        calls: bool,
        c: B<Self>,
        a: impl FnOnce() -> V,
        b: impl FnOnce() -> V,
    ) -> V {
        let (mut a, mut b, mut value) = (Some(a), Some(b), None);
        let mut arm = |first: bool| {
            let v = if first { a.take().map(|a| a()) } else { b.take().map(|b| b()) };
            let v = v.expect("each arm is recorded once");
            self.leaves_of(*value.insert(v))
        };
        let leaves = self.choose_leaves(name, calls, c.0, V::SCHEMA, &mut arm);
        self.with_leaves(value.expect("an arm is recorded"), &leaves)
    }
    fn branch_end(&self, t: RecordedBranch) {
        if self.truth(t.c).is_some() {
            return;
        }
        self.builder(|b| {
            b.forget(t.assumptions);
            let last = b.close_block();
            let stmt = match t.then.take() {
                Some(then) => Stmt::If { c: t.c, then, otherwise: last },
                None => Stmt::If { c: t.c, then: last, otherwise: Vec::new() },
            };
            b.push(stmt);
        });
    }

    fn loop_begin(&self) -> RecordedLoop {
        let number = self.builder(|b| {
            // Loads before the loop may be stale in its second iteration.
            for v in &mut b.function.vars {
                v.version += 1;
            }
            let number = b.next_loop;
            b.next_loop += 1;
            b.loops.push(super::LoopState { number, ..Default::default() });
            b.open_block();
            number
        });
        let (body, continuing) = Default::default();
        RecordedLoop { number, body, continuing, start: self.start() }
    }
    fn loop_test(&self, l: &RecordedLoop, c: Id) -> bool {
        match self.truth(c) {
            Some(true) => return true,
            Some(false) => {
                self.loop_break(l);
                return false;
            }
            None => {}
        }
        self.builder(|b| {
            b.used(c);
            b.push(Stmt::BreakUnless(c));
        });
        true
    }
    fn loop_break(&self, l: &RecordedLoop) {
        self.exit(l.number, false);
    }
    fn loop_continue(&self, l: &RecordedLoop) {
        self.exit(l.number, true);
    }
    fn loop_continuing(&self, l: &RecordedLoop) {
        let body = self.builder(|b| {
            let body = b.close_block();
            b.open_block();
            body
        });
        l.body.replace(Some(body));
    }
    fn loop_again(&self, l: &RecordedLoop) -> bool {
        if self.restart(l) {
            return true;
        }
        let continuing = self.builder(|b| b.close_block());
        l.continuing.replace(Some(continuing));
        false
    }
    fn loop_end(&self, l: RecordedLoop) {
        let passing = self.builder(|b| {
            // A condition of the host may have left the loop in the middle of its body.
            let body = l.body.take().unwrap_or_else(|| b.close_block());
            let continuing = l.continuing.take().unwrap_or_default();
            b.push(Stmt::Loop { body, continuing });
            b.loops.pop().map(|l| l.passing).unwrap_or_default()
        });
        self.pass_on(passing);
    }

    fn alive(&self) -> bool {
        true
    }
    fn any(&self, _: Id) -> bool {
        true
    }

    fn var_new<V: Value<Self>>(&self, name: &'static str, v: V) -> V {
        self.with_leaves(v, &self.new_cells(name, V::SCHEMA, Some(self.leaves_of(v))))
    }
    fn var_declare<V: Value<Self>>(&self, name: &'static str) -> V {
        self.with_leaves(V::zero(self), &self.new_cells(name, V::SCHEMA, None))
    }
    fn var_get<V: Value<Self>>(&self, state: V) -> V {
        self.with_leaves(state, &self.read_all(V::SCHEMA, self.leaves_of(state)))
    }
    fn var_set<V: Value<Self>>(&self, state: V, v: V) -> V {
        self.store_all(V::SCHEMA, self.leaves_of(state), self.leaves_of(v));
        state
    }
    fn give<V: Value<Self>>(&self, _: &Cell<V>, v: V) {
        self.give_all(V::SCHEMA, self.leaves_of(v));
    }
    fn give_slot<V: Value<Self>>(&self) -> V {
        V::zero(self)
    }
    fn f32_beside_infinity<O: Op<Compare>>(&self, _: O, a: Id) -> Id {
        let size = self.u32_binary(op::And, self.f32_to_bits(a), self.u32(0x7fff_ffff));
        self.unsigned_compare(O::OP, size, self.u32(0x7f80_0000))
    }
    // Inlined, so that an edit recompiles the code of kernels, and not all of the recorder.
    #[inline]
    fn call<A: Value<Self>, R: Value<Self>>(
        &self,
        info: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        let (mut body, mut result) = (Some(body), None);
        let mut record = |params: &[Id]| {
            let body = body.take().expect("a body is recorded once");
            self.leaves_of(*result.insert(body(self, self.with_leaves(args, params))))
        };
        let schemas = (A::SCHEMA, R::SCHEMA);
        let leaves = self.call_leaves(info, schemas, self.leaves_of(args), &mut record);
        self.with_leaves(result.unwrap_or_else(|| R::zero(self)), &leaves)
    }

    fn capture<T: crate::machine::Type>(&self, name: &'static str, v: T) -> T::On<Self> {
        let mut bytes = vec![0; T::SCHEMA.size().max(size_of::<T>())];
        v.write(&mut bytes);
        self.of_leaves(&self.captured(name, T::SCHEMA, &bytes))
    }

    fn named<V: Value<Self>>(&self, name: &'static str, v: V) -> V {
        self.name_leaves(name, &self.leaves_of(v));
        v
    }

    fn perform<O: Operation>(
        &self,
        operation: &O,
        input: On<O::Input, Self>,
    ) -> On<O::Output, Self> {
        operation.on_recorder(self, input)
    }
    fn visit<T: Visit>(
        &self,
        items: &T,
        input: On<T::Input, Self>,
        limit: impl Fn() -> F<Self>,
        visit: impl Fn(On<T::Item, Self>) -> B<Self>,
    ) {
        items.on_recorder(self, input, limit, visit);
    }
    fn each<V: Value<Self>, const N: usize>(&self, mut f: impl FnMut(U<Self>) -> V) -> [V; N] {
        let all = Var::new(self, "each", [V::zero(self); N]);
        let i = Var::new(self, "i", U(self.u32(0)));
        let repeat = Loop::new(self);
        loop {
            let goes_on = self.u32_compare(op::Lt, i.get(self).0, self.u32(N as u32));
            repeat.test(self, B(goes_on));
            let v = f(i.get(self));
            let index = Usize(i.get(self).0);
            all.set(self, with_element(self, all.get(self), index, v));
            repeat.continuing(self);
            let next = self.u32_binary(op::WrappingAdd, i.get(self).0, self.u32(1));
            i.set(self, U(next));
            if !repeat.again(self) {
                break;
            }
        }
        repeat.end(self);
        all.get(self)
    }
    fn len<D: Data>(&self, data: &D) -> U<Self> {
        let function = self.len_function(data);
        U(self.add(Expr::Call(function, vec![]), Type::U32))
    }
    fn element<D: Data>(&self, data: &D, index: U<Self>) -> <D::Element as MachineType>::On<Self> {
        self.element_of(data, self.element_function(data), index.0)
    }
    fn fetch<D: Data>(&self, data: &D, index: U<Self>) -> <D::Element as MachineType>::On<Self> {
        self.element_of(data, self.fetch_function(data), index.0)
    }
}
