//! Loop counters of `for`.

use core::cell::Cell;

use super::{B, I, Loop, Machine, OpCompare, U, Usize, Value, Var, op};

/// A counter type.
pub trait Counter<M: Machine>: Value<M> + OpCompare<M, Self, Output = B<M>> {
    /// Returns its 32 bits.
    fn bits(self, m: &M) -> M::U32;
    /// Returns the counter with these bits.
    fn of_bits(m: &M, bits: M::U32) -> Self;
    /// Returns whether `a < b`, as numbers of this type.
    fn is_less(a: u32, b: u32) -> bool;
    /// Returns the counter plus one; the loop's bound prevents overflow.
    fn next(self, m: &M) -> Self;
    /// Returns the counter minus one.
    fn previous(self, m: &M) -> Self;
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Counter<M> for I<M> {
    #[inline(always)]
    fn bits(self, m: &M) -> M::U32 {
        m.i32_to_u32(self.0)
    }
    #[inline(always)]
    fn of_bits(m: &M, bits: M::U32) -> Self {
        I(m.u32_to_i32(bits))
    }
    #[inline(always)]
    fn is_less(a: u32, b: u32) -> bool {
        (a as i32) < b as i32
    }
    #[inline(always)]
    fn next(self, m: &M) -> Self {
        I(m.i32_binary(op::WrappingAdd, self.0, m.i32(1)))
    }
    #[inline(always)]
    fn previous(self, m: &M) -> Self {
        I(m.i32_binary(op::WrappingSub, self.0, m.i32(1)))
    }
}

macro_rules! unsigned_counter {
    ($($t:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Counter<M> for $t<M> {
                #[inline(always)]
                fn bits(self, _: &M) -> M::U32 {
                    self.0
                }
                #[inline(always)]
                fn of_bits(_: &M, bits: M::U32) -> Self {
                    $t(bits)
                }
                #[inline(always)]
                fn is_less(a: u32, b: u32) -> bool {
                    a < b
                }
                #[inline(always)]
                fn next(self, m: &M) -> Self {
                    $t(m.u32_binary(op::WrappingAdd, self.0, m.u32(1)))
                }
                #[inline(always)]
                fn previous(self, m: &M) -> Self {
                    $t(m.u32_binary(op::WrappingSub, self.0, m.u32(1)))
                }
            }
        )+
    };
}

unsigned_counter!(U, Usize);

/// Returns the next value of a counter.
#[inline(always)]
pub fn increment<M: Machine, C: Counter<M>>(m: &M, a: C) -> C {
    a.next(m)
}

/// Returns the previous value of a counter.
#[inline(always)]
pub fn decrement<M: Machine, C: Counter<M>>(m: &M, a: C) -> C {
    a.previous(m)
}

/// A uniform counter, which starts at the same number in all lanes: in every iteration it is one
/// number, however many lanes are left. A recorded loop has a variable for it.
pub struct Steps<C: Copy> {
    recorded: Option<Var<C>>,
    now: Cell<u32>,
}

impl<C: Copy> Steps<C> {
    /// Creates a counter at `first`, whose bits are `bits`.
    #[inline(always)]
    pub fn new<M: Machine>(m: &M, name: &'static str, first: C, bits: u32) -> Self
    where
        C: Counter<M>,
    {
        let recorded = (!M::RUNS).then(|| Var::new(m, name, first));
        Self { recorded, now: Cell::new(bits) }
    }

    /// Returns the counter.
    #[inline(always)]
    pub fn get<M: Machine>(&self, m: &M) -> C
    where
        C: Counter<M>,
    {
        match &self.recorded {
            Some(var) => var.get(m),
            None => C::of_bits(m, m.u32(self.now.get())),
        }
    }

    /// Returns the bits of the running lanes' counter; in a recorded loop those of the first
    /// iteration.
    #[inline(always)]
    pub fn bits(&self) -> u32 {
        self.now.get()
    }

    /// Advances to the next iteration.
    #[inline(always)]
    pub fn advance<M: Machine>(&self, m: &M)
    where
        C: Counter<M>,
    {
        match &self.recorded {
            Some(var) => var.set(m, var.get(m).next(m)),
            None => self.now.set(self.now.get().wrapping_add(1)),
        }
    }
}

/// The end of a range, which is usually the same number in all lanes.
pub struct Stop<C> {
    value: C,
    bits: Option<u32>,
}

impl<C: Copy> Stop<C> {
    /// Creates the exclusive end `value`.
    #[inline(always)]
    pub fn new<M: Machine>(m: &M, value: C) -> Self
    where
        C: Counter<M>,
    {
        Self { value, bits: m.u32_same(&value.bits(m)) }
    }

    /// Tests a uniform counter against the end and returns whether any lane goes on.
    #[inline(always)]
    pub fn is_after<M: Machine>(&self, m: &M, repeat: &Loop<M>, steps: &Steps<C>) -> bool
    where
        C: Counter<M>,
    {
        match self.bits {
            Some(stop) => {
                let goes_on = C::is_less(steps.bits(), stop);
                if !goes_on {
                    repeat.leave(m);
                }
                goes_on
            }
            None => repeat.test(m, C::compare(m, op::Lt, steps.get(m), self.value)),
        }
    }
}
