//! Parsing of functions: their parameters and results.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, quote};
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::attributes::{is_always_inlined, is_host, is_never_inlined};
use super::expression::run_once;
use super::types::{is_data, is_mut_reference, is_unit, without_references};
use crate::diag::Errors;
use crate::generics::{Generics, mentions, says_nothing_of_kernels};
use crate::model::{Block, Expr, Kernel, Kind, MOST, Param, Stmt};

/// The label of the body of a kernel that takes closures, which is a part of its callers.
const BODY: &str = "__body";

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
    parser.functions = parser.function_parameters(&sig.generics);
    parser.check_bounds(&sig.generics);
    let mut prologue = Vec::new();
    let generics = Generics::without(&sig.generics, &parser.functions);
    let param = |arg| {
        let mut param = parser.param(arg, self_ty, &mut prologue);
        let text = param.ty.to_string();
        param.scene = is_shared(arg) && generics.scenes.iter().any(|(name, _)| *name == text);
        param
    };
    let params: Vec<Param> = sig.inputs.iter().map(param).collect();
    let is_apart = attrs.iter().any(is_never_inlined);
    let is_within = attrs.iter().any(is_always_inlined);
    let takes_function = params.iter().any(|p| p.function.is_some());
    if let Some(never) = attrs.iter().find(|a| takes_function && is_never_inlined(a)) {
        let help = "remove `#[inline(never)]`";
        parser.errors.at(
            never.span(),
            "a kernel that takes a closure is a part of its callers",
            help,
        );
    }
    if params.len() > MOST {
        parser.errors.at(
            sig.inputs[MOST].span(),
            format!("a kernel has at most {MOST} parameters"),
            "put some of them into a struct with `#[derive(Clone, Copy, Type)]`",
        );
    }
    parser.check_result(&sig.output);
    let result = parser.result(&sig.output);
    let is_broken = parser.errors.count() > before;
    parser.returns_to = takes_function.then_some(BODY);
    let span = body.span();
    let mut body = within(BODY, parser.block(body), span);
    body.stmts.splice(0..0, prologue);
    let name = sig.ident.clone();
    Kernel {
        name,
        generics,
        params,
        result,
        body,
        is_apart,
        is_within,
        known: None,
        is_fn: false,
        is_broken,
    }
}

/// Returns a body whose `return`s are exits to a label, as a labelled block if it has any.
pub(super) fn within(label: &str, body: Block, span: Span) -> Block {
    if !body.leaves(label) {
        return body;
    }
    let kind = run_once(Some(label.to_owned()), body, span);
    Block { stmts: vec![], tail: Some(Box::new(Expr { kind, span })) }
}

/// Returns whether an argument is `&T`.
fn is_shared(arg: &syn::FnArg) -> bool {
    let syn::FnArg::Typed(typed) = arg else { return false };
    matches!(&*typed.ty, syn::Type::Reference(_)) && !is_mut_reference(&typed.ty)
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

/// Parses `self`, `&self` and `&mut self`.
fn receiver(r: &syn::Receiver, self_ty: Option<&syn::Type>) -> Param {
    let by_mut = matches!(r.kind, syn::ReceiverKind::Reference(_, _, Some(_)));
    let mutable = r.mutability.is_some() && !by_mut;
    let ty = self_ty.map(ToTokens::to_token_stream).unwrap_or_else(|| quote!(Self));
    let name = Ident::new("self", r.self_token.span);
    Param { name, ty, mutable, by_mut, data: false, scene: false, host: false, function: None }
}

impl Parser<'_> {
    /// Refuses type parameters of which nothing says that kernels have them.
    fn check_bounds(&mut self, generics: &syn::Generics) {
        let clause = generics.where_clause.to_token_stream();
        for t in generics.type_params() {
            let is_closure = self.functions.iter().any(|(name, _)| *name == t.ident);
            if is_closure || mentions(&clause, &t.ident) {
                continue;
            }
            if t.bounds.iter().all(says_nothing_of_kernels) {
                let name = &t.ident;
                self.errors.at(
                    name.span(),
                    format!("`{name}` may be a type that kernels do not have"),
                    &format!(
                        "write `{name}: Type`, `{name}: Light` with a `#[kernel]` trait, or for a \
                         scene `{name}: Scene + ?Sized` and `&{name}`"
                    ),
                );
            }
        }
    }

    /// Returns a result type that is written, and is not `()`.
    pub(super) fn result(&mut self, output: &syn::ReturnType) -> Option<TokenStream> {
        match output {
            syn::ReturnType::Default => None,
            syn::ReturnType::Type(_, ty) if is_unit(ty) => None,
            syn::ReturnType::Type(_, ty) => Some(self.ty(ty)),
        }
    }

    /// Checks that a function's result is not `&mut`.
    pub(super) fn check_result(&mut self, output: &syn::ReturnType) {
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

    pub(super) fn typed_param(&mut self, typed: &syn::PatType, prologue: &mut Vec<Stmt>) -> Param {
        let syn::PatType { attrs, pat, ty, .. } = typed;
        self.no_attributes(attrs);
        let by_mut = is_mut_reference(ty);
        let host = attrs.iter().any(is_host);
        let shared = matches!(&**ty, syn::Type::Reference(_)) && !by_mut;
        if let Some(function) = self.closure_type(ty) {
            return self.function_param(pat, ty, function);
        }
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
                scene: false,
                host,
                function: None,
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
    pub(super) fn parts_param(
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
        let (data, scene, host, function) = (false, false, false, None);
        Param { name, ty, mutable: false, by_mut: false, data, scene, host, function }
    }
}
