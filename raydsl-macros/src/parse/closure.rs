//! Parsing of closures: literals, and parameters that take them.

use proc_macro2::{Ident, Span};
use quote::{ToTokens, quote};
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::function::within;
use super::types::{is_data, is_mut_reference, is_unit, without_references};
use crate::diag::Errors;
use crate::generics::Generics;
use crate::model::{Block, Expr, Kernel, Kind, Param, Signature, Stmt};

/// The label of a closure within a kernel: its `return` leaves the closure, not the kernel.
const CLOSURE: &str = "__closure";

/// Parses a closure literal that is a kernel; its parameters must have types.
pub(crate) fn closure(c: &syn::ExprClosure, name: &str, errors: &mut Errors) -> Kernel {
    Parser::new(&c.attrs, errors).closure(c, name, Types::Written)
}

/// Returns whether a type parameter is that of a closure: `F: Fn(f32) -> f32`.
pub(crate) fn is_function(t: &syn::TypeParam, clause: Option<&syn::WhereClause>) -> bool {
    bounds_of(t, clause).any(|bound| called_bound(bound).is_some())
}

/// Returns the bounds of a type parameter, those in the `where` clause included.
fn bounds_of<'a>(
    t: &'a syn::TypeParam,
    clause: Option<&'a syn::WhereClause>,
) -> impl Iterator<Item = &'a syn::TypeParamBound> {
    let predicates = clause.into_iter().flat_map(|c| &c.predicates);
    let of_this = predicates.filter_map(|p| match p {
        syn::WherePredicate::Type(p) if t.ident == p.bounded_ty.to_token_stream().to_string() => {
            Some(&p.bounds)
        }
        _ => None,
    });
    t.bounds.iter().chain(of_this.flatten())
}

/// Returns the last name and the types of `Fn(A, B) -> C` and the like.
fn called_bound(
    bound: &syn::TypeParamBound,
) -> Option<(&Ident, &syn::ParenthesizedGenericArguments)> {
    let syn::TypeParamBound::Trait(t) = bound else { return None };
    let last = t.path.segments.last()?;
    match &last.arguments {
        syn::PathArguments::Parenthesized(types) => Some((&last.ident, types)),
        _ => None,
    }
}

/// Whether the parameters of a closure need types.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Types {
    Written,
    /// A kernel that takes the closure says them.
    Inferred,
}

impl Parser<'_> {
    /// Returns the type parameters that are closures.
    pub(super) fn function_parameters(
        &mut self,
        generics: &syn::Generics,
    ) -> Vec<(Ident, Signature)> {
        let clause = generics.where_clause.as_ref();
        let mut found = Vec::new();
        for param in generics.type_params() {
            if let Some(bound) = bounds_of(param, clause).find(|b| called_bound(b).is_some())
                && let Some(signature) = self.signature(bound)
            {
                found.push((param.ident.clone(), signature));
            }
        }
        found
    }

    /// Returns the signature of a parameter's type if it is a closure: `impl Fn(f32) -> f32`, a type
    /// parameter with such a bound, and a reference to one.
    pub(super) fn closure_type(&mut self, ty: &syn::Type) -> Option<Signature> {
        match without_references(ty) {
            syn::Type::ImplTrait(t) => {
                let bound = t.bounds.iter().find(|b| called_bound(b).is_some())?;
                self.signature(bound)
            }
            syn::Type::Path(t) => {
                let name = t.path.get_ident()?;
                self.functions.iter().find(|f| f.0 == *name).map(|f| f.1.clone())
            }
            _ => None,
        }
    }

    /// Returns the types of a bound such as `Fn(f32) -> f32`; refuses what closures of kernels
    /// cannot have.
    fn signature(&mut self, bound: &syn::TypeParamBound) -> Option<Signature> {
        let (name, types) = called_bound(bound)?;
        if name == "FnMut" {
            self.errors.at(
                name.span(),
                "a closure of a kernel changes nothing outside of it",
                "write `Fn`, and give the new value",
            );
        }
        let result = match &types.output {
            syn::ReturnType::Type(_, ty) if !is_unit(ty) => self.ty(ty),
            _ => {
                let help = "write `Fn(f32) -> f32`";
                self.errors.at(bound.span(), "a closure of a kernel gives a value", help);
                quote!(())
            }
        };
        let inputs = types.inputs.iter().map(|arg| &arg.ty);
        if let Some(ty) = inputs.clone().find(|ty| is_mut_reference(ty)) {
            self.errors.at(
                ty.span(),
                "a closure of a kernel takes values, and none by `&mut`",
                "take a copy, `let mut rng = rng;` in the closure, and give what has changed with \
                 the result",
            );
        } else if let Some(ty) = inputs.clone().find(|ty| is_data(ty)) {
            self.errors.at(
                ty.span(),
                "a closure of a kernel takes values",
                "let the closure read the list or the scene where it is written, and take an index \
                 or a ray",
            );
        }
        let params = types.inputs.iter().map(|arg| self.ty(&arg.ty)).collect();
        Some(Signature { params, result })
    }

    /// Parses a parameter that is a closure.
    pub(super) fn function_param(
        &mut self,
        pat: &Pat,
        ty: &syn::Type,
        function: Signature,
    ) -> Param {
        let name = match pat {
            Pat::Ident(p) => p.ident.clone(),
            pat => {
                self.errors.at(
                    pat.span(),
                    "a closure has one name",
                    "write `f: impl Fn(..) -> ..`",
                );
                self.temporary("closure")
            }
        };
        let (ty, function) = (ty.to_token_stream(), Some(function));
        Param {
            name,
            ty,
            mutable: false,
            by_mut: false,
            data: false,
            scene: false,
            host: false,
            function,
        }
    }

    /// Parses a closure that is a kernel, or an argument of a call.
    fn closure(&mut self, c: &syn::ExprClosure, name: &str, types: Types) -> Kernel {
        let (mut params, mut prologue) = (Vec::new(), Vec::new());
        for pat in &c.inputs {
            let Pat::Type(typed) = pat else {
                params.extend(self.untyped_param(pat, types, &mut prologue));
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
        let (generics, is_apart, is_within, is_broken) = (Generics::default(), false, false, false);
        let is_fn = types == Types::Inferred;
        Kernel {
            name,
            generics,
            params,
            result,
            body,
            is_apart,
            is_within,
            known: None,
            is_fn,
            is_broken,
        }
    }

    /// Parses a parameter whose type is not written.
    fn untyped_param(
        &mut self,
        pat: &Pat,
        types: Types,
        prologue: &mut Vec<Stmt>,
    ) -> Option<Param> {
        if types == Types::Written {
            self.errors.at(
                pat.span(),
                "a parameter of a kernel needs a type",
                "write for example `|ray: Ray|`",
            );
            return None;
        }
        let ty = quote!(_);
        let Pat::Ident(p) = pat else { return Some(self.parts_param(pat, ty, false, prologue)) };
        let (name, mutable) = (p.ident.clone(), p.mutability.is_some());
        Some(Param {
            name,
            ty,
            mutable,
            by_mut: false,
            data: false,
            scene: false,
            host: false,
            function: None,
        })
    }

    /// Parses a closure that a variable names.
    pub(super) fn named_closure(&mut self, c: &syn::ExprClosure) -> Expr {
        if let Some(copies) = &c.capture {
            self.errors.at(
                copies.span(),
                "a closure of a kernel has no `move`: it reads the variables around it",
                "remove `move`, and copy what changes to a variable before it",
            );
        }
        Expr { kind: self.nested(c, Types::Written), span: c.span() }
    }

    /// Parses a closure as an argument. With a `return` its body is a labelled block.
    pub(super) fn nested(&mut self, c: &syn::ExprClosure, types: Types) -> Kind {
        let around = self.returns_to.replace(CLOSURE);
        let mut kernel = self.closure(c, "closure", types);
        self.returns_to = around;
        kernel.body = within(CLOSURE, kernel.body, c.span());
        Kind::Closure(Box::new(kernel))
    }
}

/// Returns the closure that an expression is, or refers to.
pub(super) fn closure_in(e: &syn::Expr) -> Option<&syn::ExprClosure> {
    match e {
        syn::Expr::Closure(c) => Some(c),
        syn::Expr::Reference(r) if r.mutability.is_none() => closure_in(&r.expr),
        syn::Expr::Paren(p) => closure_in(&p.expr),
        _ => None,
    }
}
