//! Random well-typed kernels that terminate and do not panic.
//!
//! The grammar is tables of templates (`numbers`, `composites`, `changes`) and a function for
//! each form of statement. In a template, a small letter in braces is any expression of a type,
//! as `vocabulary::of_letter` says: `{f}` is an `f32`, `{v}` a `Vec3`. A capital letter is a name
//! that nothing assigns, or a member of one, the same wherever it stands in the template: guards
//! such as `{U} != 0 && a / {U} > b` need that. `{H}` is a value of the host, `{G}` a variable of a
//! type parameter's type. An exclamation mark in front says that no part may have an effect, for
//! the template borrows.
//!
//! * **No panics**: sums of integers wrap, or have operands too small to overflow; shifts are by a
//!   masked amount; divisors are made odd, or guarded; indices are reduced, or guarded. (The source
//!   panics where an index is out of range, so there is nothing to compare with.)
//! * **Every kernel ends**: loops count their rounds, and the product of the rounds of nested loops
//!   and calls is bounded (`WORK`).
//! * **One result**: nothing looks at what Rust leaves open, the sign and payload of a NaN.
//! * **Within the limits** that the book names.

mod branches;
mod changes;
mod closures;
mod composites;
mod expressions;
mod functions;
mod loops;
mod numbers;
mod scope;
mod statements;
mod vocabulary;

use self::scope::{Callable, Exit, Var};
use super::tree::{Expr, Head, Piece, Ty};
use crate::rng::Rng;

pub use functions::kernel;

/// How many operations one run of a kernel may take, about.
const WORK: usize = 6_000;
/// How many expressions the text of a function has, about: of `entry` and of others. Many small
/// kernels find more than a few large ones, and compile as fast.
const SIZE: [usize; 2] = [50, 18];

/// What functions of a kernel have in common.
#[derive(Clone, Copy)]
struct Traits {
    /// Whether there are floats, or integers and truth values only.
    floats: bool,
    /// Whether there is the struct `Own`.
    own: bool,
    /// Whether there are slices.
    scene: bool,
}

struct Generator<'a> {
    rng: &'a mut Rng,
    traits: Traits,
    head: Head,
    /// Whether the function has the slices.
    sliced: bool,
    /// Whether it is `entry`, which has the scene's numbers.
    entry: bool,
    callable: &'a [Callable],
    /// What is in scope, the innermost last.
    vars: Vec<Var>,
    /// The loops and labelled blocks around, the innermost last.
    around: Vec<Exit>,
    /// The type of `return`.
    result: Ty,
    /// How many operations a run takes so far.
    work: usize,
    /// How often what is generated now is run.
    rounds: usize,
    limit: usize,
    /// How many more expressions the text should have.
    size: usize,
    /// How many statements stand around.
    nest: usize,
    counters: usize,
    /// Whether expressions may have no blocks and no effects.
    plain: bool,
}

impl Generator<'_> {
    fn chance(&mut self, percent: usize) -> bool {
        self.rng.below(100) < percent
    }

    fn is_full(&self) -> bool {
        self.size == 0 || self.work > self.limit
    }

    /// A number that no other name of the function has.
    fn number(&mut self) -> usize {
        self.counters += 1;
        self.counters - 1
    }

    /// Without blocks and effects in expressions.
    fn plainly<R>(&mut self, f: impl FnOnce(&mut Self) -> R) -> R {
        let old = std::mem::replace(&mut self.plain, true);
        let result = f(self);
        self.plain = old;
        result
    }

    fn any_type(&mut self) -> Ty {
        use Ty::*;
        const NUMBERS: &[Ty] =
            &[U32, U32, I32, I32, Bool, Size, IVec3, UVec2, BVec3, Kind, Counts, Maybe];
        const ALL: &[Ty] = &[
            F32, F32, F32, U32, U32, I32, Bool, Size, Vec2, Vec3, Vec3, Vec4, IVec3, UVec2, BVec3,
            Kind, Pair, Row, Counts, Both, Small, Small, Nested, Shape, Shape, Maybe,
        ];
        match self.rng.below(12) {
            0 if self.traits.own => Own,
            1 | 2 if self.head == Head::OfType => Any,
            1 if self.head == Head::OfCount => List,
            _ => self.rng.pick(if self.traits.floats { ALL } else { NUMBERS }),
        }
    }
}

fn text(t: impl Into<String>) -> Piece {
    Piece::Text(t.into())
}

fn around(before: impl Into<String>, e: Expr, after: &str) -> Vec<Piece> {
    vec![text(before), Piece::Expr(e), text(after)]
}
