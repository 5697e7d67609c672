//! Parsing of function and method calls.

use quote::{ToTokens, quote};
use syn::spanned::Spanned;

use super::Parser;
use super::closure::{Types, closure_in};
use super::pattern::variant_of;
use super::refused::is_absent;
use super::types::{generic_argument, is_type_name};
use crate::model::{Expr, Kind};

impl Parser<'_> {
    /// Parses arguments, which may be `&mut` and closures.
    fn arguments<'b>(
        &mut self,
        args: impl IntoIterator<Item = &'b syn::Expr>,
        types: Types,
    ) -> Vec<Expr> {
        args.into_iter()
            .map(|e| match e {
                syn::Expr::Reference(r) if r.mutability.is_some() => {
                    let kind = self.place(&r.expr).map_or(Kind::Error, Kind::RefMut);
                    Expr { kind, span: e.span() }
                }
                e => match closure_in(e) {
                    Some(c) => Expr { kind: self.nested(c, types), span: e.span() },
                    None => self.expr(e),
                },
            })
            .collect()
    }

    pub(super) fn call(&mut self, c: &syn::ExprCall) -> Kind {
        if let Some(refused) = self.refused_call(c) {
            return refused;
        }
        let args = self.arguments(&c.args, Types::Inferred);
        let syn::Expr::Path(p) = &*c.func else {
            return self.error(c.func.span(), "only a kernel can be called", "call it by its name");
        };
        if let Some(q) = &p.qself {
            return associated(&q.ty, p.path.clone(), args);
        }
        let segments: Vec<&syn::PathSegment> = p.path.segments.iter().collect();
        let Some((last, init)) = segments.split_last() else { return Kind::Error };
        if last.ident == "Some"
            && let Some(some) = variant_of(&p.path)
        {
            return some.value(args, c.span()).kind;
        }
        match init.last() {
            Some(owner) if is_type_name(&owner.ident) => {
                let mut ty = p.path.clone();
                ty.segments.pop();
                ty.segments.pop_punct();
                Kind::Associated { ty: ty.to_token_stream(), name: last.ident.clone(), args }
            }
            _ if is_absent(&last.ident) => self.absent(&last.ident),
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

    pub(super) fn method(&mut self, c: &syn::ExprMethodCall) -> Kind {
        if let Some(refused) = self.refused_iteration(c) {
            return refused;
        }
        let generic = c.turbofish.iter().flat_map(|t| &t.args);
        Kind::Method {
            receiver: self.boxed(&c.receiver),
            name: c.method.clone(),
            turbofish: generic.map(generic_argument).collect(),
            args: self.arguments(&c.args, Types::Written),
        }
    }
}

/// Returns a call of `<Type as Trait>::function(..)`.
fn associated(ty: &syn::Type, mut path: syn::Path, args: Vec<Expr>) -> Kind {
    let Some(last) = path.segments.pop() else { return Kind::Error };
    path.segments.pop_punct();
    let ty = if path.segments.is_empty() { quote!(#ty) } else { quote!(#ty as #path) };
    Kind::Associated { ty, name: last.ident, args }
}
