//! Parsing of functions and closures: their parameters and results.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, quote};
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::attributes::{is_host, is_never_inlined};
use super::expression::run_once;
use super::types::{is_data, is_mut_reference, is_unit, without_references};
use crate::diag::Errors;
use crate::generics::Generics;
use crate::model::{Block, Expr, Kernel, Kind, Param, Stmt};

/// The label of a nested closure: its `return` leaves the closure, not the kernel around it.
pub(super) const NESTED: &str = "__closure";

/// Parses a function or method; `self_ty` is the type of the `impl`.
pub(crate) fn function(
    attrs: &[syn::Attribute],
    sig: &syn::Signature,
    body: &syn::Block,
    self_ty: Option<&syn::Type>,
    errors: &mut Errors,
) -> Kernel {
    let before = errors.count();
    check_qualifiers(sig, errors);
    let mut parser = Parser::new(attrs, errors);
    let mut prologue = Vec::new();
    let params = sig.inputs.iter().map(|arg| parser.param(arg, self_ty, &mut prologue)).collect();
    parser.check_result(&sig.output);
    let result = parser.result(&sig.output);
    let is_broken = parser.errors.count() > before;
    let mut body = parser.block(body);
    body.stmts.splice(0..0, prologue);
    let generics = Generics::new(&sig.generics);
    let is_apart = attrs.iter().any(is_never_inlined);
    let name = sig.ident.clone();
    Kernel { name, generics, params, result, body, is_apart, known: None, is_broken }
}

/// Checks that a kernel is neither `async` nor `unsafe`.
fn check_qualifiers(sig: &syn::Signature, errors: &mut Errors) {
    for (bad, what) in [
        (sig.asyncness.as_ref().map(Spanned::span), "async"),
        (matches!(sig.safety, syn::Safety::Unsafe(_)).then(|| sig.safety.span()), "unsafe"),
    ] {
        if let Some(span) = bad {
            errors.at(span, format!("a kernel cannot be `{what}`"), &format!("remove `{what}`"));
        }
    }
}

/// Parses a closure literal; its parameters must have types.
pub(crate) fn closure(c: &syn::ExprClosure, name: &str, errors: &mut Errors) -> Kernel {
    Parser::new(&c.attrs, errors).closure(c, name)
}

/// Parses `self`, `&self` and `&mut self`.
fn receiver(r: &syn::Receiver, self_ty: Option<&syn::Type>) -> Param {
    let by_mut = matches!(r.kind, syn::ReceiverKind::Reference(_, _, Some(_)));
    let mutable = r.mutability.is_some() && !by_mut;
    let ty = self_ty.map(ToTokens::to_token_stream).unwrap_or_else(|| quote!(Self));
    let name = Ident::new("self", r.self_token.span);
    Param { name, ty, mutable, by_mut, data: false, host: false }
}

impl Parser<'_> {
    /// Returns a result type that is written, and is not `()`.
    fn result(&mut self, output: &syn::ReturnType) -> Option<TokenStream> {
        match output {
            syn::ReturnType::Default => None,
            syn::ReturnType::Type(_, ty) if is_unit(ty) => None,
            syn::ReturnType::Type(_, ty) => Some(self.ty(ty)),
        }
    }

    /// Checks that a function's result is not `&mut`.
    fn check_result(&mut self, output: &syn::ReturnType) {
        let syn::ReturnType::Type(_, ty) = output else { return };
        if is_mut_reference(ty) {
            self.errors.at(
                ty.span(),
                "a kernel gives no `&mut`: what it gives is a copy",
                "give the value, or nothing, and go on with the variable that was changed",
            );
        }
    }

    fn param(
        &mut self,
        arg: &syn::FnArg,
        self_ty: Option<&syn::Type>,
        prologue: &mut Vec<Stmt>,
    ) -> Param {
        match arg {
            syn::FnArg::Receiver(r) => receiver(r, self_ty),
            syn::FnArg::Typed(p) => self.typed_param(p, prologue),
        }
    }

    fn typed_param(&mut self, typed: &syn::PatType, prologue: &mut Vec<Stmt>) -> Param {
        let syn::PatType { attrs, pat, ty, .. } = typed;
        self.no_attributes(attrs);
        let by_mut = is_mut_reference(ty);
        let host = attrs.iter().any(is_host);
        let shared = matches!(&**ty, syn::Type::Reference(_)) && !by_mut;
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
            pat => {
                if host {
                    self.errors.at(
                        pat.span(),
                        "a `#[host]` parameter has one name",
                        "write `#[host] size: (u32, u32)`, and `size.0` in the kernel",
                    );
                }
                self.parts_param(pat, ty, by_mut, prologue)
            }
        }
    }

    /// Parses a parameter whose pattern names its parts; the prologue binds them.
    fn parts_param(
        &mut self,
        pat: &Pat,
        ty: TokenStream,
        by_mut: bool,
        prologue: &mut Vec<Stmt>,
    ) -> Param {
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

    /// Parses a closure that is a kernel, or an argument of one's operations.
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
        if let Some(asyncness) = &c.asyncness {
            self.errors.at(asyncness.span(), "a kernel cannot be `async`", "remove `async`");
        }
        self.check_result(&c.output);
        let result = self.result(&c.output);
        let mut body = match &*c.body {
            syn::Expr::Block(b) if b.label.is_none() => self.block(&b.block),
            e => Block { stmts: vec![], tail: Some(Box::new(self.expr(e))) },
        };
        body.stmts.splice(0..0, prologue);
        let name = Ident::new(name, Span::call_site());
        let (generics, is_apart, is_broken) = (Generics::default(), false, false);
        Kernel { name, generics, params, result, body, is_apart, known: None, is_broken }
    }

    /// Parses a closure as an argument. With a `return` its body is a labelled block.
    pub(super) fn nested(&mut self, c: &syn::ExprClosure) -> Kind {
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
            let span = c.span();
            let kind = run_once(Some(NESTED.to_owned()), kernel.body, span);
            kernel.body = Block { stmts: vec![], tail: Some(Box::new(Expr { kind, span })) };
        }
        Kind::Closure(Box::new(kernel))
    }
}
