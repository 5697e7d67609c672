//! Members that nothing reads, and members that methods hand back unchanged: no variables, no
//! arguments, no outputs; and the same results.

use std::error::Error;

use raydsl::integrators::PathSample;
use raydsl::kernel;
use raydsl::machine::wgsl::Limits;
use raydsl::prelude::*;
use raydsl_tests::check::{Wgsl, check, recorded};
use raydsl_tests::values::Numbers;

use super::scenes;

/// Four members: one is never changed, one is changed now and then, one is changed each time, and one
/// is never read.
#[derive(Clone, Copy, Debug, Type)]
struct Walk {
    step: f32,
    limit: f32,
    at: f32,
    turns: u32,
}

#[kernel]
impl Walk {
    fn advance(&mut self) {
        self.at += self.step;
        self.turns = self.turns.wrapping_add(1);
    }

    /// Begins anew, with another limit, where it is too far.
    fn bounded(&mut self) -> f32 {
        self.advance();
        let before = self.at;
        if self.at > self.limit {
            self.limit = self.at * 0.5;
            self.at = 0.0;
        }
        before
    }

    fn turn(&mut self) {
        let at = self.at;
        self.at = self.step;
        self.step = -at;
    }
}

#[kernel]
fn handed_back(step: f32, limit: f32, count: u32) -> f32 {
    let mut walk = Walk { step, limit, at: 0.25, turns: 0 };
    for _ in 0..count % 9 {
        walk.advance();
    }
    walk.at + walk.limit
}

#[kernel]
fn changed_now_and_then(step: f32, limit: f32, count: u32) -> f32 {
    let mut walk = Walk { step, limit, at: 0.25, turns: 0 };
    let mut sum = 0.0;
    for i in 0..count % 9 {
        let taken = if i % 2 == 0 { walk.bounded() } else { walk.limit };
        sum += taken;
    }
    sum + walk.at
}

/// What is read is what was stored an iteration before, two variables in turn.
#[kernel]
fn swapped(step: f32, limit: f32, count: u32) -> f32 {
    let mut walk = Walk { step, limit, at: 0.25, turns: 0 };
    let mut last = walk;
    for i in 0..count % 9 {
        let next = if i % 3 == 0 { last } else { walk };
        last = walk;
        walk = next;
        walk.turn();
    }
    last.at * 2.0 + walk.at
}

#[test]
fn results_are_the_same() {
    check::<handed_back>("handed_back", Numbers::Tame, Wgsl::Same);
    check::<changed_now_and_then>("changed_now_and_then", Numbers::Tame, Wgsl::Same);
    check::<swapped>("swapped", Numbers::Tame, Wgsl::Same);
}

#[test]
fn unchanged_members_are_no_variables() {
    let text = recorded::<handed_back>().wgsl();
    assert!(text.contains("var walk_at"), "{text}");
    for word in ["var walk_step", "var walk_limit", "walk_turns", "var self_step"] {
        assert!(!text.contains(word), "{word}\n{text}");
    }
    let text = recorded::<changed_now_and_then>().wgsl();
    assert!(text.contains("var walk_limit") && !text.contains("var walk_step"), "{text}");
    let text = recorded::<swapped>().wgsl();
    assert!(text.contains("var walk_step") && text.contains("var walk_at"), "{text}");
    assert!(!text.contains("walk_turns") && !text.contains("var walk_limit"), "{text}");
}

/// A film of depths takes four bytes for each pixel, and one with channels what those take.
#[test]
fn outputs_are_what_a_kernel_returns() -> Result<(), Box<dyn Error>> {
    for (name, bytes) in [("depth", 4), ("channels", size_of::<PathSample>())] {
        let scene = scenes::all().into_iter().find(|scene| scene.name == name);
        let recording = (scene.ok_or("it is in the matrix")?.record)()?;
        let stride = recording.module(&Limits::default()).output_stride;
        assert_eq!(stride as usize, bytes, "{name}");
    }
    Ok(())
}
