//! Parsing of `for` loops.

use quote::quote;
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::expression::{inside_parens, label};
use crate::model::{Block, Expr, Kind, Range, Stmt};

/// The slice or array that a `for` iterates over, and whether it counts.
struct Items<'a> {
    list: &'a syn::Expr,
    enumerated: bool,
    /// Whether it is the list itself, not a reference to it: the loop runs over a copy.
    by_value: bool,
}

/// Recognises `list.iter()`, `&list`, `list.into_iter()` and `list`, and each with `.enumerate()`.
fn items(e: &syn::Expr) -> Option<Items<'_>> {
    match inside_parens(e) {
        syn::Expr::MethodCall(c) if c.method == "iter" && c.args.is_empty() => {
            Some(Items { list: &c.receiver, enumerated: false, by_value: false })
        }
        syn::Expr::MethodCall(c) if c.method == "into_iter" && c.args.is_empty() => {
            let is_range = matches!(inside_parens(&c.receiver), syn::Expr::Range(_));
            (!is_range).then_some(Items { list: &c.receiver, enumerated: false, by_value: true })
        }
        syn::Expr::MethodCall(c) if c.method == "enumerate" && c.args.is_empty() => {
            let inner = items(&c.receiver)?;
            (!inner.enumerated).then_some(Items { enumerated: true, ..inner })
        }
        syn::Expr::Reference(r) if r.mutability.is_none() => {
            Some(Items { list: inside_parens(&r.expr), enumerated: false, by_value: false })
        }
        list @ (syn::Expr::Path(_) | syn::Expr::Field(_) | syn::Expr::Array(_)) => {
            Some(Items { list, enumerated: false, by_value: true })
        }
        _ => None,
    }
}

/// Returns whether it is a cursor such as `scene.hits(ray)`, which finds its items one after
/// another.
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
        if let Some(items) = items(&f.expr) {
            return self.for_each(f, items);
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
    fn for_each(&mut self, f: &syn::ExprForLoop, items: Items<'_>) -> Kind {
        let span = f.expr.span();
        let boxed = |kind| Box::new(Expr { kind, span });
        let (mut list, index) = (self.boxed(items.list), self.temporary("i"));
        let mut copy = Vec::new();
        if items.by_value {
            let ident = self.temporary("items");
            copy.push(Stmt::bind(ident.clone(), false, *list));
            list = boxed(Kind::Name(ident));
        }
        let name = || Expr { kind: Kind::Name(index.clone()), span };
        let element = Kind::Element { base: list.clone(), index: Box::new(name()) };
        let element = Expr { kind: element, span };
        let item = if items.enumerated {
            Expr { kind: Kind::Tuple(vec![name(), element]), span }
        } else {
            element
        };
        let mut stmts = self.bind_item(&f.pat, item);
        let Block { stmts: body, tail } = self.block(&f.body);
        stmts.extend(body);
        let len = Kind::Method {
            receiver: list,
            name: syn::Ident::new("len", span),
            turbofish: vec![],
            args: vec![],
        };
        let zero = Kind::Int { tokens: quote!(0), suffix: None };
        let (start, end) = (boxed(zero), boxed(len));
        let range = Range { start, end, inclusive: false, reversed: false, step: None };
        let body = Block { stmts, tail };
        let repeat = Kind::For { label: label(&f.label), var: Some(index), range, body };
        if copy.is_empty() {
            return repeat;
        }
        copy.push(Stmt::Expr(Expr { kind: repeat, span }));
        Kind::Block(Block { stmts: copy, tail: None })
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
