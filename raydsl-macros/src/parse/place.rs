//! Parsing of assignments, and of the variables and parts of variables that they change.

use proc_macro2::Span;
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{BinOp, Lit, UnOp};

use super::Parser;
use crate::model::{BinaryOp, Block, Expr, Kind, Place, Step, Stmt};
use crate::ops;

impl Parser<'_> {
    pub(super) fn assign(&mut self, a: &syn::ExprAssign) -> Kind {
        if let syn::Expr::Tuple(left) = &*a.left {
            return self.assign_tuple(left, &a.right);
        }
        let (place, value) = (self.place(&a.left), self.boxed(&a.right));
        match place {
            Some(place) => Kind::Assign { place, value },
            None => value.kind,
        }
    }

    /// Parses `(a, b) = (b, a)`: the whole right side is evaluated first.
    fn assign_tuple(&mut self, left: &syn::ExprTuple, right: &syn::Expr) -> Kind {
        let (span, parts) = (right.span(), self.temporary("parts"));
        let mut stmts = vec![Stmt::bind(parts.clone(), false, self.expr(right))];
        for (i, e) in left.elems.iter().enumerate() {
            if matches!(e, syn::Expr::Infer(_)) {
                continue;
            }
            let Some(place) = self.place(e) else { return Kind::Error };
            stmts.push(self.assign_part(place, &parts, i as u32, span));
        }
        Kind::Block(Block { stmts, tail: None })
    }

    /// Parses `mem::swap(&mut a, &mut b)`: both are read before they are assigned.
    pub(super) fn exchange(&mut self, c: &syn::ExprCall) -> Kind {
        let (span, parts) = (c.span(), self.temporary("parts"));
        let places: Vec<&syn::Expr> = c.args.iter().map(without_mut).collect();
        let values = places.iter().map(|e| self.expr(e)).collect();
        let values = Expr { kind: Kind::Tuple(values), span };
        let mut stmts = vec![Stmt::bind(parts.clone(), false, values)];
        for (e, i) in places.iter().zip([1, 0]) {
            let Some(place) = self.place(e) else { return Kind::Error };
            if place.steps.iter().any(|s| matches!(s, Step::Computed(e) if e.may_act())) {
                return self.error(
                    e.span(),
                    "the index of an element that is exchanged is evaluated twice",
                    "bind the index first: `let i = ...;`",
                );
            }
            stmts.push(self.assign_part(place, &parts, i, span));
        }
        Kind::Block(Block { stmts, tail: None })
    }

    /// Returns the assignment of an element of a tuple to a place.
    fn assign_part(&self, place: Place, parts: &syn::Ident, i: u32, span: Span) -> Stmt {
        let base = Box::new(Expr { kind: Kind::Name(parts.clone()), span });
        let member = syn::Index { index: i, span }.to_token_stream();
        let value = Box::new(Expr { kind: Kind::Field { base, member }, span });
        Stmt::Expr(Expr { kind: Kind::Assign { place, value }, span })
    }

    /// Parses `a += b`.
    pub(super) fn op_assign(&mut self, op: BinaryOp, b: &syn::ExprBinary) -> Kind {
        let (place, value) = (self.place(&b.left), self.boxed(&b.right));
        let Some(place) = place else { return value.kind };
        let acts = |s: &Step| matches!(s, Step::Computed(e) if e.may_act());
        if place.steps.iter().any(acts) && value.may_act() {
            return self.error(
                b.left.span(),
                "which of the index and the value comes first depends on their types",
                "bind the index first: `let i = ...;`",
            );
        }
        Kind::OpAssign { op, place, value }
    }

    pub(super) fn place(&mut self, e: &syn::Expr) -> Option<Place> {
        match e {
            syn::Expr::Path(p) if p.path.get_ident().is_some() => {
                Some(Place { name: p.path.get_ident()?.clone(), steps: vec![] })
            }
            syn::Expr::Field(f) => {
                let mut place = self.place(&f.base)?;
                place.steps.push(Step::Member(f.member.to_token_stream()));
                Some(place)
            }
            syn::Expr::Index(i) => {
                let mut place = self.place(&i.expr)?;
                place.steps.push(self.step(&i.index)?);
                Some(place)
            }
            syn::Expr::Paren(p) => self.place(&p.expr),
            syn::Expr::Unary(u) if matches!(u.op, UnOp::Deref(_)) => self.place(&u.expr),
            _ => {
                self.errors.at(
                    e.span(),
                    "a kernel cannot assign to this",
                    "assign to a variable, or to a member or an element of one",
                );
                None
            }
        }
    }

    /// Parses an index between brackets.
    pub(super) fn step(&mut self, index: &syn::Expr) -> Option<Step> {
        match index {
            syn::Expr::Lit(syn::ExprLit { lit: Lit::Int(n), .. })
                if matches!(n.suffix(), "" | "usize") =>
            {
                Some(Step::Element(n.to_token_stream()))
            }
            syn::Expr::Paren(p) => self.step(&p.expr),
            syn::Expr::Range(r) => {
                self.errors.at(
                    r.span(),
                    "a kernel has a part of a list as the items of a `for` only",
                    "write `for x in &all[a..b]`, or pass the whole and the bounds, and index it: \
                     `all[first + i]`",
                );
                None
            }
            index => Some(Step::Computed(self.expr(index))),
        }
    }
}

/// Returns the place in `&mut place`; what is a reference is the place itself.
fn without_mut(e: &syn::Expr) -> &syn::Expr {
    match e {
        syn::Expr::Reference(r) => &r.expr,
        e => e,
    }
}

/// Returns the operator of `+=` and its like.
pub(super) fn assignment(op: &BinOp) -> Option<BinaryOp> {
    Some(match op {
        BinOp::AddAssign(_) => ops::ADD,
        BinOp::SubAssign(_) => ops::SUB,
        BinOp::MulAssign(_) => ops::MUL,
        BinOp::DivAssign(_) => ops::DIV,
        BinOp::RemAssign(_) => ops::REM,
        BinOp::BitAndAssign(_) => ops::BIT_AND,
        BinOp::BitOrAssign(_) => ops::BIT_OR,
        BinOp::BitXorAssign(_) => ops::BIT_XOR,
        BinOp::ShlAssign(_) => ops::SHL,
        BinOp::ShrAssign(_) => ops::SHR,
        _ => return None,
    })
}
