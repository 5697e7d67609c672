//! Arena of the machine's floats.
//!
//! The data of a float take some ninety bytes. Lifted code passes its floats from one layer to the
//! next, and the compiler looks for copies to elide among all of them: for a long kernel that took
//! most of its time. So a float is a handle of eight bytes, and its data are in the arena.
//!
//! Nothing is dropped by itself. A loop notes the length of the arena at its start, and drops an
//! iteration's entries at the iteration's end. This is safe because values that outlive it were
//! given to variables, and those have *slots*, entries in front of the loop's that are overwritten.
//! The values of functions with early returns have slots too. Runs of decisions and visited
//! primitives end in the same way.

use core::cell::{Cell, RefCell};

use super::affine::Handle;
use super::interval::Interval;
use super::sums::Parts;

/// A float on [`Margin`](super::Margin): a handle of an entry in its arena.
///
/// It consists of the entry's index and above that a serial number that distinguishes it from
/// earlier entries there: one word for the compiler.
#[derive(Clone, Copy, Debug)]
pub struct Bounded(u64);

impl Bounded {
    fn new(at: usize, serial: u32) -> Self {
        Self(at as u64 | u64::from(serial) << 32)
    }

    fn at(self) -> usize {
        self.0 as u32 as usize
    }

    fn serial(self) -> u32 {
        (self.0 >> 32) as u32
    }
}

/// The data of a float: its `f64` value and bounds on the `f32` one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) value: f64,
    pub(crate) range: Interval,
    /// The value number: floats with the same id are the same value.
    pub(crate) id: u64,
    /// Its affine form, the errors that it carries.
    pub(crate) form: Handle,
    /// The addends into which a device that reorders sums may split it, if it is a sum or a
    /// product.
    pub(crate) parts: Option<Parts>,
}

#[derive(Debug)]
struct Entry {
    known: Known,
    serial: u32,
}

/// A length of the arena.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark(usize);

/// The floats of a machine.
#[derive(Debug, Default)]
pub(crate) struct Arena {
    entries: RefCell<Vec<Entry>>,
    /// The serial number of the next entry. It wraps after four thousand million, and one stale
    /// handle in as many would not be noticed.
    next: Cell<u32>,
    /// The greatest length of the arena so far.
    #[cfg(test)]
    most: Cell<usize>,
}

impl Arena {
    /// Stores a float.
    pub(super) fn put(&self, known: Known) -> Bounded {
        let serial = self.next.replace(self.next.get().wrapping_add(1));
        let mut entries = self.entries.borrow_mut();
        let float = Bounded::new(entries.len(), serial);
        entries.push(Entry { known, serial });
        #[cfg(test)]
        self.most.set(self.most.get().max(entries.len()));
        float
    }

    /// Returns the data of a float.
    pub(super) fn get(&self, float: Bounded) -> Known {
        match self.entries.borrow().get(float.at()) {
            Some(entry) if entry.serial == float.serial() => entry.known,
            _ => gone(float),
        }
    }

    /// Overwrites a slot.
    pub(super) fn set(&self, slot: Bounded, known: Known) {
        match self.entries.borrow_mut().get_mut(slot.at()) {
            Some(entry) if entry.serial == slot.serial() => entry.known = known,
            _ => gone(slot),
        }
    }

    pub(crate) fn mark(&self) -> Mark {
        Mark(self.entries.borrow().len())
    }

    /// Drops everything stored since `mark`.
    pub(crate) fn drop_since(&self, mark: Mark) {
        self.entries.borrow_mut().truncate(mark.0);
    }

    /// Returns the greatest number of floats stored at once.
    #[cfg(test)]
    pub(crate) fn most(&self) -> usize {
        self.most.get()
    }
}

/// Panics, rather than using another float's value.
#[cold]
#[inline(never)]
fn gone(float: Bounded) -> ! {
    panic!(
        "raydsl has a bug: {float:?} of the machine `Margin` was dropped before its last use; a \
         value that outlives a round of a loop must be in a variable"
    )
}

#[cfg(test)]
mod tests {
    use super::super::{Machine, Margin, Rounding, op};
    use crate::machine::{F, Loop, Var};

    #[test]
    fn variables_outlive_rounds() {
        let m = Margin::new(Rounding::IEEE);
        let sum = Var::new(&m, "sum", F(m.f32(0.0)));
        let (rounds, mut left) = (Loop::new(&m), 3);
        loop {
            let before = sum.get(&m);
            sum.set(&m, F(m.f32_binary(op::Add, before.0, m.f32(2.0))));
            assert_eq!(m.get(before.0).value, 2.0 * f64::from(3 - left));
            left -= 1;
            if left == 0 {
                rounds.leave(&m);
            }
            rounds.continuing(&m);
            if !rounds.again(&m) {
                break;
            }
        }
        rounds.end(&m);
        assert_eq!(m.get(sum.get(&m).0).value, 6.0);
    }

    #[test]
    #[should_panic(expected = "dropped before its last use")]
    fn floats_of_a_round_are_gone() {
        let m = Margin::new(Rounding::IEEE);
        let rounds = Loop::new(&m);
        let kept = m.f32(1.0);
        assert!(rounds.again(&m));
        m.f32_binary(op::Add, kept, kept);
    }

    /// Tests that a stale handle is detected when another float has taken its place.
    #[test]
    #[should_panic(expected = "dropped before its last use")]
    fn another_float_is_not_taken_for_one_that_is_gone() {
        let m = Margin::new(Rounding::IEEE);
        let rounds = Loop::new(&m);
        let kept = m.f32(1.0);
        assert!(rounds.again(&m));
        let other = m.f32(2.0);
        m.f32_binary(op::Add, other, kept);
    }

    #[test]
    #[should_panic(expected = "dropped before its last use")]
    fn slots_of_a_round_are_gone() {
        let m = Margin::new(Rounding::IEEE);
        let rounds = Loop::new(&m);
        let within = Var::new(&m, "within", F(m.f32(1.0)));
        assert!(rounds.again(&m));
        let other = F(m.f32(2.0));
        within.set(&m, other);
    }
}
