//! Parsing of `for` loops.

use proc_macro2::Span;
use quote::{ToTokens as _, quote};
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::expression::{inside_parens, label};
use crate::model::{Block, Expr, Kind, Let, Range, Stmt};
use crate::ops;

/// What a `for` goes through, element by element.
enum Sequence<'a> {
    /// A slice or an array. By value the loop runs over a copy.
    List { list: &'a syn::Expr, by_value: bool },
    /// `.enumerate()`.
    Enumerated(Box<Self>),
    /// `.rev()`.
    Reversed(Box<Self>),
    /// `.zip(..)`.
    Zipped(Box<Self>, Box<Self>),
}

/// A sequence whose lists are expressions of the kernel.
enum Elements {
    List(Expr),
    /// A part of a list: `&list[a..b]`.
    Part(Box<Part>),
    Enumerated(Box<Self>),
    Reversed(Box<Self>),
    Zipped(Box<Self>, Box<Self>),
}

/// A part of a list, from the element `first` on.
struct Part {
    list: Expr,
    first: Expr,
    len: Expr,
}

/// Returns the sequence of `list.iter()`, `&list`, `list.into_iter()` and `list`, and of each with
/// `.enumerate()`, `.rev()` and `.zip(..)`.
fn sequence(e: &syn::Expr) -> Option<Sequence<'_>> {
    let (e, is_reversed) = without_reversals(inside_parens(e));
    let all = forwards(e)?;
    Some(if is_reversed { Sequence::Reversed(Box::new(all)) } else { all })
}

fn forwards(e: &syn::Expr) -> Option<Sequence<'_>> {
    let by_reference = |list| Some(Sequence::List { list, by_value: false });
    match inside_parens(e) {
        syn::Expr::MethodCall(c) if c.method == "iter" && c.args.is_empty() => {
            by_reference(&*c.receiver)
        }
        syn::Expr::MethodCall(c) if c.method == "into_iter" && c.args.is_empty() => {
            let is_range = matches!(inside_parens(&c.receiver), syn::Expr::Range(_));
            (!is_range).then_some(Sequence::List { list: &c.receiver, by_value: true })
        }
        syn::Expr::MethodCall(c) if c.args.is_empty() && is_call_of_iter(&c.receiver) => {
            let is_enumerated = c.method == "enumerate";
            is_enumerated
                .then(|| sequence(&c.receiver).map(Box::new))
                .flatten()
                .map(Sequence::Enumerated)
        }
        syn::Expr::MethodCall(c) if c.method == "zip" && c.args.len() == 1 => {
            let (first, second) = (sequence(&c.receiver)?, sequence(&c.args[0])?);
            Some(Sequence::Zipped(Box::new(first), Box::new(second)))
        }
        syn::Expr::Reference(r) if r.mutability.is_none() => by_reference(inside_parens(&r.expr)),
        list @ (syn::Expr::Path(_) | syn::Expr::Field(_) | syn::Expr::Array(_)) => {
            Some(Sequence::List { list, by_value: true })
        }
        _ => None,
    }
}

/// Returns whether it ends in a call of an iterator's method: `list.iter().rev()`.
fn is_call_of_iter(e: &syn::Expr) -> bool {
    let names = ["iter", "into_iter", "enumerate", "rev", "zip"];
    matches!(inside_parens(e), syn::Expr::MethodCall(c) if names.iter().any(|n| c.method == n))
}

pub(super) fn method(receiver: Expr, name: &str, args: Vec<Expr>) -> Expr {
    let (span, name) = (receiver.span, syn::Ident::new(name, receiver.span));
    let kind = Kind::Method { receiver: Box::new(receiver), name, turbofish: vec![], args };
    Expr { kind, span }
}

fn minus(a: Expr, b: Expr) -> Expr {
    let span = a.span;
    Expr { kind: Kind::Binary { op: ops::SUB, a: Box::new(a), b: Box::new(b) }, span }
}

fn plus(a: Expr, b: Expr) -> Expr {
    let span = a.span;
    Expr { kind: Kind::Binary { op: ops::ADD, a: Box::new(a), b: Box::new(b) }, span }
}

fn element(list: &Expr, index: Expr) -> Expr {
    let span = index.span;
    let kind = Kind::Element { base: Box::new(list.clone()), index: Box::new(index) };
    Expr { kind, span }
}

/// Returns an integer of the source.
pub(super) fn number(n: u32, span: Span) -> Expr {
    let tokens = syn::LitInt::new(&n.to_string(), span).to_token_stream();
    Expr { kind: Kind::Int { tokens, suffix: None }, span }
}

/// Returns the list and the range of `list[a..b]`.
fn part_of(e: &syn::Expr) -> Option<(&syn::Expr, &syn::ExprRange)> {
    match inside_parens(e) {
        syn::Expr::Index(i) => match inside_parens(&i.index) {
            syn::Expr::Range(range) => Some((&i.expr, range)),
            _ => None,
        },
        syn::Expr::Reference(r) if r.mutability.is_none() => part_of(&r.expr),
        _ => None,
    }
}

impl Elements {
    /// Returns the number of elements.
    fn len(&self) -> Expr {
        match self {
            Self::List(list) => method(list.clone(), "len", vec![]),
            Self::Part(part) => part.len.clone(),
            Self::Enumerated(inner) | Self::Reversed(inner) => inner.len(),
            Self::Zipped(a, b) => method(a.len(), "min", vec![b.len()]),
        }
    }

    /// Returns the element of a number.
    fn at(&self, index: Expr) -> Expr {
        let span = index.span;
        match self {
            Self::List(list) => element(list, index),
            Self::Part(part) => element(&part.list, plus(part.first.clone(), index)),
            Self::Enumerated(inner) => {
                let items = vec![index.clone(), inner.at(index)];
                Expr { kind: Kind::Tuple(items), span }
            }
            Self::Reversed(inner) => inner.at(minus(minus(inner.len(), number(1, span)), index)),
            Self::Zipped(a, b) => {
                let items = vec![a.at(index.clone()), b.at(index)];
                Expr { kind: Kind::Tuple(items), span }
            }
        }
    }
}

fn is_cursor(e: &syn::Expr) -> bool {
    matches!(inside_parens(e), syn::Expr::MethodCall(c) if c.method == "hits")
}

/// Returns the expression before every `.rev()`, and whether their number is odd.
fn without_reversals(mut range: &syn::Expr) -> (&syn::Expr, bool) {
    let mut reversed = false;
    while let syn::Expr::MethodCall(c) = range
        && c.method == "rev"
    {
        reversed = !reversed;
        range = inside_parens(&c.receiver);
    }
    (range, reversed)
}

impl Parser<'_> {
    pub(super) fn for_loop(&mut self, f: &syn::ExprForLoop) -> Kind {
        if let Some(sequence) = sequence(&f.expr) {
            return self.for_each(f, &sequence);
        }
        if is_cursor(&f.expr) {
            return self.for_items(f);
        }
        let counter = self.counter(&f.pat);
        let range = self.range(&f.expr);
        let (Some((var, changed)), Some(range)) = (counter, range) else {
            return self.body_alone(f);
        };
        let mut body = self.block(&f.body);
        body.stmts.splice(0..0, changed);
        Kind::For { label: label(&f.label), var, range, body }
    }

    /// Parses a loop with a mistake in its head: the body may have some too.
    fn body_alone(&mut self, f: &syn::ExprForLoop) -> Kind {
        let item = Expr { kind: Kind::Error, span: f.pat.span() };
        let mut stmts = self.bind_item(&f.pat, item);
        let mut body = self.block(&f.body);
        stmts.append(&mut body.stmts);
        Kind::Loop { label: label(&f.label), body: Block { stmts, ..body } }
    }

    /// Returns the name that a loop counts with, and the statement that binds it in the body.
    fn counter(&mut self, mut pat: &Pat) -> Option<(Option<syn::Ident>, Option<Stmt>)> {
        while let Pat::Paren(p) = pat {
            pat = &p.pat;
        }
        match pat {
            // A counter that the body changes is a variable of the body.
            Pat::Ident(p) if p.mutability.is_some() => {
                let counter = self.temporary("i");
                let init = Expr { kind: Kind::Name(counter.clone()), span: p.span() };
                Some((Some(counter), Some(Stmt::bind(p.ident.clone(), true, init))))
            }
            Pat::Ident(p) => Some((Some(p.ident.clone()), None)),
            Pat::Wild(_) => Some((None, None)),
            pat => {
                let help = "write `for i in a..b`";
                self.errors.at(pat.span(), "a `for` counts with one name", help);
                None
            }
        }
    }

    /// Parses `a..b`, `a..=b`, and each with `.rev()` or `.step_by(n)`.
    fn range(&mut self, e: &syn::Expr) -> Option<Range> {
        let (range, step) = self.without_steps(inside_parens(e))?;
        let (range, reversed) = without_reversals(range);
        let syn::Expr::Range(r) = range else {
            self.errors.at(
                e.span(),
                "a kernel's `for` runs over a range, the elements of a slice or an array, or hits",
                "write `for i in 0..n`, `for x in list.iter()`, `for hit in scene.hits(ray)` or \
                 an index: `list[i]`",
            );
            return None;
        };
        let (start, end) = self.bounds(r)?;
        let inclusive = matches!(r.limits, syn::RangeLimits::Closed(_));
        Some(Range { start, end, inclusive, reversed, step })
    }

    /// Returns the expression before `.step_by(n)`, and `n`.
    fn without_steps<'e>(
        &mut self,
        e: &'e syn::Expr,
    ) -> Option<(&'e syn::Expr, Option<Box<Expr>>)> {
        let syn::Expr::MethodCall(c) = e else { return Some((e, None)) };
        let Some(by) = c.args.first().filter(|_| c.method == "step_by") else {
            return Some((e, None));
        };
        let step = self.boxed(by);
        let range = inside_parens(&c.receiver);
        if let syn::Expr::MethodCall(c) = range
            && c.method == "rev"
        {
            self.errors.at(
                c.method.span(),
                "a kernel's range with steps counts upwards",
                "count from 0, and calculate: `for k in 0..n { let i = last - 2 * k; }`",
            );
            return None;
        }
        Some((range, Some(step)))
    }

    /// Returns the bounds of a range.
    fn bounds(&mut self, r: &syn::ExprRange) -> Option<(Box<Expr>, Box<Expr>)> {
        let (Some(start), Some(end)) = (&r.start, &r.end) else {
            self.errors.at(
                r.span(),
                "a kernel's range has two bounds",
                "write `for i in a..b` or `for i in a..=b`",
            );
            return None;
        };
        Some((self.boxed(start), self.boxed(end)))
    }

    /// Parses a loop over elements: `for x in list` is `for i in 0..list.len() { let x = list[i];
    /// .. }`.
    fn for_each(&mut self, f: &syn::ExprForLoop, sequence: &Sequence<'_>) -> Kind {
        let span = f.expr.span();
        let (mut copies, index) = (Vec::new(), self.temporary("i"));
        let elements = self.elements(sequence, &mut copies, span);
        let item = elements.at(Expr { kind: Kind::Name(index.clone()), span });
        let mut stmts = self.bind_item(&f.pat, item);
        let Block { stmts: body, tail } = self.block(&f.body);
        stmts.extend(body);
        let (start, end) = (Box::new(number(0, span)), Box::new(elements.len()));
        let range = Range { start, end, inclusive: false, reversed: false, step: None };
        let body = Block { stmts, tail };
        let repeat = Kind::For { label: label(&f.label), var: Some(index), range, body };
        if copies.is_empty() {
            return repeat;
        }
        copies.push(Stmt::Expr(Expr { kind: repeat, span }));
        Kind::Block(Block { stmts: copies, tail: None })
    }

    /// Parses the lists of a sequence. Those that are gone through by value are copied first.
    fn elements(
        &mut self,
        sequence: &Sequence<'_>,
        copies: &mut Vec<Stmt>,
        span: Span,
    ) -> Elements {
        let mut inner = |this: &mut Self, inner| Box::new(this.elements(inner, copies, span));
        match sequence {
            Sequence::List { list, by_value: false } => match part_of(list) {
                Some((list, range)) => self.part(list, range, copies),
                None => Elements::List(self.expr(list)),
            },
            Sequence::List { list, by_value: true } => {
                let (list, ident) = (self.expr(list), self.temporary("items"));
                copies.push(Stmt::bind(ident.clone(), false, list));
                Elements::List(Expr { kind: Kind::Name(ident), span })
            }
            Sequence::Enumerated(sequence) => Elements::Enumerated(inner(self, sequence)),
            Sequence::Reversed(sequence) => Elements::Reversed(inner(self, sequence)),
            Sequence::Zipped(a, b) => Elements::Zipped(inner(self, a), inner(self, b)),
        }
    }

    /// Parses a part of a list; its bounds are computed once, in front of the loop.
    fn part(
        &mut self,
        list: &syn::Expr,
        range: &syn::ExprRange,
        copies: &mut Vec<Stmt>,
    ) -> Elements {
        let (list, span) = (self.expr(list), range.span());
        let mut bind = |this: &mut Self, value| {
            let name = this.temporary("bound");
            let (init, ty) = (Some(value), Some(quote!(usize)));
            let (host, mutable, name_of) = (false, false, Some(name.clone()));
            let l = Let { is_pattern: false, host, name: name_of, mutable, ty, init };
            copies.push(Stmt::Let(l));
            Expr { kind: Kind::Name(name), span }
        };
        let first = match range.start.as_deref().map(|e| self.expr(e)) {
            None => number(0, span),
            // The same for all rays.
            Some(e) if e.is_untyped_integer() => e,
            Some(e) => bind(self, e),
        };
        let end = match range.end.as_deref().map(|e| self.expr(e)) {
            None => method(list.clone(), "len", vec![]),
            Some(e) if matches!(range.limits, syn::RangeLimits::Closed(_)) => {
                plus(e, number(1, span))
            }
            Some(e) => e,
        };
        let end = bind(self, end);
        let len = bind(self, method(end, "saturating_sub", vec![first.clone()]));
        Elements::Part(Box::new(Part { list, first, len }))
    }

    /// Parses a loop over a cursor.
    fn for_items(&mut self, f: &syn::ExprForLoop) -> Kind {
        let (items, item) = (self.boxed(&f.expr), self.temporary("item"));
        let value = Expr { kind: Kind::Name(item.clone()), span: f.pat.span() };
        let mut stmts = self.bind_item(&f.pat, value);
        let Block { stmts: body, tail } = self.block(&f.body);
        stmts.extend(body);
        Kind::ForItems { label: label(&f.label), item, items, body: Block { stmts, tail } }
    }

    /// Returns the bindings of the pattern of a loop over elements.
    fn bind_item(&mut self, pat: &Pat, item: Expr) -> Vec<Stmt> {
        match pat {
            Pat::Ident(p) if p.by_ref.is_none() && p.subpat.is_none() => {
                vec![Stmt::bind(p.ident.clone(), p.mutability.is_some(), item)]
            }
            Pat::Paren(p) => self.bind_item(&p.pat, item),
            Pat::Reference(r) => self.bind_item(&r.pat, item),
            pat => self.destructure(pat, item, None),
        }
    }
}
