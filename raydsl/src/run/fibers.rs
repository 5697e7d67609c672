//! Fibers: packets whose queries are answered in batches.
//!
//! Traversals are faster per ray the more rays a query has, and a packet has few. So several
//! packets run on one thread, each as a fiber with a stack of its own. A fiber that reaches a query
//! yields until the others have reached theirs or are done, and one of them then answers the
//! queries of all. On targets without fibers each packet answers its own query, with the same
//! results.

use core::any::Any;
use core::cell::{Cell, RefCell};
use core::ptr::NonNull;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use corosensei::stack::{DefaultStack, Stack, StackPointer};
use corosensei::{Coroutine, CoroutineResult, Yielder};

use super::{Key, Scratch};

/// The most fibers in a pool.
const MOST: usize = 64;

/// Bytes of address space of a stack, as for a main thread; unused pages take no memory.
const STACK: usize = 8 << 20;

/// The stack of a fiber. Stacks begin at different offsets within a page: all fibers run the same
/// code, and would compete for the same cache sets otherwise.
struct StaggeredStack {
    stack: DefaultStack,
    offset: usize,
}

impl StaggeredStack {
    fn new(index: usize) -> Option<Self> {
        let stack = DefaultStack::new(STACK).ok()?;
        Some(Self { stack, offset: index % 16 * 256 })
    }
}

// SAFETY: it is a stack with a guard page, shortened at its base by less than a page, and the base
// stays aligned to 256 bytes.
unsafe impl Stack for StaggeredStack {
    fn base(&self) -> StackPointer {
        // A stack is larger than the offset.
        StackPointer::new(self.stack.base().get() - self.offset).unwrap_or(self.stack.base())
    }

    fn limit(&self) -> StackPointer {
        self.stack.limit()
    }
}

/// The reason for which a fiber is resumed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Resume {
    /// It begins, or reads the results of its query.
    Continue,
    /// It answers its batch of queries first.
    Answer,
}

type Fiber = Coroutine<Resume, (), (), StaggeredStack>;

/// A pool of fibers that run on one thread.
#[derive(Default)]
pub(crate) struct FiberPool {
    /// Batches that more queries may join.
    open: RefCell<Vec<Batch>>,
    /// The batch whose fibers are being resumed.
    closed: Cell<Option<Batch>>,
    /// The index of the running fiber.
    running: Cell<usize>,
    yielder: Cell<Option<NonNull<Yielder<Resume, ()>>>>,
    /// Scratch memory of queries that is not in use.
    spare: RefCell<Vec<Box<dyn Any>>>,
    /// Stacks that are not in use.
    stacks: RefCell<Vec<StaggeredStack>>,
    /// The allocation for the fibers of a run, empty between runs.
    fibers: Cell<Vec<Option<Fiber>>>,
}

/// The queries of several packets that are answered as one.
struct Batch {
    key: Key,
    scratch: Box<dyn Any>,
    /// The fibers that wait, as a bit mask.
    waiting: u64,
}

thread_local! {
    /// The pool of this thread, kept from one run to the next.
    static KEPT: Cell<Option<Box<FiberPool>>> = const { Cell::new(None) };
    /// The pool whose fiber is running.
    static CURRENT: Cell<Option<NonNull<FiberPool>>> = const { Cell::new(None) };
}

/// A guard during which queries of this thread do not yield to other fibers, so that host code is
/// never suspended with locks held or jobs taken.
pub(crate) struct NoYield(Option<NonNull<FiberPool>>);

impl NoYield {
    pub(crate) fn begin() -> Self {
        Self(CURRENT.take())
    }
}

impl Drop for NoYield {
    fn drop(&mut self) {
        CURRENT.set(self.0);
    }
}

/// Runs `job` for each index below `count`, in a pool of up to `at_once` fibers whose queries are
/// answered in batches. A job without queries takes no further fiber.
pub(crate) fn each(count: usize, at_once: usize, job: &dyn Fn(usize)) {
    // Jobs that a fiber of an outer pool runs are not suspended for that pool.
    let _no_yield = NoYield::begin();
    let at_once = at_once.min(count).min(MOST);
    if at_once < 2 {
        (0..count).for_each(job);
        return;
    }
    let pool = KEPT.take().unwrap_or_default();
    let next = Cell::new(0);
    let jobs = || {
        let i = next.get();
        next.set(i + 1);
        (i < count).then_some(i)
    };
    if let Err(panic) = pool.run(at_once, &|| jobs().map(job).is_some()) {
        // The pool is dropped with its remaining fibers.
        resume_unwind(panic);
    }
    // If no stack could be allocated, the remaining jobs run on this one.
    while jobs().map(job).is_some() {}
    KEPT.set(Some(pool));
}

/// The payload of a panic.
type Panic = Box<dyn Any + Send>;

impl FiberPool {
    /// Runs `job` on up to `at_once` fibers, each repeatedly, until it returns false.
    fn run(&self, at_once: usize, job: &dyn Fn() -> bool) -> Result<(), Panic> {
        let mut fibers = self.fibers.take();
        for index in 0..at_once {
            let Some(stack) = self.stack(index) else { break };
            let run = |yielder: &Yielder<Resume, ()>, _: Resume| {
                self.yielder.set(Some(yielder.into()));
                while job() {}
            };
            // SAFETY: the borrows of the function outlive the fibers, which are dropped before this
            // call returns.
            fibers.push(Some(unsafe { Coroutine::with_stack_unchecked(stack, run) }));
            self.resume(&mut fibers, index, Resume::Continue)?;
            if fibers[index].is_none() {
                // It has run all remaining jobs.
                break;
            }
        }
        while let Some(batch) = self.close() {
            let mut waiting = batch.waiting;
            self.closed.set(Some(batch));
            let mut resume = Resume::Answer;
            while waiting != 0 {
                self.resume(&mut fibers, waiting.trailing_zeros() as usize, resume)?;
                waiting &= waiting - 1;
                resume = Resume::Continue;
            }
            self.spare.borrow_mut().extend(self.closed.take().map(|batch| batch.scratch));
        }
        fibers.clear();
        self.fibers.set(fibers);
        Ok(())
    }

    fn stack(&self, index: usize) -> Option<StaggeredStack> {
        self.stacks.borrow_mut().pop().or_else(|| StaggeredStack::new(index))
    }

    /// Returns empty scratch memory of a query.
    fn scratch<S: Scratch>(&self) -> Box<S> {
        let mut spare = self.spare.borrow_mut();
        let at = spare.iter().position(|scratch| scratch.is::<S>());
        let found = at.and_then(|at| spare.swap_remove(at).downcast().ok());
        let mut scratch: Box<S> = found.unwrap_or_default();
        scratch.clear();
        scratch
    }

    /// Resumes a fiber until it yields, or returns and is removed.
    fn resume(
        &self,
        fibers: &mut [Option<Fiber>],
        index: usize,
        resume: Resume,
    ) -> Result<(), Panic> {
        let Some(mut fiber) = fibers[index].take() else { return Ok(()) };
        self.running.set(index);
        CURRENT.set(Some(self.into()));
        let result = catch_unwind(AssertUnwindSafe(|| fiber.resume(resume)));
        CURRENT.set(None);
        match result? {
            CoroutineResult::Yield(()) => fibers[index] = Some(fiber),
            CoroutineResult::Return(()) => self.stacks.borrow_mut().push(fiber.into_stack()),
        }
        Ok(())
    }

    /// Removes and returns the open batch with the most waiting fibers.
    fn close(&self) -> Option<Batch> {
        let mut open = self.open.borrow_mut();
        let most = (0..open.len()).max_by_key(|&i| open[i].waiting.count_ones());
        most.map(|i| open.swap_remove(i))
    }
}

/// Downcasts the scratch memory of a batch.
fn memory<S: Scratch>(scratch: &mut Box<dyn Any>) -> &mut S {
    let Some(scratch) = scratch.downcast_mut() else {
        unreachable!("queries of a batch have the same type of scratch memory")
    };
    scratch
}

/// Answers a query in a batch with those of the other fibers of this thread. Returns false, and
/// does nothing, outside of a fiber.
///
/// `load` appends the packet's rays and returns the index of the first, `answer` traces all rays of
/// the batch, and `read` takes the packet's results.
pub(crate) fn ask<S: Scratch>(
    key: Key,
    load: impl FnOnce(&mut S) -> usize,
    answer: impl FnOnce(&mut S),
    read: impl FnOnce(&S, usize),
) -> bool {
    let Some(current) = CURRENT.get() else { return false };
    // SAFETY: a pool is current while one of its fibers runs, and is borrowed as long.
    let pool = unsafe { current.as_ref() };
    let first = {
        let mut open = pool.open.borrow_mut();
        let is_same = |batch: &Batch| batch.key == key && batch.scratch.is::<S>();
        let at = open.iter().position(is_same).unwrap_or_else(|| {
            let scratch: Box<dyn Any> = pool.scratch::<S>();
            open.push(Batch { key, scratch, waiting: 0 });
            open.len() - 1
        });
        open[at].waiting |= 1 << pool.running.get();
        load(memory(&mut open[at].scratch))
    };
    let Some(yielder) = pool.yielder.get() else { unreachable!("a fiber runs with its yielder") };
    // SAFETY: the yielder is that of the running fiber, whose function has not returned.
    let resume = unsafe { yielder.as_ref() }.suspend(());
    pool.yielder.set(Some(yielder));
    let Some(mut batch) = pool.closed.take() else {
        unreachable!("a fiber is resumed with its batch")
    };
    if resume == Resume::Answer {
        // A primitive may query another scene meanwhile, which does not yield then. If it panics,
        // so do all fibers: nothing on their stacks catches it.
        let _no_yield = NoYield::begin();
        answer(memory(&mut batch.scratch));
    }
    read(memory(&mut batch.scratch), first);
    pool.closed.set(Some(batch));
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

    /// Runs `count` packets with `times` queries each; returns the sizes of the batches.
    fn batch_sizes(count: usize, at_once: usize, times: impl Fn(usize) -> usize) -> Vec<usize> {
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
                    |_, first| assert_eq!(first, 100 * packet + time, "the index that it returned"),
                );
                assert!(asked || at_once < 2);
            }
            done.set(done.get() + 1);
        });
        assert_eq!(done.get(), count);
        sizes.into_inner()
    }

    #[test]
    fn queries_of_packets_are_batched() {
        assert_eq!(batch_sizes(8, 4, |_| 1), [4, 4]);
        assert_eq!(batch_sizes(10, 4, |_| 1), [4, 4, 2]);
        assert_eq!(batch_sizes(3, 64, |_| 1), [3]);
        assert_eq!(batch_sizes(300, 1000, |_| 0), [0; 0]);
        assert_eq!(batch_sizes(5, 1, |_| 1), [0; 0], "no fibers");
        let sizes = batch_sizes(100, 16, |packet| packet % 4);
        assert_eq!(sizes.iter().sum::<usize>(), 150, "{sizes:?}");
        assert!(sizes.len() < 20 && sizes.iter().all(|&n| n > 0 && n <= 16), "{sizes:?}");
    }

    /// A pool within a fiber, such as one that a job of a thread pool makes, runs to its end.
    #[test]
    fn nested_pools_do_not_wait_for_outer_ones() {
        let (count, held) = (Cell::new(0), RefCell::new(()));
        each(4, 4, &|_| {
            assert!(ask::<Nothing>((1, [0; 3]), |_| 0, |_| (), |_, _| ()));
            let _held = held.borrow_mut();
            assert_eq!(batch_sizes(6, 3, |_| 1), [3, 3]);
            let _no_yield = NoYield::begin();
            assert!(!ask::<Nothing>((2, [0; 3]), |_| 0, |_| (), |_, _| ()), "no batch");
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
            // Waiting fibers leave nothing behind.
            assert_eq!(dropped.get(), if at == 0 { 3 } else { 6 }, "{at}");
            assert_eq!(batch_sizes(8, 4, |_| 1), [4, 4]);
        }
    }
}
