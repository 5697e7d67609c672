//! Parsing of patterns: their tests and bindings.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens as _, quote};
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::attributes::is_coherent;
use super::iteration::{method, number};
use super::refused::is_absent;
use super::types::is_type_name;
use crate::generics::mentions;
use crate::here::private;
use crate::model::{Block, Expr, Kind, Let, Stmt, is_constant};

pub(super) fn name(name: &Ident) -> Expr {
    Expr { kind: Kind::Name(name.clone()), span: name.span() }
}

fn compare(op: &'static str, a: &Expr, b: Expr, span: Span) -> Expr {
    Expr { kind: Kind::Compare { op, a: Box::new(a.clone()), b: Box::new(b) }, span }
}

pub(super) fn logic(and: bool, a: Expr, b: Expr) -> Expr {
    let span = a.span;
    Expr { kind: Kind::Logic { and, a: Box::new(a), b: Box::new(b) }, span }
}

/// Returns `if c { a } else { b }`.
fn one_of(c: Expr, a: Expr, b: Expr) -> Expr {
    let span = c.span;
    let then = Block { stmts: vec![], tail: Some(Box::new(a)) };
    let otherwise = Some(Box::new(b));
    Expr { kind: Kind::If { coherent: false, c: Box::new(c), then, otherwise }, span }
}

fn both(a: Option<Expr>, b: Option<Expr>) -> Option<Expr> {
    match (a, b) {
        (Some(a), Some(b)) => Some(logic(true, a, b)),
        (a, b) => a.or(b),
    }
}

/// A variant of an enum, as a path names it.
pub(super) struct Variant {
    /// The enum.
    ty: TokenStream,
    name: Ident,
}

/// Returns the variant that a path alone names, which may also be a constant: `Shape::Ball`, `None`.
fn unit_variant_of(path: &syn::Path) -> Option<Variant> {
    variant_of(path).filter(|v| is_camel_case(&v.name))
}

/// Returns the variant that a path in front of fields names: `Shape::Ball`, `Bsdf::GGX`, `Some`.
pub(super) fn variant_of(path: &syn::Path) -> Option<Variant> {
    let (last, owner) = {
        let mut segments = path.segments.iter().rev();
        (&segments.next()?.ident, segments.next())
    };
    let name = last.clone();
    let of_option = owner.is_none_or(|owner| owner.ident == "Option");
    if of_option && (last == "Some" || last == "None") {
        let p = private();
        return Some(Variant { ty: quote!(#p::Options), name });
    }
    if !is_type_name(&owner?.ident) || is_absent(last) || !is_type_name(last) {
        return None;
    }
    let mut ty = path.clone();
    ty.segments.pop();
    ty.segments.pop_punct();
    Some(Variant { ty: ty.to_token_stream(), name })
}

/// Returns the variant that `None` or `Option::None` names: a value of any type. The unit variants of
/// other enums are constants.
pub(super) fn none_of(path: &syn::Path) -> Option<Variant> {
    let mut segments = path.segments.iter().rev();
    let is_none = segments.next()?.ident == "None";
    let of_option = segments.next().is_none_or(|owner| owner.ident == "Option");
    if is_none && of_option { variant_of(path) } else { None }
}

/// Returns a name without the `r#` of raw identifiers in it, which functions have their names from.
pub(crate) fn unraw(name: &str) -> String {
    name.replace("r#", "")
}

/// Returns whether a name is a variant's, by its letters, and not a constant's.
fn is_camel_case(name: &Ident) -> bool {
    let text = name.to_string();
    text.starts_with(|c: char| c.is_ascii_uppercase())
        && (text.len() == 1 || text.contains(|c: char| c.is_ascii_lowercase()))
}

impl Variant {
    /// Returns a call of one of the methods that the derive writes for the variant.
    fn part(&self, value: Expr, method: &str, args: Vec<Expr>, span: Span) -> Expr {
        let method = Ident::new(&unraw(method), self.name.span());
        Expr { kind: Kind::OfVariant { value: Box::new(value), method, args }, span }
    }

    /// Returns whether a value is of this variant.
    fn is(&self, value: &Expr, span: Span) -> Expr {
        self.part(value.clone(), &format!("__is_{}", self.name), vec![], span)
    }

    /// Returns a field of a value of this variant.
    fn field(&self, value: &Expr, field: &str, span: Span) -> Expr {
        self.part(value.clone(), &format!("__{}_{field}", self.name), vec![], span)
    }

    /// Returns a value of this variant without fields, or with fields that are not named.
    pub(super) fn value(&self, args: Vec<Expr>, span: Span) -> Expr {
        let (ty, name) = (self.ty.clone(), self.name.clone());
        Expr { kind: Kind::Associated { ty, name, args }, span }
    }

    /// Returns a value of this variant with named fields.
    pub(super) fn structure(&self, fields: Vec<(String, Expr)>, span: Span) -> Expr {
        let kind = Kind::NewVariant { ty: self.ty.clone(), name: self.name.clone() };
        let empty = Expr { kind, span };
        fields.into_iter().fold(empty, |value, (field, e)| {
            self.part(value, &format!("__set_{}_{field}", self.name), vec![e], span)
        })
    }
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

/// Returns the condition of a slice pattern on the length; an array's is known.
fn length(s: &syn::PatSlice, from: &Expr) -> Option<Expr> {
    let span = s.span();
    let (rest, others): (Vec<&Pat>, Vec<&Pat>) = s.elems.iter().partition(|p| is_rest(p));
    let op = match (rest.len(), others.len()) {
        (0, _) => "Eq",
        (_, 0) => return None,
        _ => "Ge",
    };
    Some(compare(op, &method(from.clone(), "len", vec![]), number(others.len() as u32, span), span))
}

impl Parser<'_> {
    /// Returns the condition under which `pat` matches `from`, `None` if it always does; its
    /// bindings are added to `lets`.
    pub(super) fn pattern(&mut self, pat: &Pat, from: &Expr, lets: &mut Vec<Stmt>) -> Option<Expr> {
        let span = pat.span();
        match pat {
            Pat::Wild(_) | Pat::Rest(_) => None,
            Pat::Ident(p) if p.by_ref.is_some() => {
                self.errors.at(span, "a kernel has no `ref`", "bind the value: it is copied");
                None
            }
            Pat::Ident(p) if p.ident == "None" => {
                let variant = variant_of(&p.ident.clone().into())?;
                Some(variant.is(from, span))
            }
            Pat::Ident(p) if is_constant(&p.ident) => {
                Some(compare("Eq", from, name(&p.ident), span))
            }
            Pat::Ident(p) => {
                lets.push(Stmt::bind(p.ident.clone(), p.mutability.is_some(), from.clone()));
                p.subpat.as_ref().and_then(|(_, sub)| self.pattern(sub, from, lets))
            }
            Pat::Path(p) if let Some(variant) = unit_variant_of(&p.path) => {
                let (value, path) = (Box::new(from.clone()), p.to_token_stream());
                Some(Expr { kind: Kind::Is { value, path, name: variant.name }, span })
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
            Pat::Struct(s) if let Some(variant) = variant_of(&s.path) => {
                let mut test = Some(variant.is(from, span));
                for f in &s.fields {
                    let field = f.member.to_token_stream().to_string();
                    let item = variant.field(from, &field, f.span());
                    test = both(test, self.pattern(&f.pat, &item, lets));
                }
                test
            }
            Pat::Struct(s) => s.fields.iter().fold(None, |test, f| {
                let item = member(from, f.member.to_token_stream(), f.span());
                both(test, self.pattern(&f.pat, &item, lets))
            }),
            Pat::Slice(s) => self.slice_pattern(s, from, lets),
            Pat::TupleStruct(t) if let Some(variant) = variant_of(&t.path) => {
                self.variant(&variant, t, from, lets)
            }
            Pat::TupleStruct(t) => {
                self.errors.at(
                    t.span(),
                    format!("a kernel has no `{}`", t.path.to_token_stream()),
                    "a kind is written with its enum, as in `Shape::Ball(ball)`; a value that may \
                     be missing is an `Option`: `Some(x)`",
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

    /// Returns the condition of `1 | 2`. What all of the patterns bind, the first that matches
    /// binds.
    fn or_pattern(&mut self, or: &syn::PatOr, from: &Expr, lets: &mut Vec<Stmt>) -> Option<Expr> {
        let mut cases = Vec::new();
        for pat in &or.cases {
            let mut bound = Vec::new();
            let test = self.pattern(pat, from, &mut bound);
            let always = test.is_none();
            cases.push((test, bound));
            if always {
                break;
            }
        }
        let (last_test, last) = cases.pop()?;
        for stmt in last {
            let Stmt::Let(Let { name: Some(name), mutable, init: Some(init), .. }) = stmt else {
                continue;
            };
            let init = cases.iter().rev().fold(init, |otherwise, (test, bound)| {
                let found = bound.iter().find_map(|stmt| match stmt {
                    Stmt::Let(Let { name: Some(n), init: Some(e), .. }) if *n == name => Some(e),
                    _ => None,
                });
                // Where one does not bind the name, rustc says so in the user's own function.
                match (test, found) {
                    (Some(test), Some(e)) => one_of(test.clone(), e.clone(), otherwise),
                    _ => otherwise,
                }
            });
            lets.push(Stmt::bind(name, mutable, init));
        }
        let tests = cases.into_iter().map(|(test, _)| test).chain([last_test]);
        let tests = tests.collect::<Option<Vec<_>>>()?;
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

    /// Returns the condition of `[a, _, ..]`: the list is as long, and the elements match.
    fn slice_pattern(
        &mut self,
        s: &syn::PatSlice,
        from: &Expr,
        lets: &mut Vec<Stmt>,
    ) -> Option<Expr> {
        let mut test = length(s, from);
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

    /// Returns the condition of `Shape::Ball(centre, radius)`.
    fn variant(
        &mut self,
        variant: &Variant,
        pat: &syn::PatTupleStruct,
        from: &Expr,
        lets: &mut Vec<Stmt>,
    ) -> Option<Expr> {
        let mut test = Some(variant.is(from, pat.span()));
        for (i, p) in pat.elems.iter().enumerate() {
            if matches!(p, Pat::Rest(_)) && i + 1 < pat.elems.len() {
                self.errors.at(
                    p.span(),
                    "`..` stands last in a kernel's pattern of a kind",
                    "write `_` for each field before the ones that you name",
                );
                return None;
            }
            let item = variant.field(from, &i.to_string(), p.span());
            test = both(test, self.pattern(p, &item, lets));
        }
        test
    }

    /// Returns a value that patterns read more than once; it gets a name unless it is one, and also
    /// if a pattern rebinds that name.
    pub(super) fn read_often(
        &mut self,
        e: Expr,
        bound: &TokenStream,
        lets: &mut Vec<Stmt>,
    ) -> Expr {
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
            is_pattern: true,
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
