//! From syn's syntax to the model. The only module that knows syn's expressions.

mod iteration;
mod pattern;
mod refused;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, quote};
use syn::spanned::Spanned;
use syn::{BinOp, Lit, Pat, UnOp};

use crate::diag::Errors;
use crate::generics::Generics;
use crate::model::{BinaryOp, Block, Expr, IntType, Kernel, Kind, Let, Param, Place, Step, Stmt};
use crate::ops;

/// A function or method; `self_ty` is the type of the `impl`.
pub(crate) fn function(
    attrs: &[syn::Attribute],
    sig: &syn::Signature,
    body: &syn::Block,
    self_ty: Option<&syn::Type>,
    errors: &mut Errors,
) -> Kernel {
    let before = errors.count();
    for (bad, what) in [
        (sig.asyncness.as_ref().map(Spanned::span), "async"),
        (matches!(sig.safety, syn::Safety::Unsafe(_)).then(|| sig.safety.span()), "unsafe"),
    ] {
        if let Some(span) = bad {
            errors.at(span, format!("a kernel cannot be `{what}`"), &format!("remove `{what}`"));
        }
    }
    let mut parser = Parser {
        errors,
        temporaries: 0,
        is_nested: false,
        is_coherent: attrs.iter().any(is_coherent),
    };
    let mut prologue = Vec::new();
    let params = sig.inputs.iter().map(|arg| parser.param(arg, self_ty, &mut prologue)).collect();
    let result = match &sig.output {
        syn::ReturnType::Default => None,
        syn::ReturnType::Type(_, ty) if is_unit(ty) => None,
        syn::ReturnType::Type(_, ty) => {
            if matches!(&**ty, syn::Type::Reference(r) if r.mutability.is_some()) {
                parser.errors.at(
                    ty.span(),
                    "a kernel gives no `&mut`: what it gives is a copy",
                    "give the value, or nothing, and go on with the variable that was changed",
                );
            }
            Some(parser.ty(ty))
        }
    };
    let is_broken = parser.errors.count() > before;
    let mut body = parser.block(body);
    body.stmts.splice(0..0, prologue);
    let generics = Generics::new(&sig.generics);
    let is_apart = attrs.iter().any(is_never_inlined);
    Kernel { name: sig.ident.clone(), generics, params, result, body, is_apart, is_broken }
}

/// A closure literal; its parameters must have types.
pub(crate) fn closure(c: &syn::ExprClosure, name: &str, errors: &mut Errors) -> Kernel {
    let is_coherent = c.attrs.iter().any(is_coherent);
    let mut parser = Parser { errors, temporaries: 0, is_nested: false, is_coherent };
    parser.closure(c, name)
}

/// The type without references: values on a machine are copied.
fn value_type(ty: &syn::Type) -> TokenStream {
    match ty {
        syn::Type::Reference(r) => value_type(&r.elem),
        syn::Type::Paren(p) => value_type(&p.elem),
        _ => ty.to_token_stream(),
    }
}

fn without_references(mut ty: &syn::Type) -> &syn::Type {
    while let syn::Type::Reference(r) = ty {
        ty = &r.elem;
    }
    ty
}

/// The last name of a type that is a path.
pub(crate) fn type_name(ty: &syn::Type) -> Option<String> {
    match ty {
        syn::Type::Path(t) => t.path.segments.last().map(|s| s.ident.to_string()),
        _ => None,
    }
}

fn is_unit(ty: &syn::Type) -> bool {
    matches!(ty, syn::Type::Tuple(t) if t.elems.is_empty())
}

/// Slices, trees and textures are not copied.
fn is_data(ty: &syn::Type) -> bool {
    match ty {
        syn::Type::Reference(r) => is_data(&r.elem),
        syn::Type::Slice(_) => true,
        syn::Type::Path(_) => type_name(ty).is_some_and(|name| ops::is_data(&name)),
        _ => false,
    }
}

/// A type that no kernel can have: where it is, what it is, and what to write instead.
pub(crate) fn refused_type(ty: &syn::Type) -> Option<(Span, String, &'static str)> {
    match ty {
        syn::Type::Reference(r) => refused_type(&r.elem),
        syn::Type::Paren(p) => refused_type(&p.elem),
        syn::Type::Slice(s) => refused_type(&s.elem),
        syn::Type::Array(a) => refused_type(&a.elem),
        syn::Type::Tuple(t) => t.elems.iter().find_map(refused_type),
        syn::Type::TraitObject(t) => Some((
            t.span(),
            "trait objects".to_owned(),
            "give the trait `#[kernel]` and write `fn f<T: Light>(light: T)`",
        )),
        syn::Type::Ptr(t) => Some((t.span(), "pointers".to_owned(), "take the value or a slice")),
        syn::Type::Path(t) => {
            let name = &t.path.segments.last()?.ident;
            let help = ops::refused_type(&name.to_string())?;
            Some((name.span(), format!("`{name}`"), help))
        }
        _ => None,
    }
}

fn label(l: &Option<syn::Label>) -> Option<String> {
    l.as_ref().map(|l| l.name.ident.to_string())
}

fn lifetime(l: &Option<syn::Lifetime>) -> Option<String> {
    l.as_ref().map(|l| l.ident.to_string())
}

/// Where a mistake in `e` is shown: at the operator or the name, which is where rustc shows it.
fn place(e: &syn::Expr) -> Span {
    match e {
        syn::Expr::Binary(b) => b.op.span(),
        syn::Expr::MethodCall(c) => c.method.span(),
        syn::Expr::Field(f) => f.member.span(),
        syn::Expr::Cast(c) => c.ty.span(),
        syn::Expr::Paren(p) => place(&p.expr),
        _ => e.span(),
    }
}

/// Whether a path segment names a type rather than a module.
fn is_type_name(ident: &Ident) -> bool {
    let name = ident.to_string();
    name.starts_with(|c: char| c.is_ascii_uppercase())
        || matches!(name.as_str(), "f32" | "i32" | "u32" | "usize" | "bool")
}

struct Parser<'a> {
    errors: &'a mut Errors,
    /// How many names have been made up.
    temporaries: usize,
    /// Whether a closure within the kernel is being read.
    is_nested: bool,
    /// Whether the whole kernel is `#[coherent]`.
    is_coherent: bool,
}

/// The label of a nested closure: its `return` leaves the closure, not the kernel around it.
const NESTED: &str = "__closure";

impl Parser<'_> {
    fn param(
        &mut self,
        arg: &syn::FnArg,
        self_ty: Option<&syn::Type>,
        prologue: &mut Vec<Stmt>,
    ) -> Param {
        match arg {
            syn::FnArg::Receiver(r) => {
                let by_mut = matches!(r.kind, syn::ReceiverKind::Reference(_, _, Some(_)));
                let ty = self_ty.map(ToTokens::to_token_stream).unwrap_or_else(|| quote!(Self));
                let mutable = r.mutability.is_some() && !by_mut;
                Param {
                    name: Ident::new("self", r.self_token.span),
                    ty,
                    mutable,
                    by_mut,
                    data: false,
                    host: false,
                }
            }
            syn::FnArg::Typed(p) => self.typed_param(p, prologue),
        }
    }

    fn typed_param(&mut self, typed: &syn::PatType, prologue: &mut Vec<Stmt>) -> Param {
        let syn::PatType { attrs, pat, ty, .. } = typed;
        self.no_attributes(attrs);
        let by_mut = matches!(&**ty, syn::Type::Reference(r) if r.mutability.is_some());
        let host = attrs.iter().any(is_host);
        let shared = matches!(&**ty, syn::Type::Reference(r) if r.mutability.is_none());
        if let syn::Type::ImplTrait(t) = without_references(ty) {
            self.errors.at(
                t.span(),
                "a kernel's type parameters have names",
                "write `fn f<T: Light>(light: T)` in place of `light: impl Light`",
            );
        }
        let (written, ty) = (ty, self.ty(ty));
        match &**pat {
            Pat::Ident(p) if p.by_ref.is_none() && p.subpat.is_none() => Param {
                name: p.ident.clone(),
                ty,
                mutable: p.mutability.is_some() && !by_mut,
                by_mut,
                data: shared && is_data(written),
                host,
            },
            _ => {
                if by_mut {
                    self.errors.at(
                        pat.span(),
                        "a `&mut` parameter of a kernel has one name",
                        "write `s: &mut S`, and `s.x` in the kernel",
                    );
                }
                let name = self.temporary("parts");
                let from = Expr { kind: Kind::Name(name.clone()), span: pat.span() };
                self.irrefutable(pat, &from, prologue);
                Param { name, ty, mutable: false, by_mut: false, data: false, host: false }
            }
        }
    }

    fn closure(&mut self, c: &syn::ExprClosure, name: &str) -> Kernel {
        let (mut params, mut prologue) = (Vec::new(), Vec::new());
        for pat in &c.inputs {
            let Pat::Type(typed) = pat else {
                self.errors.at(
                    pat.span(),
                    "a parameter of a kernel needs a type",
                    "write for example `|ray: Ray|`",
                );
                continue;
            };
            let param = self.typed_param(typed, &mut prologue);
            if param.by_mut {
                self.errors.at(
                    typed.ty.span(),
                    "a closure kernel has no `&mut` parameters: nothing would see the change",
                    "return the new value",
                );
            }
            params.push(param);
        }
        let result = match &c.output {
            syn::ReturnType::Default => None,
            syn::ReturnType::Type(_, ty) if is_unit(ty) => None,
            syn::ReturnType::Type(_, ty) => Some(self.ty(ty)),
        };
        let mut body = match &*c.body {
            syn::Expr::Block(b) if b.label.is_none() => self.block(&b.block),
            e => Block { stmts: vec![], tail: Some(Box::new(self.expr(e))) },
        };
        body.stmts.splice(0..0, prologue);
        let name = Ident::new(name, Span::call_site());
        let (generics, is_apart, is_broken) = (Generics::default(), false, false);
        Kernel { name, generics, params, result, body, is_apart, is_broken }
    }

    /// A closure as an argument. With a `return` its body is a labelled block.
    fn nested(&mut self, c: &syn::ExprClosure) -> Kind {
        if self.is_nested {
            return self.error(
                c.span(),
                "a kernel has no closures within closures",
                "write the inner one as a `#[kernel] fn`",
            );
        }
        self.is_nested = true;
        let mut kernel = self.closure(c, "closure");
        self.is_nested = false;
        if kernel.body.leaves(NESTED) {
            let tail = kernel.body.tail.take();
            let span = c.span();
            let exit = Expr { kind: Kind::Break(Some(NESTED.to_owned()), tail), span };
            kernel.body.stmts.push(Stmt::Expr(exit));
            let once = Kind::Loop { label: Some(NESTED.to_owned()), body: kernel.body };
            let tail = Some(Box::new(Expr { kind: once, span }));
            kernel.body = Block { stmts: vec![], tail };
        }
        Kind::Closure(Box::new(kernel))
    }

    /// The type without references; some are known to be none of kernels.
    fn ty(&mut self, ty: &syn::Type) -> TokenStream {
        if let Some((span, what, help)) = refused_type(ty) {
            self.errors.at(span, format!("a kernel has no {what}"), help);
        }
        value_type(ty)
    }

    fn error(&mut self, span: Span, what: impl core::fmt::Display, help: &str) -> Kind {
        self.errors.at(span, what, help);
        Kind::Error
    }

    /// The lifted code would not know of a `#[cfg]`.
    fn no_attributes(&mut self, attrs: &[syn::Attribute]) {
        for a in
            attrs.iter().filter(|a| !a.path().is_ident("allow") && !is_host(a) && !is_coherent(a))
        {
            self.errors.at(
                a.span(),
                "a kernel has no attributes on statements and expressions",
                "remove it; to leave code out, branch on a captured `bool` or a `const`",
            );
        }
    }

    fn boxed(&mut self, e: &syn::Expr) -> Box<Expr> {
        Box::new(self.expr(e))
    }

    fn exprs<'b>(&mut self, es: impl IntoIterator<Item = &'b syn::Expr>) -> Vec<Expr> {
        es.into_iter().map(|e| self.expr(e)).collect()
    }

    fn block(&mut self, b: &syn::Block) -> Block {
        let mut stmts = Vec::new();
        let mut tail = None;
        let last = b.stmts.len().wrapping_sub(1);
        for (i, stmt) in b.stmts.iter().enumerate() {
            match stmt {
                syn::Stmt::Local(l) => stmts.extend(self.local(l)),
                syn::Stmt::Expr(e, None) if i == last => tail = Some(self.boxed(e)),
                syn::Stmt::Expr(e, _) => stmts.push(Stmt::Expr(self.expr(e))),
                syn::Stmt::Item(item) => stmts.extend(self.item(item)),
                syn::Stmt::Macro(m) => {
                    self.no_attributes(&m.attrs);
                    let kind = self.macro_call(&m.mac);
                    stmts.push(Stmt::Expr(Expr { kind, span: m.span() }));
                }
            }
        }
        Block { stmts, tail }
    }

    fn item(&mut self, item: &syn::Item) -> Option<Stmt> {
        match item {
            syn::Item::Const(_) | syn::Item::Use(_) => Some(Stmt::Item(item.to_token_stream())),
            _ => {
                self.errors.at(
                    item.span(),
                    "this item cannot stand inside a kernel",
                    "move it out of the kernel",
                );
                None
            }
        }
    }

    fn local(&mut self, l: &syn::Local) -> Vec<Stmt> {
        self.no_attributes(&l.attrs);
        let (pat, ty) = match &l.pat {
            Pat::Type(t) => (&*t.pat, Some(self.ty(&t.ty))),
            pat => (pat, None),
        };
        let init = match &l.init {
            Some(init) => {
                if let Some((_, e)) = &init.diverge {
                    self.errors.at(
                        e.span(),
                        "a kernel has no `let ... else`",
                        "write an `if` that returns early",
                    );
                    return Vec::new();
                }
                Some(self.expr(&init.expr))
            }
            None => None,
        };
        let (name, mutable) = match pat {
            Pat::Ident(p) if p.by_ref.is_none() && p.subpat.is_none() => {
                (Some(p.ident.clone()), p.mutability.is_some())
            }
            Pat::Wild(_) => (None, false),
            _ => {
                let Some(init) = init else {
                    self.errors.at(
                        pat.span(),
                        "a pattern of a kernel needs a value",
                        "declare each name by itself: `let a; let b;`",
                    );
                    return Vec::new();
                };
                if ty.is_none() {
                    self.typed_numbers(pat, &init);
                }
                if matches!(pat, Pat::Tuple(_)) && refused::gives_struct(&init.kind) {
                    self.errors.leave_to_rustc();
                }
                return self.destructure(pat, init, ty);
            }
        };
        if let Some(init) = &init
            && mutable
            && ty.is_none()
            && !l.attrs.iter().any(is_host)
        {
            self.typed_number(init);
        }
        let host = l.attrs.iter().any(is_host);
        if host && init.is_none() {
            self.errors.at(
                l.span(),
                "a host variable needs a value",
                "give it one: `let n = 4u32;`",
            );
        }
        vec![Stmt::Let(Let { host, name, mutable, ty, init })]
    }

    /// What a variable begins with must say which type of integer it is.
    fn typed_number(&mut self, init: &Expr) {
        let is_untyped = match &init.kind {
            Kind::Repeat { value, .. } => value.is_untyped_integer(),
            Kind::Array(items) => !items.is_empty() && items.iter().all(Expr::is_untyped_integer),
            Kind::Binary { a, b, .. } => a.is_untyped_integer() && b.is_untyped_integer(),
            _ => init.is_untyped_integer(),
        };
        if is_untyped {
            self.errors.at(
                init.span,
                "a mutable integer needs a type",
                "write `let mut n: u32 = ...`, or give the number a suffix: `0u32`",
            );
        }
    }

    fn typed_numbers(&mut self, pat: &Pat, init: &Expr) {
        if let (Pat::Tuple(pats), Kind::Tuple(items)) = (pat, &init.kind) {
            for (pat, item) in pats.elems.iter().zip(items) {
                match pat {
                    Pat::Ident(p) if p.mutability.is_some() => self.typed_number(item),
                    pat => self.typed_numbers(pat, item),
                }
            }
        }
    }

    fn expr(&mut self, e: &syn::Expr) -> Expr {
        self.no_attributes(attributes(e));
        Expr { kind: self.kind(e), span: place(e) }
    }

    fn kind(&mut self, e: &syn::Expr) -> Kind {
        match e {
            syn::Expr::Lit(l) => self.literal(&l.lit),
            syn::Expr::Path(p) => self.path(p),
            syn::Expr::Paren(p) => self.kind(&p.expr),
            syn::Expr::Group(g) => self.kind(&g.expr),
            syn::Expr::Unary(u) => self.unary(u),
            syn::Expr::Binary(b) => self.binary(b),
            syn::Expr::Cast(c) => Kind::Cast { value: self.boxed(&c.expr), ty: self.ty(&c.ty) },
            syn::Expr::Call(c) => self.call(c),
            syn::Expr::MethodCall(c) => self.method(c),
            syn::Expr::Field(f) => {
                Kind::Field { base: self.boxed(&f.base), member: f.member.to_token_stream() }
            }
            syn::Expr::Index(i) => self.index(i),
            syn::Expr::Struct(s) => self.structure(s),
            syn::Expr::Tuple(t) => Kind::Tuple(self.exprs(&t.elems)),
            syn::Expr::If(i) => self.conditional(i),
            syn::Expr::While(w) => Kind::While {
                label: label(&w.label),
                c: self.boxed(&w.cond),
                body: self.block(&w.body),
            },
            syn::Expr::Loop(l) => Kind::Loop { label: label(&l.label), body: self.block(&l.body) },
            syn::Expr::ForLoop(f) => self.for_loop(f),
            syn::Expr::Block(b) => match &b.label {
                None => Kind::Block(self.block(&b.block)),
                Some(_) => self.labelled_block(b),
            },
            syn::Expr::Break(b) => {
                let value = b.expr.as_ref().map(|e| self.boxed(e));
                Kind::Break(lifetime(&b.label), value)
            }
            syn::Expr::Match(m) => self.matching(m),
            syn::Expr::Array(a) => Kind::Array(self.exprs(&a.elems)),
            syn::Expr::Repeat(r) => {
                Kind::Repeat { value: self.boxed(&r.expr), len: r.len.to_token_stream() }
            }
            syn::Expr::Continue(c) => Kind::Continue(lifetime(&c.label)),
            syn::Expr::Return(r) => {
                let value = r.expr.as_ref().map(|e| self.boxed(e));
                if self.is_nested {
                    Kind::Break(Some(NESTED.to_owned()), value)
                } else {
                    Kind::Return(value)
                }
            }
            syn::Expr::Assign(a) if matches!(&*a.left, syn::Expr::Tuple(_)) => {
                self.assign_tuple(&a.left, &a.right)
            }
            syn::Expr::Assign(a) => {
                let (place, value) = (self.place(&a.left), self.boxed(&a.right));
                match place {
                    Some(place) => Kind::Assign { place, value },
                    None => value.kind,
                }
            }
            // Values are copied: a reference is the value, and so is what it refers to.
            syn::Expr::Reference(r) if r.mutability.is_none() => self.kind(&r.expr),
            syn::Expr::Macro(m) => self.macro_call(&m.mac),
            other => self.unsupported(other),
        }
    }

    /// `(a, b) = (b, a)`: all of the right side comes first.
    fn assign_tuple(&mut self, left: &syn::Expr, right: &syn::Expr) -> Kind {
        let syn::Expr::Tuple(left) = left else { return Kind::Error };
        let (span, parts) = (right.span(), self.temporary("parts"));
        let init = Some(self.expr(right));
        let name = Some(parts.clone());
        let mut stmts = vec![Stmt::Let(Let { host: false, name, mutable: false, ty: None, init })];
        for (i, e) in left.elems.iter().enumerate() {
            if matches!(e, syn::Expr::Infer(_)) {
                continue;
            }
            let Some(place) = self.place(e) else { return Kind::Error };
            let base = Box::new(Expr { kind: Kind::Name(parts.clone()), span });
            let index = syn::Index { index: i as u32, span: e.span() };
            let part = Kind::Field { base, member: index.to_token_stream() };
            let value = Box::new(Expr { kind: part, span });
            stmts.push(Stmt::Expr(Expr { kind: Kind::Assign { place, value }, span }));
        }
        Kind::Block(Block { stmts, tail: None })
    }

    fn unsupported(&mut self, e: &syn::Expr) -> Kind {
        let (what, help) = match e {
            syn::Expr::Closure(_) => {
                ("closures but as arguments", "write a `#[kernel] fn` and call it")
            }
            syn::Expr::Try(_) => ("`?`", "give a value that says what happened: a miss is data"),
            syn::Expr::Reference(_) => {
                ("`&mut` outside the arguments of a call", "write the variable itself")
            }
            syn::Expr::Range(_) => ("ranges outside `for`", "write `for i in a..b`"),
            syn::Expr::Let(_) => {
                ("`if let` and `while let`", "compare the value: kernels have no Option")
            }
            syn::Expr::Unsafe(_) => ("`unsafe`", "write safe code"),
            syn::Expr::Await(_) | syn::Expr::Async(_) => ("`async`", "write plain code"),
            _ => ("this expression", "write it with the operations of the kernel language"),
        };
        self.error(e.span(), format!("a kernel has no {what}"), help)
    }

    fn literal(&mut self, lit: &Lit) -> Kind {
        match lit {
            Lit::Float(f) if f.suffix() == "f64" => self.error(
                f.span(),
                "kernels compute in `f32`",
                "write the number with the suffix `f32`, or without one",
            ),
            Lit::Float(f) => {
                let digits = syn::LitFloat::new(
                    &format!("{}f32", f.base10_digits().trim_end_matches('.')),
                    f.span(),
                );
                Kind::Float(digits.to_token_stream())
            }
            Lit::Int(i) => match i.suffix() {
                "" => Kind::Int { tokens: i.to_token_stream(), suffix: None },
                "i32" => Kind::Int { tokens: i.to_token_stream(), suffix: Some(IntType::I32) },
                "u32" => Kind::Int { tokens: i.to_token_stream(), suffix: Some(IntType::U32) },
                "usize" => Kind::Int { tokens: i.to_token_stream(), suffix: Some(IntType::Usize) },
                "f32" => Kind::Float(i.to_token_stream()),
                other => self.error(
                    i.span(),
                    format!("kernels have no `{other}`"),
                    "use `u32`, `i32`, `usize` or `f32`",
                ),
            },
            Lit::Bool(b) => Kind::Bool(b.value),
            _ => self.error(
                lit.span(),
                "a kernel has numbers and truth values only",
                "keep text outside the kernel",
            ),
        }
    }

    fn path(&mut self, p: &syn::ExprPath) -> Kind {
        if let Some(last) = p.path.segments.last().filter(|s| refused::is_absent(&s.ident)) {
            return self.absent(&last.ident);
        }
        match p.path.get_ident() {
            Some(ident) => Kind::Name(ident.clone()),
            None => Kind::Path(p.to_token_stream()),
        }
    }

    fn unary(&mut self, u: &syn::ExprUnary) -> Kind {
        match u.op {
            UnOp::Neg(_) => Kind::Neg(self.boxed(&u.expr)),
            UnOp::Not(_) => Kind::Not(self.boxed(&u.expr)),
            _ => Kind::Deref(self.boxed(&u.expr)),
        }
    }

    fn binary(&mut self, b: &syn::ExprBinary) -> Kind {
        if let Some(op) = assignment(&b.op) {
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
            return Kind::OpAssign { op, place, value };
        }
        let (left, right) = (self.boxed(&b.left), self.boxed(&b.right));
        let compare = match b.op {
            BinOp::And(_) => return Kind::Logic { and: true, a: left, b: right },
            BinOp::Or(_) => return Kind::Logic { and: false, a: left, b: right },
            BinOp::Eq(_) => Some("Eq"),
            BinOp::Ne(_) => Some("Ne"),
            BinOp::Lt(_) => Some("Lt"),
            BinOp::Le(_) => Some("Le"),
            BinOp::Gt(_) => Some("Gt"),
            BinOp::Ge(_) => Some("Ge"),
            _ => None,
        };
        match (compare, arithmetic(&b.op)) {
            (Some(op), _) => Kind::Compare { op, a: left, b: right },
            (None, Some(op)) => Kind::Binary { op, a: left, b: right },
            (None, None) => self.error(b.op.span(), "a kernel has no such operator", "rewrite it"),
        }
    }

    /// Arguments may be `&mut`.
    fn arguments<'b>(&mut self, args: impl IntoIterator<Item = &'b syn::Expr>) -> Vec<Expr> {
        args.into_iter()
            .map(|e| match e {
                syn::Expr::Reference(r) if r.mutability.is_some() => {
                    let kind = self.place(&r.expr).map_or(Kind::Error, Kind::RefMut);
                    Expr { kind, span: e.span() }
                }
                syn::Expr::Closure(c) => Expr { kind: self.nested(c), span: e.span() },
                e => self.expr(e),
            })
            .collect()
    }

    fn call(&mut self, c: &syn::ExprCall) -> Kind {
        if let Some(refused) = self.refused_call(c) {
            return refused;
        }
        let args = self.arguments(&c.args);
        let syn::Expr::Path(p) = &*c.func else {
            return self.error(c.func.span(), "only a kernel can be called", "call it by its name");
        };
        if let Some(q) = &p.qself {
            let mut path = p.path.clone();
            let Some(last) = path.segments.pop() else { return Kind::Error };
            path.segments.pop_punct();
            let (name, ty) = (last.ident, &q.ty);
            let ty = if path.segments.is_empty() { quote!(#ty) } else { quote!(#ty as #path) };
            return Kind::Associated { ty, name, args };
        }
        let segments: Vec<&syn::PathSegment> = p.path.segments.iter().collect();
        let Some((last, init)) = segments.split_last() else { return Kind::Error };
        match init.last() {
            Some(owner) if is_type_name(&owner.ident) => {
                let mut ty = p.path.clone();
                ty.segments.pop();
                ty.segments.pop_punct();
                Kind::Associated { ty: ty.to_token_stream(), name: last.ident.clone(), args }
            }
            _ if refused::is_absent(&last.ident) => self.absent(&last.ident),
            _ if is_type_name(&last.ident) => self.error(
                last.span(),
                "a kernel has no tuple structs",
                "give the struct named members",
            ),
            _ if segments.len() == 1 && last.ident == "host" && args.len() == 1 => {
                Kind::Host(Box::new(args.into_iter().next().expect("there is one")))
            }
            _ => Kind::Call { path: p.to_token_stream(), args },
        }
    }

    fn method(&mut self, c: &syn::ExprMethodCall) -> Kind {
        if let Some(refused) = self.refused_iteration(c) {
            return refused;
        }
        let generic = c.turbofish.iter().flat_map(|t| &t.args);
        Kind::Method {
            receiver: self.boxed(&c.receiver),
            name: c.method.clone(),
            turbofish: generic.map(generic_argument).collect(),
            args: self.arguments(&c.args),
        }
    }

    fn index(&mut self, i: &syn::ExprIndex) -> Kind {
        let base = self.boxed(&i.expr);
        match self.step(&i.index) {
            Some(Step::Element(index)) => Kind::Index { base, index },
            Some(Step::Computed(index)) => Kind::Element { base, index: Box::new(index) },
            _ => Kind::Error,
        }
    }

    /// What stands between brackets.
    fn step(&mut self, index: &syn::Expr) -> Option<Step> {
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
                    "a kernel has no slices of slices",
                    "index the whole: `all[first + i]`",
                );
                None
            }
            index => Some(Step::Computed(self.expr(index))),
        }
    }

    /// A labelled block is a loop that goes round once: only its label can leave it (E0695).
    fn labelled_block(&mut self, b: &syn::ExprBlock) -> Kind {
        let label = label(&b.label);
        let mut body = self.block(&b.block);
        let span = b.span();
        let tail = body.tail.take();
        let exit = Expr { kind: Kind::Break(label.clone(), tail), span };
        body.stmts.push(Stmt::Expr(exit));
        Kind::Loop { label, body }
    }

    fn structure(&mut self, s: &syn::ExprStruct) -> Kind {
        s.fields.iter().for_each(|f| self.no_attributes(&f.attrs));
        let fields =
            s.fields.iter().map(|f| (f.member.to_token_stream(), self.expr(&f.expr))).collect();
        let rest = s.rest.as_ref().map(|e| self.boxed(e));
        Kind::Struct { path: s.path.to_token_stream(), fields, rest }
    }

    fn conditional(&mut self, i: &syn::ExprIf) -> Kind {
        Kind::If {
            coherent: self.is_coherent || i.attrs.iter().any(is_coherent),
            c: self.boxed(&i.cond),
            then: self.block(&i.then_branch),
            otherwise: i.else_branch.as_ref().map(|(_, e)| self.boxed(e)),
        }
    }

    fn place(&mut self, e: &syn::Expr) -> Option<Place> {
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

    fn macro_call(&mut self, m: &syn::Macro) -> Kind {
        let name = m.path.segments.last().map(|s| s.ident.to_string()).unwrap_or_default();
        let help = match name.as_str() {
            "vec" => "kernels have no heap: use a struct or a vector",
            "println" | "print" | "eprintln" | "dbg" => "return the value and print it outside",
            "assert" | "debug_assert" | "panic" | "todo" | "unreachable" => {
                "a kernel cannot stop: return a value that says what happened"
            }
            _ => "write out what it stands for: the macro cannot see inside another macro",
        };
        self.error(m.path.span(), format!("a kernel cannot call the macro `{name}!`"), help)
    }
}

/// A generic argument as a type; numbers have a type of their own.
fn generic_argument(arg: &syn::GenericArgument) -> TokenStream {
    let constant = |n: &dyn ToTokens| quote!(::raydsl::__private::Const<{ #n }>);
    match arg {
        syn::GenericArgument::Const(n) => constant(n),
        // The name of a constant parameter looks like a type.
        syn::GenericArgument::Type(syn::Type::Path(t))
            if t.path.get_ident().is_some_and(|i| *i == i.to_string().to_uppercase()) =>
        {
            constant(t)
        }
        arg => arg.to_token_stream(),
    }
}

/// `#[host]`.
fn is_host(a: &syn::Attribute) -> bool {
    a.path().is_ident("host")
}

/// `#[inline(never)]`.
fn is_never_inlined(a: &syn::Attribute) -> bool {
    a.path().is_ident("inline") && a.parse_args::<Ident>().is_ok_and(|how| how == "never")
}

/// `#[coherent]`.
fn is_coherent(a: &syn::Attribute) -> bool {
    a.path().is_ident("coherent")
}

fn inside_parens(mut e: &syn::Expr) -> &syn::Expr {
    while let syn::Expr::Paren(p) = e {
        e = &p.expr;
    }
    e
}

fn attributes(e: &syn::Expr) -> &[syn::Attribute] {
    macro_rules! all {
        ($($kind:ident)+) => {
            match e {
                $(syn::Expr::$kind(x) => &x.attrs,)+
                _ => &[],
            }
        };
    }
    all!(
        Array Assign Async Await Binary Block Break Call Cast Closure Const Continue Field ForLoop Group If Index Infer Let Lit Loop Macro Match MethodCall Paren Path Range Reference Repeat Return Struct Try TryBlock Tuple Unary Unsafe While Yield
    )
}

fn arithmetic(op: &BinOp) -> Option<BinaryOp> {
    Some(match op {
        BinOp::Add(_) => ops::ADD,
        BinOp::Sub(_) => ops::SUB,
        BinOp::Mul(_) => ops::MUL,
        BinOp::Div(_) => ops::DIV,
        BinOp::Rem(_) => ops::REM,
        BinOp::BitAnd(_) => ops::BIT_AND,
        BinOp::BitOr(_) => ops::BIT_OR,
        BinOp::BitXor(_) => ops::BIT_XOR,
        BinOp::Shl(_) => ops::SHL,
        BinOp::Shr(_) => ops::SHR,
        _ => return None,
    })
}

fn assignment(op: &BinOp) -> Option<BinaryOp> {
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
