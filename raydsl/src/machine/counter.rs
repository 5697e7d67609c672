//! The counters of `for`.

use core::cell::Cell;

use super::{B, I, Loop, Machine, OpCompare, U, Usize, Value, Var, op};

/// The type of a counter.
pub trait Counter<M: Machine>: Value<M> + OpCompare<M, Self, Output = B<M>> {
    /// Its 32 bits.
    fn bits(self, m: &M) -> M::U32;
    /// The counter with these bits.
    fn of_bits(m: &M, bits: M::U32) -> Self;
    /// Whether `a < b`, as numbers of this type.
    fn is_less(a: u32, b: u32) -> bool;
    /// One more; the bound stops it before it overflows.
    fn next(self, m: &M) -> Self;
    /// One less.
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

/// The next value of a counter.
#[inline(always)]
pub fn increment<M: Machine, C: Counter<M>>(m: &M, a: C) -> C {
    a.next(m)
}

/// The value of a counter before this one.
#[inline(always)]
pub fn decrement<M: Machine, C: Counter<M>>(m: &M, a: C) -> C {
    a.previous(m)
}

/// A counter that all lanes begin with the same number: in every round it is one number, however
/// many lanes are left. A recorded loop has a variable for it.
pub struct Steps<C: Copy> {
    recorded: Option<Var<C>>,
    now: Cell<u32>,
}

impl<C: Copy> Steps<C> {
    /// Begins at `first`, whose bits are `bits`.
    #[inline(always)]
    pub fn new<M: Machine>(m: &M, name: &'static str, first: C, bits: u32) -> Self
    where
        C: Counter<M>,
    {
        let recorded = (!M::RUNS).then(|| Var::new(m, name, first));
        Self { recorded, now: Cell::new(bits) }
    }

    /// The counter.
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

    /// The counter of the running lanes, as its bits; for a recorded loop the first one's.
    #[inline(always)]
    pub fn bits(&self) -> u32 {
        self.now.get()
    }

    /// On to the next round.
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

/// The end of a range, which is one number for all lanes more often than not.
pub struct Stop<C> {
    value: C,
    bits: Option<u32>,
}

impl<C: Copy> Stop<C> {
    /// Before this number.
    #[inline(always)]
    pub fn new<M: Machine>(m: &M, value: C) -> Self
    where
        C: Counter<M>,
    {
        Self { value, bits: m.u32_same(&value.bits(m)) }
    }

    /// Tests whether a counter in step goes on; whether any lane does.
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
