//! Packets that wait for each other.
//!
//! A tree is quicker for each ray, the more rays it is asked about at once, and a packet asks about
//! its own only. So several packets run in turn on one thread, each on a stack of its own (a
//! fiber): one that asks waits until the others ask too, or are done, and then one of them asks for
//! all. Where a machine has no such stacks, each packet asks for itself, and finds the same.

use core::any::Any;
use core::cell::{Cell, RefCell};
use core::ptr::NonNull;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use corosensei::stack::{DefaultStack, Stack, StackPointer};
use corosensei::{Coroutine, CoroutineResult, Yielder};

use super::{Key, Scratch};

/// How many packets may go on together.
const MOST: usize = 64;

/// Bytes of address space for a stack, as a main thread has; what is not used is never memory.
const STACK: usize = 8 << 20;

/// A packet's stack. Stacks begin at different places within a page: what runs on one would else
/// take the caches' lines from what runs on the others, which does the same.
struct Stagger {
    stack: DefaultStack,
    offset: usize,
}

impl Stagger {
    fn new(number: usize) -> Option<Self> {
        let stack = DefaultStack::new(STACK).ok()?;
        Some(Self { stack, offset: number % 16 * 256 })
    }
}

// SAFETY: it is a stack with a guard page, without less than a page at its base, which stays
// aligned to 256 bytes.
unsafe impl Stack for Stagger {
    fn base(&self) -> StackPointer {
        // A stack is larger than what is left out.
        StackPointer::new(self.stack.base().get() - self.offset).unwrap_or(self.stack.base())
    }

    fn limit(&self) -> StackPointer {
        self.stack.limit()
    }
}

/// What a packet that has waited does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    /// It begins, or reads what has been found.
    GoOn,
    /// It asks for all that wait as it does.
    Ask,
}

type Fiber = Coroutine<Turn, (), (), Stagger>;

/// Packets that go on together.
#[derive(Default)]
pub(crate) struct Crew {
    /// Queries that more packets may join.
    open: RefCell<Vec<Batch>>,
    /// That whose packets are going on.
    closed: Cell<Option<Batch>>,
    /// The number of the packet that is running.
    running: Cell<usize>,
    yielder: Cell<Option<NonNull<Yielder<Turn, ()>>>>,
    /// Memory of queries, and stacks, that no one uses.
    spare: RefCell<Vec<Box<dyn Any>>>,
    stacks: RefCell<Vec<Stagger>>,
    /// Room for the fibers of a run, of which there are none between two.
    fibers: Cell<Vec<Option<Fiber>>>,
}

/// What several packets ask.
struct Batch {
    key: Key,
    scratch: Box<dyn Any>,
    /// The packets that wait, a bit each.
    waiting: u64,
}

thread_local! {
    /// Kept from one crew of a thread to the next.
    static KEPT: Cell<Option<Box<Crew>>> = const { Cell::new(None) };
    /// The crew whose packet is running.
    static CURRENT: Cell<Option<NonNull<Crew>>> = const { Cell::new(None) };
}

/// While it is there, no packet of this thread waits for others: nothing of the host's is left
/// halfway, with its locks held and its jobs taken.
pub(crate) struct Alone(Option<NonNull<Crew>>);

impl Alone {
    pub(crate) fn begin() -> Self {
        Self(CURRENT.take())
    }
}

impl Drop for Alone {
    fn drop(&mut self) {
        CURRENT.set(self.0);
    }
}

/// Runs `job` for each number below `count`, `at_once` of them in turn so that their queries are
/// answered together. One that never asks takes no stack from the others.
pub(crate) fn each(count: usize, at_once: usize, job: &dyn Fn(usize)) {
    // What a packet of another crew runs it runs to the end.
    let _alone = Alone::begin();
    let at_once = at_once.min(count).min(MOST);
    if at_once < 2 {
        (0..count).for_each(job);
        return;
    }
    let crew = KEPT.take().unwrap_or_default();
    let next = Cell::new(0);
    let jobs = || {
        let i = next.get();
        next.set(i + 1);
        (i < count).then_some(i)
    };
    if let Err(panic) = crew.run(at_once, &|| jobs().map(job).is_some()) {
        // What is left of the crew goes with it.
        resume_unwind(panic);
    }
    // A stack may have been missing, and then the rest is done on this one.
    while jobs().map(job).is_some() {}
    KEPT.set(Some(crew));
}

/// What a packet panicked with.
type Panic = Box<dyn Any + Send>;

impl Crew {
    /// Runs `job` again and again, by as many fibers in turn, until it says that there are none left.
    fn run(&self, at_once: usize, job: &dyn Fn() -> bool) -> Result<(), Panic> {
        let mut fibers = self.fibers.take();
        for number in 0..at_once {
            let Some(stack) = self.stack(number) else { break };
            let run = |yielder: &Yielder<Turn, ()>, _: Turn| {
                self.yielder.set(Some(yielder.into()));
                while job() {}
            };
            // SAFETY: what the function borrows outlives the fibers, which are dropped before this
            // call returns.
            fibers.push(Some(unsafe { Coroutine::with_stack_unchecked(stack, run) }));
            self.resume(&mut fibers, number, Turn::GoOn)?;
            if fibers[number].is_none() {
                // It has done all jobs that were left.
                break;
            }
        }
        while let Some(batch) = self.close() {
            let mut waiting = batch.waiting;
            self.closed.set(Some(batch));
            let mut turn = Turn::Ask;
            while waiting != 0 {
                self.resume(&mut fibers, waiting.trailing_zeros() as usize, turn)?;
                waiting &= waiting - 1;
                turn = Turn::GoOn;
            }
            self.spare.borrow_mut().extend(self.closed.take().map(|batch| batch.scratch));
        }
        fibers.clear();
        self.fibers.set(fibers);
        Ok(())
    }

    fn stack(&self, number: usize) -> Option<Stagger> {
        self.stacks.borrow_mut().pop().or_else(|| Stagger::new(number))
    }

    /// Memory in which nothing is asked.
    fn scratch<S: Scratch>(&self) -> Box<S> {
        let mut spare = self.spare.borrow_mut();
        let at = spare.iter().position(|scratch| scratch.is::<S>());
        let found = at.and_then(|at| spare.swap_remove(at).downcast().ok());
        let mut scratch: Box<S> = found.unwrap_or_default();
        scratch.clear();
        scratch
    }

    /// Lets a fiber go on until it waits, or is done and no more there.
    fn resume(&self, fibers: &mut [Option<Fiber>], number: usize, turn: Turn) -> Result<(), Panic> {
        let Some(mut fiber) = fibers[number].take() else { return Ok(()) };
        self.running.set(number);
        CURRENT.set(Some(self.into()));
        let result = catch_unwind(AssertUnwindSafe(|| fiber.resume(turn)));
        CURRENT.set(None);
        match result? {
            CoroutineResult::Yield(()) => fibers[number] = Some(fiber),
            CoroutineResult::Return(()) => self.stacks.borrow_mut().push(fiber.into_stack()),
        }
        Ok(())
    }

    /// Takes the query for which most packets wait.
    fn close(&self) -> Option<Batch> {
        let mut open = self.open.borrow_mut();
        let most = (0..open.len()).max_by_key(|&i| open[i].waiting.count_ones());
        most.map(|i| open.swap_remove(i))
    }
}

/// The memory of a query of this type.
fn memory<S: Scratch>(scratch: &mut Box<dyn Any>) -> &mut S {
    let Some(scratch) = scratch.downcast_mut() else {
        unreachable!("a query is joined by those with the same memory")
    };
    scratch
}

/// Asks together with the other packets of this thread; not if there are none.
///
/// `load` writes rays behind those that are there, and says where they begin. `answer` finds what
/// all of them meet, and `read` takes what is the packet's own.
pub(crate) fn ask<S: Scratch>(
    key: Key,
    load: impl FnOnce(&mut S) -> usize,
    answer: impl FnOnce(&mut S),
    read: impl FnOnce(&S, usize),
) -> bool {
    let Some(current) = CURRENT.get() else { return false };
    // SAFETY: a crew is current while one of its fibers runs, and is borrowed as long.
    let crew = unsafe { current.as_ref() };
    let first = {
        let mut open = crew.open.borrow_mut();
        let is_same = |batch: &Batch| batch.key == key && batch.scratch.is::<S>();
        let at = open.iter().position(is_same).unwrap_or_else(|| {
            let scratch: Box<dyn Any> = crew.scratch::<S>();
            open.push(Batch { key, scratch, waiting: 0 });
            open.len() - 1
        });
        open[at].waiting |= 1 << crew.running.get();
        load(memory(&mut open[at].scratch))
    };
    let Some(yielder) = crew.yielder.get() else { unreachable!("a fiber runs with its yielder") };
    // SAFETY: it is that of the fiber which runs, whose function has not returned.
    let turn = unsafe { yielder.as_ref() }.suspend(());
    crew.yielder.set(Some(yielder));
    let Some(mut batch) = crew.closed.take() else {
        unreachable!("a fiber goes on with its query")
    };
    if turn == Turn::Ask {
        // A primitive may ask another scene meanwhile, and does not wait then. If it panics, so do
        // all packets: nothing on their stacks catches it.
        let _alone = Alone::begin();
        answer(memory(&mut batch.scratch));
    }
    read(memory(&mut batch.scratch), first);
    crew.closed.set(Some(batch));
    true
}

#[cfg(test)]
mod tests {
    use std::panic::catch_unwind;

    use super::*;

    #[derive(Default)]
    struct Nothing;

    impl Scratch for Nothing {
        fn clear(&mut self) {}
    }

    /// Asks once for each of some packets, and notes how many were asked about together.
    fn asked_together(count: usize, at_once: usize, times: impl Fn(usize) -> usize) -> Vec<usize> {
        let (waiting, sizes) = (RefCell::new([0; 3]), RefCell::new(Vec::new()));
        let done = Cell::new(0);
        each(count, at_once, &|packet| {
            for time in 0..times(packet) {
                let asked = ask::<Nothing>(
                    (1, [time; 3]),
                    |_| {
                        waiting.borrow_mut()[time] += 1;
                        100 * packet + time
                    },
                    |_| sizes.borrow_mut().push(core::mem::take(&mut waiting.borrow_mut()[time])),
                    |_, first| assert_eq!(first, 100 * packet + time, "what it wrote"),
                );
                assert!(asked || at_once < 2);
            }
            done.set(done.get() + 1);
        });
        assert_eq!(done.get(), count);
        sizes.into_inner()
    }

    #[test]
    fn packets_ask_together() {
        assert_eq!(asked_together(8, 4, |_| 1), [4, 4]);
        assert_eq!(asked_together(10, 4, |_| 1), [4, 4, 2]);
        assert_eq!(asked_together(3, 64, |_| 1), [3]);
        assert_eq!(asked_together(300, 1000, |_| 0), [0; 0]);
        assert_eq!(asked_together(5, 1, |_| 1), [0; 0], "alone");
        let sizes = asked_together(100, 16, |packet| packet % 4);
        assert_eq!(sizes.iter().sum::<usize>(), 150, "{sizes:?}");
        assert!(sizes.len() < 20 && sizes.iter().all(|&n| n > 0 && n <= 16), "{sizes:?}");
    }

    /// What runs within a packet, as a job that a thread of a pool takes up while it waits, does so
    /// to its end.
    #[test]
    fn crews_within_crews_do_not_wait_for_them() {
        let (count, held) = (Cell::new(0), RefCell::new(()));
        each(4, 4, &|_| {
            assert!(ask::<Nothing>((1, [0; 3]), |_| 0, |_| (), |_, _| ()));
            let _held = held.borrow_mut();
            assert_eq!(asked_together(6, 3, |_| 1), [3, 3]);
            let _alone = Alone::begin();
            assert!(!ask::<Nothing>((2, [0; 3]), |_| 0, |_| (), |_, _| ()), "alone");
            count.set(count.get() + 1);
        });
        assert_eq!(count.get(), 4);
    }

    #[test]
    fn panics_reach_the_caller() {
        struct Dropped<'a>(&'a Cell<usize>);
        impl Drop for Dropped<'_> {
            fn drop(&mut self) {
                self.0.set(self.0.get() + 1);
            }
        }
        for at in 0..3 {
            let dropped = Cell::new(0);
            let run = AssertUnwindSafe(|| {
                each(6, 4, &|packet| {
                    let _dropped = Dropped(&dropped);
                    let panic_at = |place: usize| assert!(packet != 2 || at != place, "{place}");
                    panic_at(0);
                    ask::<Nothing>((1, [0; 3]), |_| 0, |_| panic_at(1), |_, _| panic_at(1));
                    panic_at(2);
                });
            });
            let panic = catch_unwind(run).expect_err("a packet panics");
            assert_eq!(panic.downcast_ref::<String>().map(String::as_str), Some(&*at.to_string()));
            // Those that wait leave nothing behind.
            assert_eq!(dropped.get(), if at == 0 { 3 } else { 6 }, "{at}");
            assert_eq!(asked_together(8, 4, |_| 1), [4, 4]);
        }
    }
}
