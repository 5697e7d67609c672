//! Structured control flow of lifted code: variables, branches and loops.

use core::cell::Cell;

use super::{B, Machine, Value};

/// A `let mut` of a kernel: a read takes a snapshot, an assignment reaches the running lanes only.
pub struct Var<V: Copy> {
    state: Cell<V>,
}

impl<V: Copy> Var<V> {
    /// Creates a variable that holds `v`.
    #[inline(always)]
    pub fn new<M: Machine>(m: &M, name: &'static str, v: V) -> Self
    where
        V: Value<M>,
    {
        Self { state: Cell::new(m.var_new(name, v)) }
    }

    /// Creates a variable that is assigned before it is read.
    #[inline(always)]
    pub fn declare<M: Machine>(m: &M, name: &'static str) -> Self
    where
        V: Value<M>,
    {
        Self { state: Cell::new(m.var_declare(name)) }
    }

    /// Returns the current value.
    #[inline(always)]
    pub fn get<M: Machine>(&self, m: &M) -> V
    where
        V: Value<M>,
    {
        m.var_get(self.state.get())
    }

    /// Assigns in the running lanes.
    #[inline(always)]
    pub fn set<M: Machine>(&self, m: &M, v: V)
    where
        V: Value<M>,
    {
        self.state.set(m.var_set(self.state.get(), v));
    }
}

/// The value of a function with early returns.
pub struct Ret<V: Copy> {
    slot: Cell<V>,
}

impl<V: Copy> Ret<V> {
    /// Creates the slot, before any lane has returned.
    #[inline(always)]
    pub fn new<M: Machine>(m: &M) -> Self
    where
        V: Value<M>,
    {
        Self { slot: Cell::new(m.give_slot()) }
    }

    /// Lowers `return v`: stores `v` for the running lanes and stops them.
    #[inline(always)]
    pub fn give<M: Machine>(&self, m: &M, v: V)
    where
        V: Value<M>,
    {
        m.give(&self.slot, v);
    }

    /// Returns the value that each lane returned.
    #[inline(always)]
    pub fn take(self) -> V {
        self.slot.get()
    }
}

/// The condition of an `if` or a `while`: a truth value of the machine or of the host.
///
/// A host condition is decided while the kernel is recorded: the arm not taken leaves no trace.
#[diagnostic::on_unimplemented(
    message = "a condition must be a `bool`",
    label = "not a truth value",
    note = "compare it, as in `n != 0`"
)]
pub trait Condition<M: Machine>: Copy {
    /// The state of an `if` over such a condition.
    type State;
    /// Begins an `if`.
    fn begin(self, m: &M) -> Self::State;
    /// Returns whether to run the first arm.
    fn then(m: &M, state: &Self::State) -> bool;
    /// Returns whether to run the second arm.
    fn otherwise(m: &M, state: &Self::State) -> bool;
    /// Returns the same as `then`, for an arm that costs less than a test.
    fn then_small(m: &M, state: &Self::State) -> bool;
    /// Returns the same as `otherwise`, for such an arm.
    fn otherwise_small(m: &M, state: &Self::State) -> bool;
    /// Joins the arms.
    fn end(m: &M, state: Self::State);
    /// Selects one of two values, for a variable called `name`. `calls` says that they call
    /// functions, so each is evaluated for its own lanes only.
    fn choose<V: Value<M>>(
        self,
        m: &M,
        name: &'static str,
        calls: bool,
        a: impl FnOnce() -> V,
        b: impl FnOnce() -> V,
    ) -> V;
    /// Tests the condition of a loop.
    fn test(self, m: &M, l: &M::Loop) -> bool;
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Condition<M> for B<M> {
    type State = M::Branch;

    #[inline(always)]
    fn begin(self, m: &M) -> M::Branch {
        m.branch(self.0)
    }

    #[inline(always)]
    fn then(m: &M, state: &M::Branch) -> bool {
        m.branch_then(state)
    }

    #[inline(always)]
    fn otherwise(m: &M, state: &M::Branch) -> bool {
        m.branch_else(state)
    }

    #[inline(always)]
    fn then_small(m: &M, state: &M::Branch) -> bool {
        m.branch_then_small(state)
    }

    #[inline(always)]
    fn otherwise_small(m: &M, state: &M::Branch) -> bool {
        m.branch_else_small(state)
    }

    #[inline(always)]
    fn end(m: &M, state: M::Branch) {
        m.branch_end(state);
    }

    #[inline(always)]
    fn choose<V: Value<M>>(
        self,
        m: &M,
        name: &'static str,
        calls: bool,
        a: impl FnOnce() -> V,
        b: impl FnOnce() -> V,
    ) -> V {
        m.choose(name, calls, self, a, b)
    }

    #[inline(always)]
    fn test(self, m: &M, l: &M::Loop) -> bool {
        m.loop_test(l, self.0)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Condition<M> for bool {
    type State = bool;

    #[inline(always)]
    fn begin(self, _: &M) -> bool {
        self
    }

    #[inline(always)]
    fn then(_: &M, state: &bool) -> bool {
        *state
    }

    #[inline(always)]
    fn otherwise(_: &M, state: &bool) -> bool {
        !*state
    }

    #[inline(always)]
    fn then_small(_: &M, state: &bool) -> bool {
        *state
    }

    #[inline(always)]
    fn otherwise_small(_: &M, state: &bool) -> bool {
        !*state
    }

    #[inline(always)]
    fn end(_: &M, _: bool) {}

    #[inline(always)]
    fn choose<V: Value<M>>(
        self,
        _: &M,
        _: &'static str,
        _: bool,
        a: impl FnOnce() -> V,
        b: impl FnOnce() -> V,
    ) -> V {
        if self { a() } else { b() }
    }

    #[inline(always)]
    fn test(self, m: &M, l: &M::Loop) -> bool {
        if !self {
            m.loop_break(l);
        }
        self
    }
}

/// An `if` of lifted code.
pub struct Branch<M: Machine, C: Condition<M>> {
    state: C::State,
}

impl<M: Machine, C: Condition<M>> Branch<M, C> {
    /// Begins the `if`.
    #[inline(always)]
    pub fn new(m: &M, c: C) -> Self {
        Self { state: c.begin(m) }
    }

    /// Returns whether to run the first arm.
    #[inline(always)]
    pub fn then(&self, m: &M) -> bool {
        C::then(m, &self.state)
    }

    /// Returns whether to run the second arm.
    #[inline(always)]
    pub fn otherwise(&self, m: &M) -> bool {
        C::otherwise(m, &self.state)
    }

    /// Returns the same as [`Branch::then`], for an arm that costs less than a test.
    #[inline(always)]
    pub fn then_small(&self, m: &M) -> bool {
        C::then_small(m, &self.state)
    }

    /// Returns the same as [`Branch::otherwise`], for an arm that costs less than a test.
    #[inline(always)]
    pub fn otherwise_small(&self, m: &M) -> bool {
        C::otherwise_small(m, &self.state)
    }

    /// Joins the arms.
    #[inline(always)]
    pub fn end(self, m: &M) {
        C::end(m, self.state);
    }
}

/// A loop of lifted code.
///
/// Values that outlive an iteration are in a [`Var`] or a [`Ret`]: everything else that an
/// iteration computed may be gone after it.
pub struct Loop<M: Machine> {
    state: M::Loop,
}

impl<M: Machine> Loop<M> {
    /// Begins the loop.
    #[inline(always)]
    pub fn new(m: &M) -> Self {
        Self { state: m.loop_begin() }
    }

    /// Tests the condition and returns whether any lane goes on.
    #[inline(always)]
    pub fn test(&self, m: &M, c: impl Condition<M>) -> bool {
        c.test(m, &self.state)
    }

    /// Lowers `break`, for the running lanes.
    #[inline(always)]
    pub fn leave(&self, m: &M) {
        m.loop_break(&self.state);
    }

    /// Lowers `continue`, for the running lanes.
    #[inline(always)]
    pub fn skip(&self, m: &M) {
        m.loop_continue(&self.state);
    }

    /// Ends the body: lanes that said `continue` run again.
    #[inline(always)]
    pub fn continuing(&self, m: &M) {
        m.loop_continuing(&self.state);
    }

    /// Returns whether to run another iteration. A recorder runs the body again if it assumed too
    /// little of it.
    #[inline(always)]
    #[must_use]
    pub fn again(&self, m: &M) -> bool {
        m.loop_again(&self.state)
    }

    /// Leaves the loop.
    #[inline(always)]
    pub fn end(self, m: &M) {
        m.loop_end(self.state);
    }
}
