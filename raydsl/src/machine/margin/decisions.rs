//! Decisions left open by rounding, and the exploration of all their outcomes.

use core::cell::{Cell, RefCell};
use std::collections::{HashMap, VecDeque};

/// The limit on loop iterations in all runs of one input.
const ROUNDS: u64 = 1 << 18;
/// The limit on loop iterations in all runs but the first: a path other than that of `f64` may
/// never end.
const ROUNDS_ASIDE: u64 = 1 << 16;

/// The decisions of one run, in order.
#[derive(Debug, Default)]
struct Script {
    /// The alternatives planned for the first decisions.
    planned: Vec<u32>,
    /// The alternatives chosen, each with the number of alternatives.
    made: Vec<(u32, u32)>,
    /// Truth values that were decided: whether they are the opposite of the `f64` ones.
    flips: HashMap<u64, bool>,
}

/// The state of a machine's decisions.
#[derive(Debug)]
pub(super) struct Decisions {
    script: RefCell<Script>,
    /// The next unused id.
    next: Cell<u64>,
    /// Loop iterations left.
    rounds: Cell<u64>,
    /// Whether something was open that cannot be followed.
    lost: Cell<bool>,
}

impl Default for Decisions {
    fn default() -> Self {
        Self {
            script: RefCell::default(),
            next: Cell::new(1),
            rounds: Cell::new(ROUNDS),
            lost: Cell::new(false),
        }
    }
}

/// The results of a function on every path that its decisions may take.
pub(crate) struct Explored<R> {
    /// The results, the first of which follows `f64`.
    pub(crate) results: Vec<R>,
    /// Whether the first run had an open decision.
    pub(super) is_uncertain: bool,
    /// Whether all paths were run.
    pub(crate) is_complete: bool,
}

impl Decisions {
    /// Returns an id that no other value has.
    pub(super) fn fresh(&self) -> u64 {
        self.next.replace(self.next.get() + 1)
    }

    /// Marks the run as incomplete: too many alternatives were open.
    pub(super) fn lose(&self) {
        self.lost.set(true);
    }

    /// Chooses among `count` alternatives, of which index 0 is that of `f64`.
    pub(super) fn choose(&self, count: usize) -> usize {
        let script = &mut *self.script.borrow_mut();
        let chosen = script.planned.get(script.made.len()).copied().unwrap_or(0);
        script.made.push((chosen, count as u32));
        chosen as usize
    }

    /// Returns whether the truth value `id` is the opposite of the `f64` one; the decision is
    /// remembered.
    pub(super) fn flip(&self, id: u64) -> bool {
        let known = self.script.borrow().flips.get(&id).copied();
        known.unwrap_or_else(|| {
            let flip = self.choose(2) == 1;
            self.script.borrow_mut().flips.insert(id, flip);
            flip
        })
    }

    /// Returns the decision on the truth value `id`, if there was one.
    pub(super) fn known(&self, id: u64) -> Option<bool> {
        self.script.borrow().flips.get(&id).copied()
    }

    /// Ends the path of `f64`; the others have fewer loop iterations.
    pub(super) fn turn_aside(&self) {
        self.rounds.set(self.rounds.get().min(ROUNDS_ASIDE));
    }

    /// Counts an iteration of a loop and returns whether the limit allows it.
    pub(super) fn round(&self) -> bool {
        let left = self.rounds.get();
        if left == 0 {
            self.lose();
        }
        self.rounds.set(left.saturating_sub(1));
        left > 0
    }

    /// Runs `f` once per path through its decisions, breadth first from that of `f64`, for up to
    /// `limit` runs. Decisions of an outer run are not affected.
    pub(super) fn explore<R>(&self, limit: usize, mut f: impl FnMut() -> R) -> Explored<R> {
        let outer = self.script.take();
        let lost = self.lost.replace(false);
        let mut results = Vec::new();
        let mut is_uncertain = false;
        let mut waiting = VecDeque::from([Vec::new()]);
        while results.len() < limit
            && let Some(planned) = waiting.pop_front()
        {
            let first = planned.len();
            self.script.replace(Script { planned, ..Script::default() });
            results.push(f());
            let made = self.script.take().made;
            is_uncertain |= !made.is_empty() || self.lost.get();
            let chosen = |n: usize| made[..n].iter().map(|(c, _)| *c);
            for (at, (_, count)) in made.iter().enumerate().skip(first) {
                // The limit allows no more.
                if waiting.len() > limit {
                    break;
                }
                waiting.extend((1..*count).map(|other| chosen(at).chain([other]).collect()));
            }
        }
        self.script.replace(outer);
        let is_complete = waiting.is_empty() && !self.lost.get();
        self.lost.set(lost);
        Explored { results, is_uncertain, is_complete }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_is_gone_once() {
        let d = Decisions::default();
        let found = d.explore(64, || {
            let a = d.choose(2);
            let b = if a == 1 { d.choose(3) } else { 9 };
            (a, b, d.choose(2))
        });
        assert!(found.is_complete && found.is_uncertain);
        assert_eq!(found.results[0], (0, 9, 0));
        let mut all = found.results;
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 2 + 3 * 2);
    }

    #[test]
    fn truth_values_stay_what_they_were() {
        let d = Decisions::default();
        let found = d.explore(64, || (d.flip(7), d.flip(8), d.flip(7)));
        assert_eq!(found.results.len(), 4);
        assert!(found.results.iter().all(|(a, _, c)| a == c));
    }

    #[test]
    fn too_many_ways_are_not_complete() {
        let d = Decisions::default();
        let found = d.explore(5, || (0..10).map(|_| d.choose(2)).sum::<usize>());
        assert_eq!(found.results.len(), 5);
        assert!(!found.is_complete);
        let certain = d.explore(5, || 3);
        assert!(certain.is_complete && !certain.is_uncertain);
    }

    #[test]
    fn inner_decisions_leave_outer_ones_alone() {
        let d = Decisions::default();
        let found = d.explore(64, || {
            let a = d.choose(2);
            let inner = d.explore(64, || d.choose(2));
            (a, inner.results.len(), d.choose(2))
        });
        assert_eq!(found.results, [(0, 2, 0), (1, 2, 0), (0, 2, 1), (1, 2, 1)]);
    }
}
