//! Parsing of patterns: their tests and bindings.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens as _, quote};
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::attributes::is_coherent;
use crate::generics::mentions;
use crate::model::{Block, Expr, Kind, Let, Stmt, is_constant};

fn name(name: &Ident) -> Expr {
    Expr { kind: Kind::Name(name.clone()), span: name.span() }
}

fn compare(op: &'static str, a: &Expr, b: Expr, span: Span) -> Expr {
    Expr { kind: Kind::Compare { op, a: Box::new(a.clone()), b: Box::new(b) }, span }
}

fn logic(and: bool, a: Expr, b: Expr) -> Expr {
    let span = a.span;
    Expr { kind: Kind::Logic { and, a: Box::new(a), b: Box::new(b) }, span }
}

fn both(a: Option<Expr>, b: Option<Expr>) -> Option<Expr> {
    match (a, b) {
        (Some(a), Some(b)) => Some(logic(true, a, b)),
        (a, b) => a.or(b),
    }
}

/// Returns the enum of a variant's path.
fn enum_of(path: &syn::Path) -> Option<TokenStream> {
    let mut ty = path.clone();
    ty.segments.pop();
    ty.segments.pop_punct();
    (!ty.segments.is_empty()).then(|| ty.to_token_stream())
}

/// Returns whether this is a variant of an enum of kernels, unlike those of `Option` and `Result`.
fn is_variant(path: &syn::Path) -> bool {
    let of_std = ["Some", "Ok", "Err"];
    let last = path.segments.last();
    path.segments.len() > 1 && !last.is_some_and(|s| of_std.iter().any(|name| s.ident == name))
}

/// Returns whether it is `..` or `name @ ..`.
fn is_rest(p: &Pat) -> bool {
    match p {
        Pat::Rest(_) => true,
        Pat::Ident(p) => p.subpat.as_ref().is_some_and(|(_, sub)| is_rest(sub)),
        _ => false,
    }
}

/// Returns a member of `from`; for a tuple in the source that is the element itself.
fn member(from: &Expr, member: TokenStream, span: Span) -> Expr {
    if let Kind::Tuple(items) = &from.kind
        && let Ok(i) = member.to_string().parse::<usize>()
        && let Some(item) = items.get(i)
    {
        return item.clone();
    }
    Expr { kind: Kind::Field { base: Box::new(from.clone()), member }, span }
}

impl Parser<'_> {
    /// Returns the condition under which `pat` matches `from`, `None` if it always does; its
    /// bindings are added to `lets`.
    fn pattern(&mut self, pat: &Pat, from: &Expr, lets: &mut Vec<Stmt>) -> Option<Expr> {
        let span = pat.span();
        match pat {
            Pat::Wild(_) | Pat::Rest(_) => None,
            Pat::Ident(p) if p.by_ref.is_some() => {
                self.errors.at(span, "a kernel has no `ref`", "bind the value: it is copied");
                None
            }
            Pat::Ident(p) if is_constant(&p.ident) => {
                Some(compare("Eq", from, name(&p.ident), span))
            }
            Pat::Ident(p) => {
                lets.push(Stmt::bind(p.ident.clone(), p.mutability.is_some(), from.clone()));
                p.subpat.as_ref().and_then(|(_, sub)| self.pattern(sub, from, lets))
            }
            Pat::Path(p) => {
                let constant = Expr { kind: Kind::Path(p.to_token_stream()), span };
                Some(compare("Eq", from, constant, span))
            }
            Pat::Lit(l) => Some(match self.literal(&l.lit) {
                Kind::Bool(true) => from.clone(),
                Kind::Bool(false) => Expr { kind: Kind::Not(Box::new(from.clone())), span },
                kind => compare("Eq", from, Expr { kind, span }, span),
            }),
            Pat::Range(r) => self.range_pattern(r, from),
            Pat::Or(or) => self.or_pattern(or, from, lets),
            Pat::Paren(p) => self.pattern(&p.pat, from, lets),
            Pat::Reference(r) => self.pattern(&r.pat, from, lets),
            Pat::Type(t) => self.pattern(&t.pat, from, lets),
            Pat::Tuple(t) => self.tuple_pattern(t, from, lets),
            Pat::Struct(s) => s.fields.iter().fold(None, |test, f| {
                let item = member(from, f.member.to_token_stream(), f.span());
                both(test, self.pattern(&f.pat, &item, lets))
            }),
            Pat::Slice(s) => self.slice_pattern(s, from, lets),
            Pat::TupleStruct(t) if is_variant(&t.path) => self.variant(t, from, lets),
            Pat::TupleStruct(t) => {
                self.errors.at(
                    t.span(),
                    format!("a kernel has no `{}`", t.path.to_token_stream()),
                    "a value that may be missing is a struct with a flag, as `Hit` has `is_hit`; a \
                     kind of an enum of primitives is written `Shape::Ball(ball)`",
                );
                None
            }
            _ => {
                self.errors.at(
                    span,
                    "a kernel has no such pattern",
                    "use numbers, ranges, constants, names, tuples and structs with named members",
                );
                None
            }
        }
    }

    /// Returns the condition of `1..=3`.
    fn range_pattern(&mut self, r: &syn::PatRange, from: &Expr) -> Option<Expr> {
        let span = r.span();
        let start = r.start.as_ref().map(|e| self.expr(e));
        let end = r.end.as_ref().map(|e| self.expr(e));
        let upper = if matches!(r.limits, syn::RangeLimits::Closed(_)) { "Le" } else { "Lt" };
        both(
            start.map(|e| compare("Ge", from, e, span)),
            end.map(|e| compare(upper, from, e, span)),
        )
    }

    /// Returns the condition of `1 | 2`.
    fn or_pattern(&mut self, or: &syn::PatOr, from: &Expr, lets: &mut Vec<Stmt>) -> Option<Expr> {
        let count = lets.len();
        let tests: Vec<_> = or.cases.iter().map(|p| self.pattern(p, from, lets)).collect();
        if lets.len() > count {
            lets.truncate(count);
            self.errors.at(
                or.span(),
                "a kernel's patterns joined by `|` bind no names",
                "write an arm for each, or bind the whole: `n @ (1 | 2)`",
            );
        }
        let tests = tests.into_iter().collect::<Option<Vec<_>>>()?;
        tests.into_iter().reduce(|a, b| logic(false, a, b))
    }

    /// Returns the condition of `(a, _, ..)`.
    fn tuple_pattern(
        &mut self,
        t: &syn::PatTuple,
        from: &Expr,
        lets: &mut Vec<Stmt>,
    ) -> Option<Expr> {
        let mut test = None;
        for (i, p) in t.elems.iter().enumerate() {
            if matches!(p, Pat::Rest(_)) && i + 1 < t.elems.len() {
                self.errors.at(
                    p.span(),
                    "`..` stands last in a kernel's tuple pattern",
                    "write `_` for each element before the ones that you name",
                );
                return None;
            }
            let index = syn::Index { index: i as u32, span: p.span() };
            let item = member(from, quote!(#index), p.span());
            test = both(test, self.pattern(p, &item, lets));
        }
        test
    }

    /// Returns the condition of `[a, _, ..]`.
    fn slice_pattern(
        &mut self,
        s: &syn::PatSlice,
        from: &Expr,
        lets: &mut Vec<Stmt>,
    ) -> Option<Expr> {
        let mut test = None;
        for (i, p) in s.elems.iter().enumerate() {
            let mut after = s.elems.iter().skip(i + 1);
            if matches!(p, Pat::Rest(_)) && after.all(|p| matches!(p, Pat::Wild(_))) {
                break;
            }
            if is_rest(p) {
                self.errors.at(
                    p.span(),
                    "`..` stands last in a kernel's slice pattern, and without a name",
                    "write `_` for each element before the ones that you name",
                );
                return None;
            }
            let index = syn::Index::from(i);
            let base = Box::new(from.clone());
            let kind = Kind::Index { base, index: quote!(#index) };
            let item = Expr { kind, span: s.span() };
            test = both(test, self.pattern(p, &item, lets));
        }
        test
    }

    /// Returns the condition of `Shape::Ball(ball)`: a variant of an enum of primitives.
    fn variant(
        &mut self,
        pat: &syn::PatTupleStruct,
        from: &Expr,
        lets: &mut Vec<Stmt>,
    ) -> Option<Expr> {
        let span = pat.span();
        let (Some(kind), Some(ty)) = (pat.path.segments.last(), enum_of(&pat.path)) else {
            return None;
        };
        let ask = |what: &str| {
            let name = Ident::new(&format!("__{what}_{}", kind.ident), kind.ident.span());
            let (ty, args) = (ty.clone(), vec![from.clone()]);
            Expr { kind: Kind::Associated { ty, name, args }, span }
        };
        if let Some(prim) = pat.elems.first() {
            let prim_test = self.pattern(prim, &ask("as"), lets);
            return both(Some(ask("is")), prim_test);
        }
        Some(ask("is"))
    }

    /// Returns a value that patterns read more than once; it gets a name unless it is one, and also
    /// if a pattern rebinds that name.
    fn read_often(&mut self, e: Expr, bound: &TokenStream, lets: &mut Vec<Stmt>) -> Expr {
        match e.kind {
            Kind::Name(ref name) if !mentions(bound, name) => e,
            Kind::Tuple(items) => {
                let items = items.into_iter().map(|e| self.read_often(e, bound, lets)).collect();
                Expr { kind: Kind::Tuple(items), span: e.span }
            }
            _ => {
                let ident = self.temporary("value");
                let span = e.span;
                lets.push(Stmt::bind(ident.clone(), false, e));
                Expr { kind: Kind::Name(ident), span }
            }
        }
    }

    /// Parses `let PATTERN = init`.
    pub(super) fn destructure(
        &mut self,
        pat: &Pat,
        init: Expr,
        ty: Option<TokenStream>,
    ) -> Vec<Stmt> {
        // Elements of a tuple are evaluated before the first name is bound, which may be one of
        // theirs.
        let mut lets = Vec::new();
        let ident = self.temporary("parts");
        let from = name(&ident);
        lets.push(Stmt::Let(Let {
            host: false,
            name: Some(ident),
            mutable: false,
            ty,
            init: Some(init),
        }));
        self.irrefutable(pat, &from, &mut lets);
        lets
    }

    /// Binds the names of a parameter's pattern.
    pub(super) fn irrefutable(&mut self, pat: &Pat, from: &Expr, lets: &mut Vec<Stmt>) {
        // A refutable pattern is reported by rustc, in the user's own function.
        let _ = self.pattern(pat, from, lets);
    }

    /// Parses `match`, as a chain of `if`.
    pub(super) fn matching(&mut self, m: &syn::ExprMatch) -> Kind {
        let coherent = self.is_coherent || m.attrs.iter().any(is_coherent);
        let mut stmts = Vec::new();
        let scrutinee = self.expr(&m.expr);
        let bound: TokenStream = m.arms.iter().map(|arm| arm.pat.to_token_stream()).collect();
        let from = self.read_often(scrutinee, &bound, &mut stmts);
        let mut arms = Vec::new();
        for arm in &m.arms {
            let (test, block) = self.arm(arm, &from);
            let always = test.is_none();
            arms.push((test, block, arm.span()));
            if always {
                break;
            }
        }
        let Some((_, last, span)) = arms.pop() else {
            return self.error(
                m.span(),
                "a kernel's `match` needs an arm",
                "add one: `_ => value`",
            );
        };
        // Arms are exhaustive, so the last one needs no test.
        let chain = arms.into_iter().rfold(
            Expr { kind: Kind::Block(last), span },
            |otherwise, (test, then, span)| {
                let c = Box::new(test.unwrap_or(Expr { kind: Kind::Bool(true), span }));
                let otherwise = Some(Box::new(otherwise));
                Expr { kind: Kind::If { coherent, c, then, otherwise }, span }
            },
        );
        if stmts.is_empty() {
            return chain.kind;
        }
        Kind::Block(Block { stmts, tail: Some(Box::new(chain)) })
    }

    /// Returns the condition of an arm, `None` if it is always taken, and its body.
    fn arm(&mut self, arm: &syn::Arm, from: &Expr) -> (Option<Expr>, Block) {
        self.no_attributes(&arm.attrs);
        let (pat, guard) = match &arm.pat {
            Pat::Guard(g) => (&*g.pat, Some(&*g.guard)),
            pat => (pat, None),
        };
        let mut lets = Vec::new();
        let mut test = self.pattern(pat, from, &mut lets);
        if let Some(guard) = guard {
            test = both(test, Some(self.guard(guard, &lets)));
        }
        let body = self.expr(&arm.body);
        let block = match body.kind {
            Kind::Block(b) if lets.is_empty() => b,
            _ => Block { stmts: lets, tail: Some(Box::new(body)) },
        };
        (test, block)
    }

    /// Parses the guard of an arm, which sees the pattern's bindings.
    fn guard(&mut self, guard: &syn::Expr, lets: &[Stmt]) -> Expr {
        let span = guard.span();
        let guard = self.expr(guard);
        if lets.is_empty() {
            return guard;
        }
        let block = Block { stmts: lets.to_vec(), tail: Some(Box::new(guard)) };
        Expr { kind: Kind::Block(block), span }
    }
}
