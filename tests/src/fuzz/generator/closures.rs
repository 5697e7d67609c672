//! Closures as arguments of kernels.

use super::scope::Var;
use super::{Generator, text};
use crate::fuzz::tree::{Expr, Piece, Ty};

/// How often a kernel of [`KERNELS`] calls its closure, at most.
const CALLS: usize = 5;

/// A kernel that takes a closure.
struct Taker {
    /// The type that the call gives.
    ty: Ty,
    /// Its text, with `{F}` for the closure and `{A}` for another argument.
    call: &'static str,
    argument: &'static [Ty],
    params: &'static [Ty],
    gives: Ty,
}

const KERNELS: &[Taker] = &[
    Taker {
        ty: Ty::F32,
        call: "swept({F}, {A}, {A})",
        argument: &[Ty::F32, Ty::U32],
        params: &[Ty::F32, Ty::U32],
        gives: Ty::F32,
    },
    Taker {
        ty: Ty::U32,
        call: "found({F}, {A})",
        argument: &[Ty::U32],
        params: &[Ty::U32, Ty::Kind],
        gives: Ty::Bool,
    },
    Taker {
        ty: Ty::Small,
        call: "refined({A}, &{F})",
        argument: &[Ty::Small],
        params: &[Ty::Small],
        gives: Ty::Small,
    },
];

impl Generator<'_> {
    /// A call of a kernel that takes a closure, if there is one of the type.
    pub(super) fn closure_call(&mut self, ty: Ty) -> Option<Expr> {
        let taker = KERNELS.iter().find(|k| k.ty == ty)?;
        if self.nest >= 4 || self.rounds * CALLS > self.limit / 20 {
            return None;
        }
        let (mut pieces, mut arguments) = (Vec::new(), taker.argument.iter());
        let mut rest = taker.call;
        while let Some(at) = rest.find('{') {
            pieces.push(text(&rest[..at]));
            match &rest[at..at + 3] {
                "{F}" => pieces.extend(self.closure(taker)),
                // The closure borrows what it reads.
                _ => {
                    let ty = *arguments.next().expect("a type for each argument");
                    pieces.push(Piece::Expr(self.plainly(|g| g.expr(ty, 2))));
                }
            }
            rest = &rest[at + 3..];
        }
        pieces.push(text(rest));
        Some(Expr { ty, pieces })
    }

    /// `|a, b: u32| { .. }`: it reads what is in scope, and changes its own variables.
    fn closure(&mut self, taker: &Taker) -> Vec<Piece> {
        let outer = self.vars.clone();
        self.vars.iter_mut().for_each(|v| v.mutable = false);
        let mut params: Vec<(String, String)> = Vec::new();
        for ty in taker.params {
            let mut name = self.new_name();
            while params.iter().any(|p| p.0 == name) {
                name = self.new_name();
            }
            let mutable = self.chance(30);
            let written = if self.chance(50) { format!(": {}", ty.name()) } else { String::new() };
            let shown = format!("{}{name}{written}", if mutable { "mut " } else { "" });
            self.vars.push(Var::new(name.clone(), *ty, mutable));
            params.push((name, shown));
        }
        let shown: Vec<String> = params.into_iter().map(|p| p.1).collect();
        let head = format!("|{}| ", shown.join(", "));
        let (around, rounds) = (std::mem::take(&mut self.around), self.rounds);
        let result = std::mem::replace(&mut self.result, taker.gives);
        self.rounds *= CALLS;
        self.nest += 1;
        let statements = self.rng.below(3);
        let block = self.block(Some(taker.gives), false, statements);
        self.nest -= 1;
        (self.around, self.rounds, self.result) = (around, rounds, result);
        self.vars = outer;
        vec![text(head), Piece::Block(block)]
    }
}
